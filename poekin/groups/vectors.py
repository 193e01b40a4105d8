"""Vectors along the last axis of arrays: those that poses (..., 4, 4) and twists (..., 6) hold, their
lengths and products.
"""

from __future__ import annotations

import numpy as np

from .arrays import Array


def rotation_part(T: Array) -> Array:
    """R (..., 3, 3) of poses."""
    return T[..., :3, :3]


def translation_part(T: Array) -> Array:
    """p (..., 3) of poses."""
    return T[..., :3, 3]


def angular_part(V: Array) -> Array:
    """omega (..., 3) of twists (omega; v)."""
    return V[..., :3]


def linear_part(V: Array) -> Array:
    """v (..., 3) of twists (omega; v)."""
    return V[..., 3:]


def directions(S: Array) -> Array:
    """Unit directions (..., 3) of screws: omega where it is not 0, else v, of a prismatic joint."""
    w = angular_part(S)
    turns = w.any(axis=-1, keepdims=True)
    return np.where(turns, w, linear_part(S))


def norm(x: Array) -> float:
    """Euclidean norm of all numbers of an array: the length of one vector."""
    return float(np.linalg.norm(x))


def norms(x: Array) -> Array:
    """Lengths (...) of vectors (..., n)."""
    return np.sqrt((x * x).sum(axis=-1))


def normalised(x: Array) -> Array:
    """Vectors (..., n) divided by their lengths, none of which is 0."""
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def normalised_or_zero(x: Array) -> Array:
    """Vectors (..., n) divided by their lengths; 0 stays 0."""
    size = np.linalg.norm(x, axis=-1, keepdims=True)
    return x / np.maximum(size, np.finfo(float).tiny)


def dots(x: Array, y: Array) -> Array:
    """x . y over the last axis, which stays, of length 1."""
    return (x * y).sum(axis=-1, keepdims=True)


def applied(M: Array, x: Array) -> Array:
    """M x of matrices (..., m, n) and vectors (..., n)."""
    return (M @ x[..., None])[..., 0]
