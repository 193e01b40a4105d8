"""Accuracy as laws: exp, log and the Jacobians of exp against `exact`, in every decade and across
every switch.

The subject is a `group.Group` of the functions under test; one that a law needs and that is not
there is an InputError, which names it. Poses are those of a frame in the base frame.
Raises: LawViolation, by the laws alone.
Errors of exp and log are multiples of what float64 can attain (`error_bounds`), as the law's name
says in a message. Source: the definitions, in 60 digits (`exact`).
"""

from __future__ import annotations

import numpy as np

from ...groups.arrays import Array
from ..laws.group import Group
from ..laws.laws import Law, Pairs, checked
from ..oracles import exact
from . import error_bounds

EXP_LOG_BAR = 3.0
"""exp and log may err by this many times what float64 can attain (`error_bounds`)."""
JACOBIAN_BAR = 1e-15
"""The Jacobians' 3×3 block, and their Q block ÷ ‖v‖, may err by this much (Frobenius)."""
NOISE_BAR = 2e-15
"""log of a noisy rotation may differ by this much (rad) from the log of its polar projection."""


@checked("exp is attained (÷ attainable)")
def exp_is_attained(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the exponential is within EXP_LOG_BAR of what float64 can attain, judged in 60 digits.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses exp.
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
    return [(error_bounds.ratio_exp(xi, group.exp(xi)), EXP_LOG_BAR)]


@checked("log is attained (÷ attainable)")
def log_is_attained(
    group: Group,
    X: Array,
) -> Pairs:
    """Law: the logarithm is within EXP_LOG_BAR of what float64 can attain.

    It is never NaN, and not 0 for a rotation that is not I. Below |ω| = 1e-150 squares underflow, and
    only these two are asked for.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses log.
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
    xi = group.log(X)
    w = exact.log(X[:3, :3])
    if 0 < exact.norm(w) < 1e-150:
        ratio = np.inf
        if np.all(np.isfinite(xi)) and np.any(xi[:3]):
            ratio = 0.0
    else:
        ratio = error_bounds.ratio_log(X, xi)
    return [(ratio, EXP_LOG_BAR)]


@checked()
def log_forgives_noise(
    group: Group,
    X: Array,
) -> Pairs:
    """Law: ω of log X is that of the polar projection of X, to NOISE_BAR.

    Either sign is right within 8 u of π.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses log.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation, with noise of up to 1e-8 in each entry.

    Returns
    -------
    ratio : float
        Error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        If an error exceeds its bound.
    """
    w = group.log(X)[:3]
    truth = exact.log(X[:3, :3])
    return [(error_bounds.log_error(w, truth), NOISE_BAR)]


@checked()
def left_jacobian_is_attained(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the left Jacobian of exp is Σ ad(ξ)^k / (k+1)!, to JACOBIAN_BAR.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses left_jacobian.
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
    return _of_jacobian(group.left_jacobian(xi), exact.left_jacobian(xi), xi)


@checked()
def right_jacobian_is_attained(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the right Jacobian of exp is J_l(-ξ), to JACOBIAN_BAR.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses right_jacobian.
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
    return _of_jacobian(group.right_jacobian(xi), exact.right_jacobian(xi), xi)


@checked()
def left_jacobian_inverse_is_attained(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the inverse left Jacobian of exp is J_l(ξ)⁻¹, to JACOBIAN_BAR.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses left_jacobian_inverse.
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
    return _of_jacobian(group.left_jacobian_inverse(xi), exact.left_jacobian_inverse(xi), xi)


@checked()
def right_jacobian_inverse_is_attained(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the inverse right Jacobian of exp is J_r(ξ)⁻¹, to JACOBIAN_BAR.

    Parameters
    ----------
    group : Group
        Functions under test; the law uses right_jacobian_inverse.
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
    return _of_jacobian(group.right_jacobian_inverse(xi), exact.right_jacobian_inverse(xi), xi)


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
    J: Array,
    truth: np.ndarray,
    xi: Array,
) -> tuple[float, float]:
    """Frobenius errors of a Jacobian of exp.

    Parameters
    ----------
    J, truth : (6, 6) or (3, 3) ndarray
        Jacobian under test, and the true one in numbers of `exact`, to twists of one frame.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad, that they are at.

    Returns
    -------
    diagonal : float
        Error of the 3×3 blocks on and above the diagonal, the worst of them.
    corner : float
        Error of the Q block ÷ ‖v‖; 0 of a 3×3.
    """
    error = exact.exactly(J) - truth
    rest = (error[:3, :3], error[3:, 3:], error[:3, 3:])
    diagonal = max(map(exact.norm, rest))
    corner = exact.norm(error[3:, :3])
    v = exact.norm(exact.exactly(xi[3:]))
    return float(diagonal), error_bounds.ratio(corner, v)


def _of_jacobian(
    J: Array,
    truth: np.ndarray,
    xi: Array,
) -> Pairs:
    return [(error, JACOBIAN_BAR) for error in jacobian_errors(J, truth, xi)]
