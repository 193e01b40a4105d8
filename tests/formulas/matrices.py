"""Matrices that the formulas on tuples are held against, made with NumPy and SciPy alone."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm


def hat(w):
    return np.cross(np.eye(3), w)


def brackets(xi):
    """[omega; 0] and v of a twist as a 4x4 matrix."""
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = hat(xi[:3]), xi[3:]
    return X


def exp(xi):
    return expm(brackets(xi))


def matrix(R, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def flat(T):
    """The twelve numbers of a 4x4 matrix."""
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


def Ad(T):
    """[R 0; [p] R R], twists with the angular part first."""
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [hat(p) @ R, R]])


def ad(xi):
    w, v = hat(xi[:3]), hat(xi[3:])
    return np.block([[w, np.zeros((3, 3))], [v, w]])


def product(*poses):
    return np.linalg.multi_dot([np.eye(4), np.eye(4), *poses])
