"""Laws of SO(3) and SE(3) as plain functions of a subject's functions, and `GROUP_LAWS`, the
battery of them.

    exp_adds_along_a_line(Group(6, exp=my_exp), xi)

Parameters: group, the functions under test (`group.Group`, of which a law uses those that its
equation names); twists xi, eta, zeta (6,), (ω; v) in rad and m, or rotation vectors (3,); X, Y,
poses (4, 4) of a frame in the base frame, or rotations (3, 3). Returns: error ÷ bound, 0 to 1; a
pure number.
Raises: LawViolation above 1, with the law, the error, its bound and the arguments; InputError where
the group lacks a function that the law needs.
Bounds are multiples of u = 2⁻⁵³ times the size of what is computed. How exact each function is by
itself is the matter of `accuracy_laws`. Source: Park 1994, Lemmas 1 to 5.
"""

from __future__ import annotations

import functools

import numpy as np

from ..accuracy.error_bounds import UNIT
from ..oracles import exact
from .group import Group
from .laws import Law, check_bounds
from .measures import angle, length, of_blocks, of_elements, of_twist, shift, size


def hat_and_vee_are_inverse(group: Group, xi: np.ndarray) -> float:
    """vee(hat ξ) = ξ, and hat ξ is [ω] and v in their places, to the last bit."""
    X = group.hat(xi)
    wrong = np.abs(X - exact.rounded(exact.hat(xi))).max()
    return check_bounds(
        "hat and vee are inverse", (size(group.vee(X) - xi), 0.0), (wrong, 0.0), xi=xi
    )


def ad_is_the_bracket(
    group: Group,
    xi: np.ndarray,
    eta: np.ndarray,
) -> float:
    """ad(ξ) η = vee(hat ξ hat η - hat η hat ξ)."""
    X = exact.exactly(group.hat(xi))
    Y = exact.exactly(group.hat(eta))
    bracket = group.vee(exact.rounded(X @ Y - Y @ X))
    scale = angle(xi) * length(eta) + angle(eta) * length(xi)
    pairs = of_twist(
        group.ad(xi) @ eta - bracket, 8 * UNIT * angle(xi) * angle(eta), 8 * UNIT * scale
    )
    return check_bounds("ad is the bracket", *pairs, xi=xi, eta=eta)


def exp_lands_in_the_group(group: Group, xi: np.ndarray) -> float:
    """Closure: Rᵀ R = I, det R = 1, last row (0, 0, 0, 1)."""
    X = group.exp(xi)
    R = X[:3, :3]
    last = size(X[3:] - np.eye(len(X))[3:])
    bound = 12 * UNIT * (1 + 1.5 * angle(xi))
    defect = size(R.T @ R - np.eye(3))
    return check_bounds(
        "exp lands in the group",
        (defect, bound),
        (abs(np.linalg.det(R) - 1), bound),
        (last, 0.0),
        xi=xi,
    )


def identity_is_neutral(group: Group, X: np.ndarray) -> float:
    """The identity is neutral: exp 0 = I and log I = 0 exactly, I X = X = X I."""
    unit = group.exp(np.zeros(group.size))
    nought = size(group.log(np.eye(len(X))))
    moved = max(size(unit @ X - X), size(X @ unit - X))
    return check_bounds(
        "identity is neutral", (size(unit - np.eye(len(X))), 0.0), (nought, 0.0), (moved, 0.0), X=X
    )


def inverse_undoes(group: Group, X: np.ndarray) -> float:
    """X⁻¹ X = I = X X⁻¹."""
    Y = group.inverse(X)
    pairs = [
        pair
        for product in (X @ Y, Y @ X)
        for pair in of_elements(product, np.eye(len(X)), 3.0, 3 * shift(X))
    ]
    return check_bounds("inverse undoes", *pairs, X=X)


def exp_of_minus_is_inverse(group: Group, xi: np.ndarray) -> float:
    """exp(-ξ) = (exp ξ)⁻¹."""
    extent = 1 + angle(xi)
    pairs = of_elements(group.exp(-xi), group.inverse(group.exp(xi)), extent, extent * length(xi))
    return check_bounds("exp of minus is the inverse", *pairs, xi=xi)


def exp_adds_along_a_line(group: Group, xi: np.ndarray) -> float:
    """exp(ξ/4) exp(3ξ/4) = exp ξ."""
    extent = 1 + angle(xi)
    pairs = of_elements(
        group.exp(xi / 4) @ group.exp(0.75 * xi), group.exp(xi), extent, extent * length(xi)
    )
    return check_bounds("exp adds along a line", *pairs, xi=xi)


def products_associate(
    group: Group,
    xi: np.ndarray,
    eta: np.ndarray,
    zeta: np.ndarray,
) -> float:
    """In any order: exp log((X Y) Z) = exp log(X (Y Z)) of three exponentials."""
    X, Y, Z = (group.exp(x) for x in (xi, eta, zeta))
    left = group.exp(group.log((X @ Y) @ Z))
    right = group.exp(group.log(X @ (Y @ Z)))
    extent = 1 + sum(map(angle, (xi, eta, zeta)))
    pairs = of_elements(left, right, 4 * extent, 8 * extent * sum(map(length, (xi, eta, zeta))))
    return check_bounds(
        "products associate",
        *pairs,
        xi=xi,
        eta=eta,
        zeta=zeta,
    )


