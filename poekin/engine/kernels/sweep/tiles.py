"""Tiles of the sphere of equal area, 12 n^2, n by n on each of twelve faces, and the tile of a
direction; cells, of which each is a cube of space and a tile.

Source: Górski et al. 2005 (HEALPix), Section 4, with the tiles of a face numbered row by row.
"""

import math

from ...straight_line.arctangent import atan2

OUTSIDE = -1
_EQUATOR = 2.0 / 3.0


def cell_of(cells, place, p, axis):
    """The cell of a point and a direction, OUTSIDE where there is none."""
    x = math.floor((p[0] - place[0]) * place[3])
    y = math.floor((p[1] - place[1]) * place[3])
    z = math.floor((p[2] - place[2]) * place[3])
    if not (0 <= x < cells[1] and 0 <= y < cells[2] and 0 <= z < cells[3]):
        return OUTSIDE
    cube = (int(x) * cells[2] + int(y)) * cells[3] + int(z)
    side = cells[0]
    if side == 0:
        return cube
    return cube * (12 * side * side) + tile(axis[0], axis[1], axis[2], side)


def write_cells(T, cells, place, found):
    """The cells of poses T (N, 4, 4)."""
    for k in range(len(T)):
        p = (T[k, 0, 3], T[k, 1, 3], T[k, 2, 3])
        axis = (T[k, 0, 2], T[k, 1, 2], T[k, 2, 2])
        found[k] = cell_of(cells, place, p, axis)


def tile(x, y, z, n):
    """The tile of a direction: 0 ... 12 n^2 - 1."""
    quarter = atan2(y, x) * (2.0 / math.pi)
    if quarter < 0.0:
        quarter += 4.0
    if abs(z) <= _EQUATOR:
        face, i, j = _around_equator(quarter, z, n)
    else:
        face, i, j = _around_pole(quarter, z, n)
    return (face * n + i) * n + j


def _around_equator(quarter, z, n):
    along = n * (0.5 + quarter)
    up = 0.75 * n * z
    falling = int(along - up)
    rising = int(along + up)
    column = falling // n
    other = rising // n
    if column == other:
        face = column % 4 + 4
    elif column < other:
        face = column % 4  # 4 where an angle just below a whole turn is rounded to it
    else:
        face = other % 4 + 8
    return face, rising % n, n - 1 - falling % n


def _around_pole(quarter, z, n):
    face = min(int(quarter), 3)
    along = quarter - face
    out = n * math.sqrt(3.0 * max(1.0 - abs(z), 0.0))
    falling = min(int(along * out), n - 1)
    rising = min(int((1.0 - along) * out), n - 1)
    if z > 0.0:
        return face, n - 1 - rising, n - 1 - falling
    return face + 8, falling, rising
