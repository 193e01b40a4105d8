"""Measures of errors: on ω and v apart, on R and t apart, on the blocks of a 6×6 apart.

One number for both halves would let a large translation hide a wrong angle. The functions of errors
return pairs (error, bound), as `laws.check_bounds` takes them.
Raises: nothing. Source: u = 2⁻⁵³, half the distance from 1 to the next float.
"""

from __future__ import annotations

import numpy as np

from ...groups.arrays import Array
from ..accuracy.error_bounds import UNIT
from .laws import Pairs


def size(x: np.ndarray) -> float:
    """Euclidean or Frobenius norm, without underflow.

    Parameters
    ----------
    x : (...) ndarray
        Numbers of any unit.

    Returns
    -------
    norm : float
        The norm; NaN or inf if an entry is.
    """
    entries = np.abs(np.asarray(x, dtype=float)).ravel()
    largest = float(entries.max(initial=0.0))
    if not np.isfinite(largest):
        return largest
    # 1/largest overflows for subnormal numbers; a power of two keeps every digit.
    power = int(np.frexp(largest)[1])
    return float(np.ldexp(np.linalg.norm(np.ldexp(entries, -power)), power))


def angle(xi: Array) -> float:
    """Angle |ω| of a twist or rotation vector.

    Parameters
    ----------
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m in any frame, or rotation vector in rad.

    Returns
    -------
    angle : float
        The angle, rad.
    """
    return size(xi[:3])


def length(xi: Array) -> float:
    """Length |v| of a twist; 0 of a rotation vector.

    Parameters
    ----------
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m in any frame, or rotation vector in rad.

    Returns
    -------
    length : float
        The length, m.
    """
    return size(xi[3:])


def shift(X: Array) -> float:
    """Length |t| of the translation of a pose; 0 of a rotation.

    Parameters
    ----------
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.

    Returns
    -------
    length : float
        The length, m.
    """
    return size(X[:3, 3:])


def of_elements(
    X: Array,
    Y: Array,
    angular: float,
    linear: float,
) -> Pairs:
    """Differences ‖ΔR‖ and ‖Δt‖ of two rotations or poses, against 12 u times a size each.

    Parameters
    ----------
    X, Y : (4, 4) or (3, 3) ndarray
        Poses in one frame, m, or rotations.
    angular, linear : float
        Sizes that the bounds of R and t are in proportion to, rad and m.

    Returns
    -------
    pairs : list of tuple
        Pairs (error, bound).
    """
    pairs = [(size(X[:3, :3] - Y[:3, :3]), 12 * UNIT * angular)]
    if len(X) == 4:
        pairs.append((size(X[:3, 3] - Y[:3, 3]), 12 * UNIT * linear))
    return pairs


def of_twist(
    error: Array,
    angular: float,
    linear: float,
) -> Pairs:
    """Errors ‖Δω‖ and ‖Δv‖ against bounds of their own.

    Parameters
    ----------
    error : (6,) or (3,) ndarray
        Difference of two twists (ω; v) in one frame, rad and m, or of two rotation vectors.
    angular, linear : float
        Bounds of ω and v, rad and m.

    Returns
    -------
    pairs : list of tuple
        Pairs (error, bound).
    """
    pairs = [(size(error[:3]), angular)]
    if len(error) == 6:
        pairs.append((size(error[3:]), linear))
    return pairs


def of_blocks(
    error: Array,
    diagonal: float,
    lower: float,
) -> Pairs:
    """Errors of the blocks [P 0; Q P] of a 6×6, or of a 3×3; the 0 must be exact.

    Parameters
    ----------
    error : (6, 6) or (3, 3) ndarray
        Difference of two matrices from twists (ω; v) to twists of the same frames, rad and m.
    diagonal, lower : float
        Bounds of P and of Q.

    Returns
    -------
    pairs : list of tuple
        Pairs (error, bound).
    """
    if len(error) == 3:
        return [(size(error), diagonal)]
    return [
        (size(error[:3, :3]), diagonal),
        (size(error[3:, 3:]), diagonal),
        (size(error[:3, 3:]), 0.0),
        (size(error[3:, :3]), lower),
    ]