def log_undoes_exp(group: Group, xi: np.ndarray) -> float:
    """There and back: log exp ξ = ξ on the principal branch; ω is held to a relative bound down to
    |ω| = 1e-150.

    Within 1e-14 of π the rounding of exp ξ decides the sign; there `accuracy_laws.log_is_attained`
    holds it.
    """
    theta = angle(xi)
    if theta > np.pi - 1e-14:
        return 0.0
    pairs = of_twist(
        group.log(group.exp(xi)) - xi, 24 * UNIT * max(theta, 1e-150), 64 * UNIT * length(xi)
    )
    return check_bounds("log undoes exp", *pairs, xi=xi)


def exp_undoes_log(group: Group, X: np.ndarray) -> float:
    """And back again: exp log X = X."""
    return check_bounds(
        "exp undoes log", *of_elements(group.exp(group.log(X)), X, 3.0, 3 * shift(X)), X=X
    )


def adjoint_of_exp_is_exp_of_ad(group: Group, xi: np.ndarray) -> float:
    """Ad(exp ξ) = e^{ad ξ}, the latter as I + ad(ξ) J(ξ) with the exact J."""
    truth = np.eye(group.size) + exact.ad(xi) @ exact.left_jacobian(xi)
    extent = 1 + angle(xi)
    return check_bounds(
        "adjoint of exp is exp of ad",
        *of_blocks(
            group.adjoint(group.exp(xi)) - truth,
            16 * UNIT * extent,
            64 * UNIT * extent * length(xi),
        ),
        xi=xi,
    )


def adjoint_is_a_homomorphism(
    group: Group,
    X: np.ndarray,
    Y: np.ndarray,
) -> float:
    """Ad(X Y) = Ad(X) Ad(Y)."""
    error = group.adjoint(X @ Y) - group.adjoint(X) @ group.adjoint(Y)
    pairs = of_blocks(error, 24 * UNIT, 64 * UNIT * (shift(X) + shift(Y)))
    return check_bounds("adjoint is a homomorphism", *pairs, X=X, Y=Y)


def adjoint_conjugates(
    group: Group,
    X: np.ndarray,
    xi: np.ndarray,
) -> float:
    """hat(Ad(X) ξ) = X hat(ξ) X⁻¹."""
    error = group.vee(group.hat(group.adjoint(X) @ xi)) - group.vee(
        X @ group.hat(xi) @ group.inverse(X)
    )
    linear = 64 * UNIT * (length(xi) + angle(xi) * shift(X))
    return check_bounds(
        "adjoint conjugates", *of_twist(error, 32 * UNIT * angle(xi), linear), X=X, xi=xi
    )


def jacobians_meet_in_the_adjoint(group: Group, xi: np.ndarray) -> float:
    """J_l(ξ) = Ad(exp ξ) J_r(ξ)."""
    error = group.left_jacobian(xi) - group.adjoint(group.exp(xi)) @ group.right_jacobian(xi)
    extent = 1 + angle(xi)
    pairs = of_blocks(error, 32 * UNIT * extent, 128 * UNIT * extent * length(xi))
    return check_bounds("jacobians meet in the adjoint", *pairs, xi=xi)


def jacobians_have_inverses(group: Group, xi: np.ndarray) -> float:
    """J J⁻¹ = I, left and right, |ω| up to π."""
    pairs = []
    for J, inverse in (
        (group.left_jacobian, group.left_jacobian_inverse),
        (group.right_jacobian, group.right_jacobian_inverse),
    ):
        error = J(xi) @ inverse(xi) - np.eye(group.size)
        pairs += of_blocks(error, 32 * UNIT, 64 * UNIT * length(xi))
    return check_bounds("jacobians have inverses", *pairs, xi=xi)


def left_jacobian_is_lemma_5s_integral(group: Group, xi: np.ndarray) -> float:
    """Lemma 5: J_l(ξ) = ∫ Ad(exp(s ξ)) ds over s in 0..1, by Gauss's rule on 24 points; |ω| up to
    10.
    """
    nodes, weights = _gauss()
    integral = np.einsum(
        "i,ijk->jk", weights, np.stack([group.adjoint(group.exp(s * xi)) for s in nodes])
    )
    extent = 1 + angle(xi)
    pairs = of_blocks(
        group.left_jacobian(xi) - integral, 64 * UNIT * extent, 256 * UNIT * extent * length(xi)
    )
    return check_bounds("left jacobian is Lemma 5's integral", *pairs, xi=xi)


GROUP_LAWS = (
    Law(hat_and_vee_are_inverse, ("far_twist",)),
    Law(ad_is_the_bracket, ("far_twist", "far_twist")),
    Law(exp_lands_in_the_group, ("far_twist",)),
    Law(identity_is_neutral, ("element",)),
    Law(inverse_undoes, ("element",)),
    Law(exp_of_minus_is_inverse, ("far_twist",)),
    Law(exp_adds_along_a_line, ("far_twist",)),
    Law(products_associate, ("twist", "twist", "twist")),
    Law(log_undoes_exp, ("twist",)),
    Law(exp_undoes_log, ("element",)),
    Law(adjoint_of_exp_is_exp_of_ad, ("far_twist",)),
    Law(adjoint_is_a_homomorphism, ("element", "element")),
    Law(adjoint_conjugates, ("element", "far_twist")),
    Law(jacobians_meet_in_the_adjoint, ("far_twist",)),
    Law(jacobians_have_inverses, ("twist",)),
    Law(left_jacobian_is_lemma_5s_integral, ("far_twist",)),
)
"""The battery: each law with the kinds of its arguments (`strategies.group_cases`)."""


@functools.cache
def _gauss() -> tuple[np.ndarray, np.ndarray]:
    nodes, weights = np.polynomial.legendre.leggauss(24)
    return (nodes + 1) / 2, weights / 2
