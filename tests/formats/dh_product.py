"""The oracle of DH tables: the product of their matrices, written out as in the books, in 50 digits
or long doubles.
"""

from __future__ import annotations

import mpmath
import numpy as np

DIGITS = 50
EXACT = (
    np.frompyfunc(mpmath.mpf, 1, 1),
    np.frompyfunc(mpmath.cos, 1, 1),
    np.frompyfunc(mpmath.sin, 1, 1),
)
LONG = np.longdouble, np.cos, np.sin


def frames(table, x, arithmetic=EXACT):
    """Frames in which the joints' axes are z, and at last the tool's, all in the base frame: x
    (..., n) -> (..., 4, 4).

    In Paul's convention joint i turns about z of frame i - 1, in Craig's about that of frame i
    before its own turn.
    """
    number, cos, sin = arithmetic

    def about(axis, angle):
        c, s, o, one = cos(angle), sin(angle), 0 * angle, 0 * angle + 1
        rows = {
            "x": [[one, o, o], [o, c, -s], [o, s, c]],
            "z": [[c, -s, o], [s, c, o], [o, o, one]],
        }[axis]
        return matrix([[*row, o] for row in rows] + [[o, o, o, one]])

    def shift(a, d):
        o, one = 0 * a, 0 * a + 1
        return matrix([[one, o, o, a], [o, one, o, o], [o, o, one, d], [o, o, o, one]])

    def matrix(entries):
        return np.moveaxis(np.array(entries), (0, 1), (-2, -1))

    with mpmath.workdps(DIGITS):
        found, T = [], number(table.base)
        for row, value in zip(table.rows, np.moveaxis(number(x), -1, 0), strict=True):
            moved = -value if row.flip else value
            turns = row.kind == "revolute"
            theta, d = row.theta + moved * turns, row.d + moved * (not turns)
            along = shift(number(row.a), number(0)) @ about("x", number(row.alpha))
            around = about("z", theta) @ shift(0 * d, d)
            if table.convention == "standard":
                found.append(T)
                T = T @ around @ along
            else:
                found.append(T @ along)
                T = T @ along @ around
        return [*found, T @ number(table.tool)]


def pose(table, x, arithmetic=EXACT):
    """The tool's poses (..., 4, 4), rounded once."""
    return frames(table, x, arithmetic)[-1].astype(float)
