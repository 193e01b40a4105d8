"""Finite differences on the group: the velocity and the Jacobian of any function from coordinates to poses.

The derivative of the pose's entries is the central difference of order 12 on 12 points; Ṫ T⁻¹ and T⁻¹ Ṫ are taken from
it. Nothing is asked of the function but values.

Accuracy: about 1e-14 · rate · size, where `rate` (the default is 1) bounds by how many rad the tool turns about any
joint per unit of a coordinate, all joints added up, and `size` is the largest entry of the pose (at least 1).
Truncation is 1e-16 · rate · size at the step 0.1/rate that is taken, and rounding of the values makes up the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

import numpy as np
from numpy.typing import ArrayLike

from poekin.errors import InputError

_SIDE = 6
_WEIGHTS = [
    (-1) ** (k + 1) * factorial(_SIDE) ** 2 / (k * factorial(_SIDE - k) * factorial(_SIDE + k))
    for k in range(1, _SIDE + 1)
]

Pose = Callable[[np.ndarray], np.ndarray]


def derivative(f: Pose, q: ArrayLike, dq: ArrayLike, rate: float = 1.0) -> np.ndarray:
    """d/ds f(q + s dq) at s = 0, entry by entry: q and dq (m,), f(q) any shape."""
    at, direction = np.asarray(q, dtype=float), np.asarray(dq, dtype=float)
    step = 0.1 / max(rate, 1.0)
    terms = [
        (w / step) * (f(at + k * step * direction) - f(at - k * step * direction))
        for k, w in enumerate(_WEIGHTS, start=1)
    ]
    return np.sum(terms, axis=0)


def velocity(f: Pose, q: ArrayLike, dq: ArrayLike, frame: str, rate: float = 1.0) -> np.ndarray:
    """The twist (ω; v) of the pose f(q) at rate dq: "space" Ṫ T⁻¹, "body" T⁻¹ Ṫ, or "hybrid" (ω of space, ṗ).

    q and dq (m,), f(q) (4, 4); returns (6,). Raises InputError for another frame.
    """
    T, dT = f(np.asarray(q, dtype=float)), derivative(f, q, dq, rate)
    R, p, dR, dp = T[:3, :3], T[:3, 3], dT[:3, :3], dT[:3, 3]
    if frame == "body":
        return np.concatenate([_axial(R.T @ dR), R.T @ dp])
    w = _axial(dR @ R.T)
    if frame == "hybrid":
        return np.concatenate([w, dp])
    if frame == "space":
        return np.concatenate([w, dp - np.cross(w, p)])
    raise InputError(f'frame must be "space", "body" or "hybrid", not {frame!r}')


def jacobian(f: Pose, q: ArrayLike, frame: str, rate: float = 1.0) -> np.ndarray:
    """The Jacobian (6, m) of f at q (m,), rows (ω; v): `velocity` of each coordinate in turn."""
    at = np.asarray(q, dtype=float)
    columns = [velocity(f, at, direction, frame, rate) for direction in np.eye(len(at))]
    return np.stack(columns, axis=1) if columns else np.zeros((6, 0))


def _axial(X: np.ndarray) -> np.ndarray:
    """The vector of the skew part of X."""
    return np.array([X[2, 1] - X[1, 2], X[0, 2] - X[2, 0], X[1, 0] - X[0, 1]]) / 2
