"""Three angles of rotations, in rad or degrees: turns about z, y and x, or about z, y and z.

"zyx": R = Rz(A) Ry(B) Rx(C)   "xyz": R = Rx(A) Ry(B) Rz(C)   "zyz": R = Rz(A) Ry(B) Rz(C)
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from ..engine.kernels import group_kernels
from ..formulas.lie import euler
from .arrays import Array, map_kernel

Sequence = Literal["zyx", "xyz", "zyz"]


def rotations(
    angles: Array,
    sequence: Sequence,
    *,
    degrees: bool = False,
) -> Array:
    """Rotations (..., 3, 3) of three angles A, B, C (..., 3), of any size.

    Accuracy: 6 u in every entry; multiples of 90 degrees are exact. Source: `formulas.lie.euler`.
    """
    if sequence == "xyz":  # the transpose of the turns back, the last one first
        turned_back = rotations(-angles[..., ::-1], "zyx", degrees=degrees)
        return np.swapaxes(turned_back, -1, -2)
    formula = euler.zyx
    if sequence == "zyz":
        formula = euler.zyz
    sines, cosines = _sines_and_cosines(angles, degrees)
    pairs = np.stack([sines, cosines], axis=-1)
    entries = formula(*np.moveaxis(pairs.reshape(*angles.shape[:-1], 6), -1, 0))
    return np.stack(entries, axis=-1).reshape(*angles.shape[:-1], 3, 3) + 0.0


def angles(
    R: Array,
    sequence: Sequence,
    *,
    degrees: bool = False,
) -> Array:
    """Angles A, B, C (..., 3) of rotations (..., 3, 3), within half a turn; no zero has a sign.

    B is within a quarter turn, of "zyz" from 0 to half a turn. In the lock, where A and C turn
    about one axis, C = 0, and of "xyz" A = 0.
    Accuracy: the rotation of the angles is R within 8 u in every entry, in degrees 12 u, plus R's
    own distance from a rotation. Source: `formulas.lie.euler`.
    """
    if sequence == "xyz":
        turned_back = angles(np.swapaxes(R, -1, -2), "zyx", degrees=degrees)
        half = 180.0 if degrees else np.pi
        turns = 0.0 - turned_back[..., ::-1]
        return np.where(turns <= -half, half, turns)
    kernel = group_kernels.so3_zyx_turns
    if sequence == "zyz":
        kernel = group_kernels.so3_zyz_turns
    # -0.0 would be a turn of -180° where 0.0 is one of 180°
    turns = map_kernel(kernel, 2, (6,), R) + 0.0
    y = turns[..., 0::2]
    x = turns[..., 1::2]
    if degrees:
        return _degrees(y, x) + 0.0
    return np.arctan2(y, x) + 0.0


def _sines_and_cosines(angles: Array, degrees: bool) -> tuple[Array, Array]:
    """Sines and cosines; in degrees of what is left after whole quarter turns, taken off exactly."""
    if not degrees:
        return np.sin(angles), np.cos(angles)
    within = np.fmod(angles, 360.0)
    quarters = np.rint(within / 90.0)
    rest = np.deg2rad(within - 90.0 * quarters)
    s = np.sin(rest)
    c = np.cos(rest)
    which = quarters.astype(int) % 4
    return (
        np.choose(which, [s, c, -s, -c]),
        np.choose(which, [c, -s, -c, s]),
    )


def _degrees(y: Array, x: Array) -> Array:
    """Angles of the points (x, y) in degrees: 45° at most from the nearest axis, and its own."""
    across = np.abs(x)
    up = np.abs(y)
    least = np.rad2deg(np.arctan2(np.minimum(up, across), np.maximum(up, across)))
    steep = np.where(up > across, 90.0 - least, least)
    return np.copysign(np.where(x < 0.0, 180.0 - steep, steep), y)
