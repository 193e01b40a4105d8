"""Parts of poses (..., 4, 4) and of twists (..., 6)."""

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
