"""Lengths and products of vectors along the last axis of arrays."""

from __future__ import annotations

import numpy as np

from .arrays import Array


def norm(x: Array) -> float:
    """Euclidean norm of all numbers of an array: the length of one vector."""
    return float(np.linalg.norm(x))


def norms(x: Array) -> Array:
    """Lengths (...) of vectors (..., n)."""
    return np.linalg.norm(x, axis=-1)


def normalised(x: Array) -> Array:
    """Vectors (..., n) divided by their lengths, none of which is 0."""
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def dots(x: Array, y: Array) -> Array:
    """x . y over the last axis, which stays, of length 1."""
    return (x * y).sum(axis=-1, keepdims=True)


def applied(M: Array, x: Array) -> Array:
    """M x of matrices (..., m, n) and vectors (..., n)."""
    return (M @ x[..., None])[..., 0]
