"""Rotations and places of joints in 60 digits, by Rodrigues' formula on matrices: what the
decompositions are held against.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np


def rotation(h, x):
    """e^{[h] x}, h made a unit vector."""
    k = [mpmath.mpf(float(c)) for c in h]
    size = mpmath.sqrt(mpmath.fdot(k, k))
    k = [c / size for c in k]
    hat = mpmath.matrix([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return mpmath.eye(3) + mpmath.sin(x) * hat + (1 - mpmath.cos(x)) * hat * hat


def place(h, P, x):
    """P_0 + E_1 P_1 + ... + E_n P_n and E_n, E_i = e^{[h_1] x_1} ... e^{[h_i] x_i}."""
    E = mpmath.eye(3)
    p = column(P[0])
    for axis, step, angle in zip(h, P[1:], x, strict=True):
        E = E * rotation(axis, angle)
        p = p + E * column(step)
    return p, E


def jacobian(h, steps, x):
    """Axis of each joint and how it moves the place of all, (n, 6), in floats: to say how well
    angles are known, no digits are needed.
    """
    E = np.eye(3)
    p = np.zeros(3)
    axes, places = [], []
    for axis, step, angle in zip(h, steps, x, strict=True):
        k = np.asarray(axis, float)
        axes.append(E @ k)
        places.append(p)
        hat = np.cross(np.eye(3), -k / np.linalg.norm(k))
        E = E @ (np.eye(3) + math.sin(angle) * hat + (1 - math.cos(angle)) * hat @ hat)
        p = p + E @ np.asarray(step, float)
    return np.hstack([axes, np.cross(axes, p - places)])


def column(v):
    return mpmath.matrix([mpmath.mpf(float(x)) for x in v])


def floats(matrix):
    return tuple(float(x) for x in matrix)


def largest(matrix):
    return max(abs(x) for x in matrix)


def unit_vectors(rng, n):
    h = rng.normal(size=(n, 3))
    return h / np.linalg.norm(h, axis=1)[:, None]


def across(h):
    """A unit vector across h."""
    v = np.cross(h, np.eye(3)[np.argmin(np.abs(h))])
    return tuple(map(float, v / np.linalg.norm(v)))


def rows_of(vectors):
    return tuple(tuple(map(float, v)) for v in vectors)


def angles(row):
    """Angles of a row (c, s, c, s, ..., margin)."""
    return [mpmath.atan2(row[k + 1], row[k]) for k in range(0, len(row) - 1, 2)]
