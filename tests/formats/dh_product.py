"""The oracle of DH tables: the product of their matrices in 50 digits, written out as in the books."""

from __future__ import annotations

import mpmath
import numpy as np

DIGITS = 50


def frames(table, x):
    """Frames in which the joints' axes are z, and at last the tool's, all in the base frame, as mpmath matrices.

    In Paul's convention joint i turns about z of frame i - 1, in Craig's about that of frame i before its own turn.
    """

    def about(axis, angle):
        c, s = mpmath.cos(angle), mpmath.sin(angle)
        rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
        return mpmath.matrix([[*row, 0] for row in rows] + [[0, 0, 0, 1]])

    def shift(a, d):
        T = mpmath.eye(4)
        T[0, 3], T[2, 3] = a, d
        return T

    with mpmath.workdps(DIGITS):
        found, T = [], mpmath.matrix(table.base.tolist())
        for row, value in zip(table.rows, map(mpmath.mpf, map(float, x)), strict=True):
            moved = -value if row.flip else value
            turns = row.kind == "revolute"
            theta, d = row.theta + moved * turns, row.d + moved * (not turns)
            around, along = about("z", theta) * shift(0, d), shift(row.a, 0) * about("x", row.alpha)
            if table.convention == "standard":
                found.append(T)
                T = T * around * along
            else:
                found.append(T * along)
                T = T * along * around
        return [*found, T * mpmath.matrix(table.tool.tolist())]


def pose(table, x):
    """The tool's pose (4, 4), rounded once."""
    return np.array(frames(table, x)[-1].tolist(), dtype=float)
