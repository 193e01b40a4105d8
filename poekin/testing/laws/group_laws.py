"""Laws of the products, exponentials and logarithms of SO(3) and SE(3), and `GROUP_LAWS`, the battery
of all laws of a group.

The subject is a `group.Group` of the functions under test; one that a law needs and that is not
there is an InputError, which names it. Twists (ω; v) and poses are those of a frame in the base
frame. Bounds are multiples of u = 2⁻⁵³ times the size of what is computed. How exact each function
is by itself is the matter of `accuracy_laws`.
Source: Park 1994, Lemmas 1 to 4.
"""

from __future__ import annotations

import numpy as np

from ...groups.arrays import Array
from ..accuracy.error_bounds import UNIT
from ..oracles import exact
from . import adjoint_laws
from .group import Group
from .laws import Law, Pairs, checked
from .measures import angle, length, of_elements, of_twist, shift, size


@checked()
def hat_and_vee_are_inverse(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: `vee` undoes `hat`, to the last bit.

    vee(hat ξ) = ξ, and hat ξ has [ω] and v in their places.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses hat and vee.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    X = group.hat(xi)
    wrong = np.abs(X - exact.rounded(exact.hat(xi))).max()
    missed = size(group.vee(X) - xi)
    return [(missed, 0.0), (wrong, 0.0)]


@checked()
def exp_lands_in_the_group(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the exponential is an element of the group.

    Rᵀ R = I, det R = 1, last row (0, 0, 0, 1).

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    X = group.exp(xi)
    R = X[:3, :3]
    last = size(X[3:] - np.eye(len(X))[3:])
    bound = 12 * UNIT * (1 + 1.5 * angle(xi))
    defect = size(R.T @ R - np.eye(3))
    volume = abs(np.linalg.det(R) - 1)
    return [
        (defect, bound),
        (volume, bound),
        (last, 0.0),
    ]


@checked()
def identity_is_neutral(
    group: Group,
    X: Array,
) -> Pairs:
    """Law: the identity is neutral, exactly.

    exp 0 = I, log I = 0, I X = X = X I.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp and log.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    identity = np.eye(len(X))
    unit = group.exp(np.zeros(group.size))
    moved = max(size(unit @ X - X), size(X @ unit - X))
    return [
        (size(unit - identity), 0.0),
        (size(group.log(identity)), 0.0),
        (moved, 0.0),
    ]


@checked()
def inverse_undoes(
    group: Group,
    X: Array,
) -> Pairs:
    """Law: the inverse undoes an element, from both sides.

    X⁻¹ X = I = X X⁻¹.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses inverse.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    Y = group.inverse(X)
    identity = np.eye(len(X))
    bounds = (3.0, 3 * shift(X))
    behind = of_elements(X @ Y, identity, *bounds)
    before = of_elements(Y @ X, identity, *bounds)
    return behind + before


@checked("exp of minus is the inverse")
def exp_of_minus_is_inverse(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the exponential of -ξ is the inverse of that of ξ.

    exp(-ξ) = (exp ξ)⁻¹.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp and inverse.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    extent = 1 + angle(xi)
    back = group.exp(-xi)
    inverse = group.inverse(group.exp(xi))
    return of_elements(back, inverse, extent, extent * length(xi))


@checked()
def exp_adds_along_a_line(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: exponentials along one line add.

    exp(ξ/4) exp(3ξ/4) = exp ξ.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> from poekin.testing.laws import group_laws
    >>> from poekin.testing.laws.group import Group
    >>> mine = Group(6, exp=pk.se3.exp)  # or a function of one's own
    >>> xi = np.array([0.3, 0.0, 0.0, 1.0, 2.0, 3.0])
    >>> group_laws.exp_adds_along_a_line(mine, xi) <= 1
    True
    """
    extent = 1 + angle(xi)
    moved = group.exp(xi / 4) @ group.exp(0.75 * xi)
    return of_elements(moved, group.exp(xi), extent, extent * length(xi))


@checked()
def products_associate(
    group: Group,
    xi: Array,
    eta: Array,
    zeta: Array,
) -> Pairs:
    """Law: products of three exponentials associate.

    exp log((X Y) Z) = exp log(X (Y Z)).

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp and log.
    xi, eta, zeta : (6,) or (3,) ndarray
        Twists (ω; v) in rad and m, or rotation vectors in rad.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    X, Y, Z = (group.exp(x) for x in (xi, eta, zeta))
    left = group.exp(group.log((X @ Y) @ Z))
    right = group.exp(group.log(X @ (Y @ Z)))
    extent = 1 + sum(map(angle, (xi, eta, zeta)))
    lengths = sum(map(length, (xi, eta, zeta)))
    return of_elements(left, right, 4 * extent, 8 * extent * lengths)


@checked()
def log_undoes_exp(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the logarithm undoes the exponential on the principal branch.

    log exp ξ = ξ; ω is held to a relative bound down to |ω| = 1e-150. Within 1e-14 of π the rounding
    of exp ξ decides the sign; there `accuracy_laws.log_is_attained` holds it.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp and log.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad, |ω| up to π.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    theta = angle(xi)
    if theta > np.pi - 1e-14:
        return []
    error = group.log(group.exp(xi)) - xi
    angular = 24 * UNIT * max(theta, 1e-150)
    linear = 64 * UNIT * length(xi)
    return of_twist(error, angular, linear)


@checked()
def exp_undoes_log(
    group: Group,
    X: Array,
) -> Pairs:
    """Law: the exponential undoes the logarithm.

    exp log X = X.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp and log.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    back = group.exp(group.log(X))
    return of_elements(back, X, 3.0, 3 * shift(X))


GROUP_LAWS = (
    Law(hat_and_vee_are_inverse, ("far_twist",)),
    Law(adjoint_laws.ad_is_the_bracket, ("far_twist", "far_twist")),
    Law(exp_lands_in_the_group, ("far_twist",)),
    Law(identity_is_neutral, ("element",)),
    Law(inverse_undoes, ("element",)),
    Law(exp_of_minus_is_inverse, ("far_twist",)),
    Law(exp_adds_along_a_line, ("far_twist",)),
    Law(products_associate, ("twist", "twist", "twist")),
    Law(log_undoes_exp, ("twist",)),
    Law(exp_undoes_log, ("element",)),
    Law(adjoint_laws.adjoint_of_exp_is_exp_of_ad, ("far_twist",)),
    Law(adjoint_laws.adjoint_is_a_homomorphism, ("element", "element")),
    Law(adjoint_laws.adjoint_conjugates, ("element", "far_twist")),
    Law(adjoint_laws.jacobians_meet_in_the_adjoint, ("far_twist",)),
    Law(adjoint_laws.jacobians_have_inverses, ("twist",)),
    Law(adjoint_laws.left_jacobian_is_lemma_5s_integral, ("far_twist",)),
)
"""The battery: each law with the kinds of its arguments (`strategies.group_cases`)."""
