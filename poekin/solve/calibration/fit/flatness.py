"""Extent of a set of vectors along its principal directions, and whether the set is flat."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array

FLAT = 1e-6
"""Least extent of a set of points or rotations out of a line or plane, in units of its length (rad
for angles).
"""


def extents(x: Array) -> Array:
    """Root mean square (3,) of vectors (N, 3) along their principal directions, largest first."""
    return np.linalg.svd(x, compute_uv=False) / np.sqrt(len(x))


def is_flat(sizes: Array, k: int, scatter: float) -> bool:
    """Whether a set of these extents is, along direction k, no larger than rounding or scatter.

    Points that do not fit at all, as in other units, are not called flat for it.
    """
    return sizes[k] <= FLAT * sizes[0] or sizes[k] <= scatter < 0.1 * sizes[0]


def describe(sizes: Array, k: int) -> str:
    """Words for the extents of points on a line (k = 1) or in a plane (k = 2)."""
    return f"{sizes[0]:.2g} m along it and {sizes[k]:.2g} m out of it, rms"
