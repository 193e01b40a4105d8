"""Measures of errors: on ω and v apart, on R and t apart, on the blocks of a 6×6 apart.

One number for both halves would let a large translation hide a wrong angle. Every function returns
pairs
(error, bound), as `laws.check_bounds` takes them; those without their own bound get 12 u times a size.

Parameters: x, any array (...); xi, error, a twist (6,), (ω; v), or rotation vector (3,); X, Y,
poses (4, 4) in one frame, or rotations (3, 3); of_blocks takes error (6, 6) or (3, 3); angular,
linear, diagonal, lower: bounds, or sizes that they are in proportion to. Returns: floats in rad and
m, or pairs of them. Raises: nothing.
Source: u = 2⁻⁵³, half the distance from 1 to the next float.
"""

from __future__ import annotations

import numpy as np

from ..accuracy.error_bounds import UNIT

Pairs = list[tuple[float, float]]


def size(x: np.ndarray) -> float:
    """Euclidean or Frobenius norm, without underflow; NaN or inf where an entry is."""
    entries = np.abs(np.asarray(x, dtype=float)).ravel()
    largest = float(entries.max(initial=0.0))
    if not np.isfinite(largest):
        return largest
    # 1/largest overflows for subnormal numbers; a power of two keeps every digit.
    power = int(np.frexp(largest)[1])
    return float(np.ldexp(np.linalg.norm(np.ldexp(entries, -power)), power))


def angle(xi: np.ndarray) -> float:
    """|ω| of a twist (6,) or rotation vector (3,)."""
    return size(xi[:3])


def length(xi: np.ndarray) -> float:
    """|v| of a twist; 0 for a rotation vector."""
    return size(xi[3:])


def shift(X: np.ndarray) -> float:
    """|t| of a pose; 0 for a rotation."""
    return size(X[:3, 3:])


def of_elements(
    X: np.ndarray,
    Y: np.ndarray,
    angular: float,
    linear: float,
) -> Pairs:
    """‖ΔR‖ and ‖Δt‖ of two rotations or poses, against 12 u times a size each."""
    pairs = [(size(X[:3, :3] - Y[:3, :3]), 12 * UNIT * angular)]
    if len(X) == 4:
        pairs.append((size(X[:3, 3] - Y[:3, 3]), 12 * UNIT * linear))
    return pairs


def of_twist(
    error: np.ndarray,
    angular: float,
    linear: float,
) -> Pairs:
    """‖Δω‖ and ‖Δv‖ against bounds of their own."""
    pairs = [(size(error[:3]), angular)]
    if len(error) == 6:
        pairs.append((size(error[3:]), linear))
    return pairs


def of_blocks(
    error: np.ndarray,
    diagonal: float,
    lower: float,
) -> Pairs:
    """The error of a 3×3, or of the blocks [P 0; Q P] of a 6×6, with bounds for P and Q; the 0 must
    be exact.
    """
    if len(error) == 3:
        return [(size(error), diagonal)]
    return [
        (size(error[:3, :3]), diagonal),
        (size(error[3:, 3:]), diagonal),
        (size(error[:3, 3:]), 0.0),
        (size(error[3:, :3]), lower),
    ]
