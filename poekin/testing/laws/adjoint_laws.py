"""Laws of the adjoint and of the Jacobians of exp, of SO(3) and SE(3); `group_laws.GROUP_LAWS` has them.

The subject is a `group.Group` of the functions under test; one that a law needs and that is not
there is an InputError, which names it. Twists (ω; v) and poses are those of a frame in the base
frame. Bounds are multiples of u = 2⁻⁵³ times the size of what is computed.
Source: Park 1994, Lemmas 3 to 5.
"""

from __future__ import annotations

import functools

import numpy as np

from ...groups.arrays import Array
from ..accuracy.error_bounds import UNIT
from ..oracles import exact
from .group import Group
from .laws import Pairs, checked
from .measures import angle, length, of_blocks, of_twist, shift


@checked()
def ad_is_the_bracket(
    group: Group,
    xi: Array,
    eta: Array,
) -> Pairs:
    """Law: ad is the Lie bracket.

    ad(ξ) η = vee(hat ξ hat η - hat η hat ξ).

    Parameters
    ----------
    group : Group
        Functions under test; the law uses ad, hat and vee.
    xi, eta : (6,) or (3,) ndarray
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
    X = exact.exactly(group.hat(xi))
    Y = exact.exactly(group.hat(eta))
    bracket = group.vee(exact.rounded(X @ Y - Y @ X))
    scale = angle(xi) * length(eta) + angle(eta) * length(xi)
    error = group.ad(xi) @ eta - bracket
    return of_twist(error, 8 * UNIT * angle(xi) * angle(eta), 8 * UNIT * scale)


@checked()
def adjoint_of_exp_is_exp_of_ad(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the adjoint of exp is the exponential of ad.

    Ad(exp ξ) = e^{ad ξ}, the latter as I + ad(ξ) J(ξ) with the exact J.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses adjoint and exp.
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
    truth = np.eye(group.size) + exact.ad(xi) @ exact.left_jacobian(xi)
    extent = 1 + angle(xi)
    error = group.adjoint(group.exp(xi)) - truth
    return of_blocks(error, 16 * UNIT * extent, 64 * UNIT * extent * length(xi))


@checked()
def adjoint_is_a_homomorphism(
    group: Group,
    X: Array,
    Y: Array,
) -> Pairs:
    """Law: the adjoint of a product is the product of adjoints.

    Ad(X Y) = Ad(X) Ad(Y).

    Parameters
    ----------
    group : Group
        Functions under test; the law uses adjoint.
    X, Y : (4, 4) or (3, 3) ndarray
        Poses of a frame in the base frame, m, or rotations.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    error = group.adjoint(X @ Y) - group.adjoint(X) @ group.adjoint(Y)
    return of_blocks(error, 24 * UNIT, 64 * UNIT * (shift(X) + shift(Y)))


@checked()
def adjoint_conjugates(
    group: Group,
    X: Array,
    xi: Array,
) -> Pairs:
    """Law: the adjoint carries a twist as conjugation does.

    hat(Ad(X) ξ) = X hat(ξ) X⁻¹.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses adjoint, hat, vee and inverse.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.
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
    carried = group.vee(group.hat(group.adjoint(X) @ xi))
    error = carried - group.vee(X @ group.hat(xi) @ group.inverse(X))
    linear = 64 * UNIT * (length(xi) + angle(xi) * shift(X))
    return of_twist(error, 32 * UNIT * angle(xi), linear)


@checked()
def jacobians_meet_in_the_adjoint(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the adjoint of exp ties the left Jacobian to the right one.

    J_l(ξ) = Ad(exp ξ) J_r(ξ).

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp, adjoint, left_jacobian and right_jacobian.
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
    error = group.left_jacobian(xi) - group.adjoint(group.exp(xi)) @ group.right_jacobian(xi)
    extent = 1 + angle(xi)
    return of_blocks(error, 32 * UNIT * extent, 128 * UNIT * extent * length(xi))


@checked()
def jacobians_have_inverses(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the inverses undo the Jacobians of exp, left and right.

    J J⁻¹ = I.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses the four Jacobians.
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
    left = group.left_jacobian(xi) @ group.left_jacobian_inverse(xi)
    right = group.right_jacobian(xi) @ group.right_jacobian_inverse(xi)
    pairs: Pairs = []
    for product in (left, right):
        error = product - np.eye(group.size)
        pairs += of_blocks(error, 32 * UNIT, 64 * UNIT * length(xi))
    return pairs


@checked("left jacobian is Lemma 5's integral")
def left_jacobian_is_lemma_5s_integral(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the left Jacobian is the integral of Lemma 5, by Gauss's rule on 24 points.

    J_l(ξ) = ∫ Ad(exp(s ξ)) ds over s in 0..1.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp, adjoint and left_jacobian.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad, |ω| up to 10.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    nodes, weights = _gauss()
    values = np.stack([group.adjoint(group.exp(s * xi)) for s in nodes])
    error = group.left_jacobian(xi) - np.einsum("i,ijk->jk", weights, values)
    extent = 1 + angle(xi)
    return of_blocks(error, 64 * UNIT * extent, 256 * UNIT * extent * length(xi))


@functools.cache
def _gauss() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(24)
    return (nodes + 1) / 2, weights / 2
