"""Accuracy as laws: exp, log and the Jacobians of exp against `exact`, in every decade and across
every switch.

Parameters: group, the functions under test (`group.Group`, of which a law uses those that its
equation names); twists xi, eta, zeta (6,), (ω; v) in rad and m, or rotation vectors (3,); X, Y,
poses (4, 4) of a frame in the base frame, or rotations (3, 3). Returns: error ÷ bound, 0 to 1; a
pure number.
Raises: LawViolation above 1, with the law, the error, its bound and the arguments; InputError where
the group lacks a function that the law needs.
Errors of exp and log are multiples of what float64 can attain (`error_bounds`), as the law's name
says in a message. Source: the definitions, in 60 digits (`exact`).
"""

from __future__ import annotations

import numpy as np

from ..laws.group import Group
from ..laws.laws import Law, check_bounds
from ..oracles import exact
from . import error_bounds

EXP_LOG_BAR = 3.0
"""exp and log may err by this many times what float64 can attain (`error_bounds`)."""
REPORT_BAR = 1.5
"""What the report asks of exp and log, as multiples of the same (`accuracy`)."""
JACOBIAN_BAR = 1e-15
"""The Jacobians' 3×3 block, and their Q block ÷ ‖v‖, may err by this much (Frobenius)."""
JACOBIAN_REPORT_BAR = 5e-16
"""What the report asks of the same (`accuracy`)."""
NOISE_BAR = 2e-15
"""log of a noisy rotation may differ by this much (rad) from the log of its polar projection."""


def exp_is_attained(group: Group, xi: np.ndarray) -> float:
    """The exponential within EXP_LOG_BAR of what float64 can attain, |ω| up to 10."""
    return check_bounds(
        "exp is attained (÷ attainable)",
        (error_bounds.ratio_exp(xi, group.exp(xi)), EXP_LOG_BAR),
        xi=xi,
    )


def log_is_attained(group: Group, X: np.ndarray) -> float:
    """The logarithm within EXP_LOG_BAR of what float64 can attain; no NaN, and no 0 for a rotation
    that is not I.

    Below |ω| = 1e-150 squares underflow, and only the last two are asked for.
    """
    xi = group.log(X)
    w = exact.log(X[:3, :3])
    if 0 < exact.norm(w) < 1e-150:
        ratio = np.inf
        if np.all(np.isfinite(xi)) and np.any(xi[:3]):
            ratio = 0.0
    else:
        ratio = error_bounds.ratio_log(X, xi)
    return check_bounds("log is attained (÷ attainable)", (ratio, EXP_LOG_BAR), X=X)


def log_forgives_noise(group: Group, X: np.ndarray) -> float:
    """ω of log X is that of X's polar projection, to NOISE_BAR, for noise up to 1e-8; either sign
    within 8 u of π.
    """
    w = group.log(X)[:3]
    truth = exact.log(X[:3, :3])
    error = error_bounds.log_error(w, truth)
    return check_bounds("log forgives noise", (error, NOISE_BAR), X=X)


def left_jacobian_is_attained(group: Group, xi: np.ndarray) -> float:
    """J_l(ξ) = Σ ad(ξ)^k / (k+1)!, to JACOBIAN_BAR, |ω| up to 10."""
    return _jacobian_law("left_jacobian", group, xi)


def right_jacobian_is_attained(group: Group, xi: np.ndarray) -> float:
    """J_r(ξ) = J_l(-ξ), to JACOBIAN_BAR, |ω| up to 10."""
    return _jacobian_law("right_jacobian", group, xi)


def left_jacobian_inverse_is_attained(group: Group, xi: np.ndarray) -> float:
    """J_l(ξ)⁻¹, to JACOBIAN_BAR, |ω| up to π."""
    return _jacobian_law("left_jacobian_inverse", group, xi)


def right_jacobian_inverse_is_attained(group: Group, xi: np.ndarray) -> float:
    """J_r(ξ)⁻¹, to JACOBIAN_BAR, |ω| up to π."""
    return _jacobian_law("right_jacobian_inverse", group, xi)


ACCURACY_LAWS = (
    Law(exp_is_attained, ("far_twist",)),
    Law(log_is_attained, ("element",)),
    Law(log_forgives_noise, ("noisy_element",)),
    Law(left_jacobian_is_attained, ("far_twist",)),
    Law(right_jacobian_is_attained, ("far_twist",)),
    Law(left_jacobian_inverse_is_attained, ("twist",)),
    Law(right_jacobian_inverse_is_attained, ("twist",)),
)
"""The battery: each law with the kinds of its arguments (`strategies.group_cases`)."""


def jacobian_errors(
    J: np.ndarray,
    truth: np.ndarray,
    xi: np.ndarray,
) -> tuple[float, float]:
    """Frobenius errors of a Jacobian of exp: of its 3×3 diagonal blocks (the worse), and of its Q
    block ÷ ‖v‖.

    Parameters: J, truth (6, 6) or (3, 3), as measured and as it ought to be; xi (6,) or (3,).
    Returns: both errors, the second 0 for (3, 3).
    """
    error = exact.exactly(J) - truth
    diagonal = max(exact.norm(block) for block in (error[:3, :3], error[3:, 3:], error[:3, 3:]))
    Q = exact.norm(error[3:, :3])
    v = exact.norm(exact.exactly(xi[3:]))
    return float(diagonal), error_bounds.ratio(Q, v)


def _jacobian_law(
    name: str,
    group: Group,
    xi: np.ndarray,
) -> float:
    errors = jacobian_errors(getattr(group, name)(xi), getattr(exact, name)(xi), xi)
    return check_bounds(
        name.replace("_", " ") + " is attained", *((error, JACOBIAN_BAR) for error in errors), xi=xi
    )
