"""Finite differences on the group: the velocity and the Jacobian of any function from coordinates
to poses.

The derivative of the pose's entries is the central difference of order 12 on 12 points; Ṫ T⁻¹ and
T⁻¹ Ṫ are taken from it. Nothing is asked of the function but values.

    differences.jacobian(my_fk, [0.1, -0.5, 0.3], "space")     (6, 3), to hold my own Jacobian to

Parameters: f, the function, of q (m,) in rad or m, its pose (4, 4) that of the tool in the base
frame; q, dq (m,); frame, "space", "body" or "hybrid"; rate. Returns: twists and columns as (ω; v),
per unit of dq, rad/s and m/s.
Raises: InputError, ShapeError for what is none of these, and where f returns another shape.
Source: the definition of the three Jacobians in the README; the stencil is the interpolating
polynomial's derivative. Accuracy: about 1e-14 · rate · size, where `rate` (the default is 1) bounds
by how many rad the tool turns about any joint per unit of a coordinate, all joints added up, and
`size` is the largest entry of the pose (at least 1). Truncation is 1e-16 · rate · size at the step
0.1/rate that is taken, and rounding of the values makes up the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

import numpy as np
from numpy.typing import ArrayLike

from poekin.errors import InputError, ShapeError, safe_repr

from ..strategies import arguments

_SIDE = 6
_WEIGHTS = [
    (-1) ** (k + 1) * factorial(_SIDE) ** 2 / (k * factorial(_SIDE - k) * factorial(_SIDE + k))
    for k in range(1, _SIDE + 1)
]

Pose = Callable[[np.ndarray], np.ndarray]


def derivative(
    f: Pose,
    q: ArrayLike,
    dq: ArrayLike,
    rate: float = 1.0,
) -> np.ndarray:
    """d/ds f(q + s dq) at s = 0, entry by entry: q and dq (m,), f(q) any shape."""
    at = _coordinates("q", q)
    direction = _coordinates("dq", dq)
    if at.shape != direction.shape:
        raise ShapeError(
            f"expected q and dq of one shape (m,), got {at.shape} and {direction.shape}"
        )
    if not callable(f):
        raise InputError(f"f: expected a function of q, got {safe_repr(f)}")
    step = 0.1 / max(arguments.number("rate", rate, 0.0, 1e100), 1.0)
    terms = [
        (w / step)
        * (np.asarray(f(at + k * step * direction)) - np.asarray(f(at - k * step * direction)))
        for k, w in enumerate(_WEIGHTS, start=1)
    ]
    return np.sum(terms, axis=0)


def velocity(
    f: Pose,
    q: ArrayLike,
    dq: ArrayLike,
    frame: str,
    rate: float = 1.0,
) -> np.ndarray:
    """The twist (ω; v) of the pose f(q) at rate dq: "space" Ṫ T⁻¹, "body" T⁻¹ Ṫ, or "hybrid" (ω of
    space, ṗ).

    q and dq (m,), f(q) (4, 4); returns (6,). Raises InputError for another frame.
    """
    dT = derivative(f, q, dq, rate)
    T = np.asarray(f(_coordinates("q", q)))
    if T.shape != (4, 4):
        raise ShapeError(f"f: expected a pose (4, 4) at q, got shape {T.shape}")
    R = T[:3, :3]
    p = T[:3, 3]
    dR = dT[:3, :3]
    dp = dT[:3, 3]
    if frame == "body":
        return np.concatenate([_axial(R.T @ dR), R.T @ dp])
    w = _axial(dR @ R.T)
    if frame == "hybrid":
        return np.concatenate([w, dp])
    if frame == "space":
        return np.concatenate([w, dp - np.cross(w, p)])
    raise InputError(f'frame must be "space", "body" or "hybrid", not {frame!r}')


def jacobian(
    f: Pose,
    q: ArrayLike,
    frame: str,
    rate: float = 1.0,
) -> np.ndarray:
    """The Jacobian (6, m) of f at q (m,), rows (ω; v): `velocity` of each coordinate in turn."""
    at = _coordinates("q", q)
    columns = [velocity(f, at, direction, frame, rate) for direction in np.eye(len(at))]
    return np.stack(columns, axis=1) if columns else np.zeros((6, 0))


def _coordinates(name: str, q: ArrayLike) -> np.ndarray:
    try:
        values = np.asarray(q, dtype=float)
    except (TypeError, ValueError) as fault:
        raise InputError(f"{name}: expected numbers (m,), got {safe_repr(q)}") from fault
    if values.ndim != 1:
        raise ShapeError(f"{name}: expected shape (m,), one configuration, got {values.shape}")
    return values


def _axial(X: np.ndarray) -> np.ndarray:
    """The vector of the skew part of X."""
    return np.array([X[2, 1] - X[1, 2], X[0, 2] - X[2, 0], X[1, 0] - X[0, 1]]) / 2
