"""Errors that float64 can attain for exp and log, and the ratio of a result's error to them.

With u = 2⁻⁵³, θ = |ω|, κ = (θ/2)/sin(θ/2), ‖·‖ Euclidean for vectors and Frobenius for matrices:

    exp   ‖ΔR‖ <= u (1 + √2 θ)                              ‖Δt‖ <= u (‖t‖ + ‖v‖ + θ ‖∂t/∂ω‖)
    log   ‖Δω‖ <= u (1 + 1.22 κ min(1, 1/θ)) ‖ω‖            ‖Δv‖ <= u (‖v‖ + κ ‖t‖ + θ ‖∂v/∂ω‖)

The terms are the rounding of the result and the result's response to a relative rounding u of its
argument. The truth of exp is that of the float64 argument, and the truth of log is the exact
logarithm of the float64 matrix as it stands (of its polar projection). ∂t/∂ω is at fixed v, ∂v/∂ω
at fixed t.

Poses are those of a frame in the base frame. Ratios are pure numbers; 1 is as good as float64 can
be. Raises: ShapeError for other shapes.
Source: the first-order response to rounding.
Accuracy: the ratios are right to many more digits than anybody reads;
tests/testing/accuracy/test_error_bounds.py holds the derivatives to differences in high precision.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...errors import ShapeError
from ..oracles import exact
from ..oracles.exact import mp, norm

UNIT = 2.0**-53
BOTH_SIGNS = 8 * UNIT
"""Where π - θ is below this, ω and -ω are equally right logarithms of a float64 matrix."""


class Bound(NamedTuple):
    """Largest error of a result that float64 cannot avoid.

    Attributes
    ----------
    angular : mpf
        Bound on ‖ΔR‖ or ‖Δω‖, rad.
    linear : mpf
        Bound on ‖Δt‖ or ‖Δv‖, m.
    """

    angular: Any
    linear: Any


def exp_bound(xi: ArrayLike) -> Bound:
    """Attainable errors ‖ΔR‖ and ‖Δt‖ of the exponential.

    Parameters
    ----------
    xi : (6,) or (3,) array_like
        Twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    bound : Bound
        The two errors; the second is 0 for a rotation vector.

    Raises
    ------
    ShapeError
        For another shape.
    """
    x = exact.exactly(xi)
    theta = norm(x[:3])
    angular = UNIT * (1 + mp.sqrt(2) * theta)
    if len(x) == 3:
        return Bound(angular, mp.zero)
    t, _, slope = _translation(x)
    return Bound(angular, UNIT * (norm(t) + norm(x[3:]) + theta * norm(slope)))


def log_bound(xi: ArrayLike) -> Bound:
    """Attainable errors ‖Δω‖ and ‖Δv‖ of the logarithm.

    Parameters
    ----------
    xi : (6,) or (3,) array_like
        Exact logarithm (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    bound : Bound
        The two errors; the second is 0 for a rotation vector.

    Raises
    ------
    ShapeError
        For another shape.
    """
    x = exact.exactly(xi)
    theta = norm(x[:3])
    kappa = mp.one
    if theta:
        kappa = theta / 2 / mp.sin(theta / 2)
    angular = UNIT * (theta + mp.mpf("1.22") * kappa * min(theta, mp.one))
    if len(x) == 3:
        return Bound(angular, mp.zero)
    t, P, slope = _translation(x)
    # v = P⁻¹ t with t fixed: ∂v/∂ω = -P⁻¹ ∂(P v)/∂ω.
    across = norm(exact.inverse(P) @ slope)
    return Bound(angular, UNIT * (norm(x[3:]) + kappa * norm(t) + theta * across))


def ratio_exp(
    xi: ArrayLike,
    T: ArrayLike,
) -> float:
    """Error of an exponential ÷ attainable error, the worse of R and t.

    Parameters
    ----------
    xi : (6,) or (3,) array_like
        Twist (ω; v) in rad and m, or rotation vector in rad.
    T : (4, 4) or (3, 3) array_like
        Result under test: pose in the base frame, m, or rotation.

    Returns
    -------
    ratio : float
        Pure number, 1 where float64 can do no better; inf if T is not finite.

    Raises
    ------
    ShapeError
        If the two do not go together.

    Examples
    --------
    >>> import poekin as pk
    >>> from poekin.testing.accuracy import error_bounds
    >>> xi = [0.3, 0.0, 0.0, 1.0, 2.0, 3.0]
    >>> error_bounds.ratio_exp(xi, pk.se3.exp(xi)) < 1
    True
    """
    _together(xi, T)
    if not np.all(np.isfinite(np.asarray(T, dtype=float))):
        return math.inf
    x = exact.exactly(xi)
    X = exact.exactly(T)
    E = exact.exp(x) - X
    bound = exp_bound(x)
    worse = ratio(norm(E[:3, :3]), bound.angular)
    if len(x) == 3:
        return worse
    if np.any(X[3] != [0, 0, 0, 1]):
        return math.inf
    return max(worse, ratio(norm(E[:3, 3]), bound.linear))


def ratio_log(
    T: ArrayLike,
    xi: ArrayLike,
) -> float:
    """Error of a principal logarithm ÷ attainable error, the worse of ω and v.

    Where π - θ < 8 u both signs of ω are right, with the v that goes with each.

    Parameters
    ----------
    T : (4, 4) or (3, 3) array_like
        Pose of a frame in the base frame, m, or rotation.
    xi : (6,) or (3,) array_like
        Result under test: twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        Pure number, 1 where float64 can do no better; inf if xi is not finite.

    Raises
    ------
    ShapeError
        If the two do not go together.
    """
    _together(xi, T)
    return ratio_to(exact.log(T), xi)


def ratio_to(
    truth: np.ndarray,
    xi: ArrayLike,
) -> float:
    """Error of a logarithm ÷ attainable error, where the exact logarithm is known.

    Parameters
    ----------
    truth : (6,) or (3,) ndarray
        Exact logarithm in numbers of `exact`.
    xi : (6,) or (3,) array_like
        Result under test: twist (ω; v) in rad and m, or rotation vector in rad.

    Returns
    -------
    ratio : float
        As of `ratio_log`.
    """
    if not np.all(np.isfinite(np.asarray(xi, dtype=float))):
        return math.inf
    x = exact.exactly(xi)
    candidates = [truth]
    if mp.pi - norm(truth[:3]) < BOTH_SIGNS:
        candidates.append(other_sign(truth))
    return min(_log_ratio(x, candidate) for candidate in candidates)


def log_error(
    w: ArrayLike,
    truth: np.ndarray,
    gap: float = BOTH_SIGNS,
) -> float:
    """Error of a logarithm of a rotation, of either sign near π.

    Parameters
    ----------
    w : (3,) array_like
        Result under test: rotation vector, rad.
    truth : (3,) ndarray
        Exact logarithm in numbers of `exact`.
    gap : float, optional
        Either sign is right if π - θ is below it, rad.

    Returns
    -------
    error : float
        Euclidean norm of the difference, rad.
    """
    x = exact.exactly(w)
    error = norm(x - truth)
    if mp.pi - norm(truth) < gap:
        error = min(error, norm(x + truth))
    return float(error)


def _together(
    xi: ArrayLike,
    T: ArrayLike,
) -> None:
    size = np.shape(xi)
    shape = np.shape(T)
    if (size, shape) not in (((3,), (3, 3)), ((6,), (4, 4))):
        raise ShapeError(
            f"expected xi (6,) with T (4, 4), or xi (3,) with T (3, 3), got {size} with {shape}"
        )


def _log_ratio(
    x: np.ndarray,
    truth: np.ndarray,
) -> float:
    bound = log_bound(truth)
    angular = ratio(norm(x[:3] - truth[:3]), bound.angular)
    return max(angular, ratio(norm(x[3:] - truth[3:]), bound.linear))


def other_sign(truth: np.ndarray) -> np.ndarray:
    """Logarithm with the opposite ω, of the same rotation by π or of the same pose.

    Parameters
    ----------
    truth : (6,) or (3,) ndarray
        Exact logarithm in numbers of `exact`, rad and m.

    Returns
    -------
    xi : (6,) or (3,) ndarray
        The other one: -ω, with the v that goes with it.
    """
    w = -truth[:3]
    if len(truth) == 3:
        return w
    t = exact.left_jacobian(truth[:3]) @ truth[3:]
    return np.concatenate([w, exact.left_jacobian_inverse(w) @ t])


def _translation(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The translation t = P v of exp, P, and ∂t/∂ω at fixed v.

    The last comes from the left Jacobian: dt is the velocity v_s + ω_s × t of the moving origin.
    """
    J = exact.left_jacobian(x)
    P = J[:3, :3]
    t = P @ x[3:]
    return t, P, J[3:, :3] - exact.hat(t) @ P


def ratio(
    error: Any,
    bound: Any,
) -> float:
    """Error ÷ bound; with a bound of 0, 0 for no error and infinite for any other.

    Parameters
    ----------
    error, bound : float or mpf
        Numbers of one unit, 0 or more.

    Returns
    -------
    ratio : float
        The quotient.
    """
    if bound:
        return float(error / bound)
    if error:
        return math.inf
    return 0.0
