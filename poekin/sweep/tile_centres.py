"""Centres of the tiles of the sphere into which directions fall."""

from __future__ import annotations

import numpy as np

from ..groups.arrays import Array

_FIRST = np.array([1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7])


def tile_centres(side: int) -> Array:
    """Unit vectors (12 side², 3) to the centres of tiles, in their order.

    Rings of tiles count from the north pole; within `side` rings of a pole a ring has four tiles
    times its number, the others have 4 side. Source: Górski et al. 2005, equations (2) to (9).
    """
    face, i, j = np.unravel_index(np.arange(12 * side**2), (12, side, side))
    ring = (face // 4 + 2) * side - i - j - 1
    to_pole = np.minimum(ring, 4 * side - ring)
    is_polar = to_pole < side
    across = np.where(is_polar, to_pole, side)
    polar = np.sign(2 * side - ring) * (1.0 - to_pole**2 / (3.0 * side**2))
    z = np.where(is_polar, polar, (2 * side - ring) * 2.0 / (3.0 * side))
    turn = (_FIRST[face] * across + i - j) * np.pi / (4 * across)
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
