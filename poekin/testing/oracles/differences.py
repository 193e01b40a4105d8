"""Finite differences on the group: the velocity and the Jacobian of any function from coordinates
to poses.

The derivative of the pose's entries is the central difference of order 12 on 12 points; Ṫ T⁻¹ and
T⁻¹ Ṫ are taken from it. Nothing is asked of the function but values.

Source: the definition of the three Jacobians in the README; the stencil is the interpolating
polynomial's derivative. Accuracy: about 1e-14 · rate · size, where `rate` bounds
by how many rad the tool turns about any joint per unit of a coordinate, all joints added up, and
`size` is the largest entry of the pose (at least 1). Truncation is 1e-16 · rate · size at the step
0.1/rate that is taken, and rounding of the values makes up the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from poekin.errors import InputError, ShapeError, safe_repr

from ...groups.arrays import Array
from ..strategies import arguments

_SIDE = 6
_WEIGHTS = [
    (-1) ** (k + 1) * factorial(_SIDE) ** 2 / (k * factorial(_SIDE - k) * factorial(_SIDE + k))
    for k in range(1, _SIDE + 1)
]

PoseFunction = Callable[[Array], Array]
NamedFrame = Literal["space", "body", "hybrid"]


def derivative(
    f: PoseFunction,
    q: ArrayLike,
    dq: ArrayLike,
    rate: float = 1.0,
) -> Array:
    """Derivative of an array along a direction, d/ds f(q + s dq) at s = 0, entry by entry.

    Parameters
    ----------
    f : callable
        Function of q (m,) that returns an array.
    q, dq : (m,) array_like
        Coordinates and direction, rad or m, and per s.
    rate : float, default 1.0
        Bound on how fast f turns along dq, rad per unit of s.

    Returns
    -------
    df : (...) ndarray
        The derivative, in the shape of f(q).

    Raises
    ------
    InputError
        If f is no function, or q, dq or rate are no numbers.
    ShapeError
        If q and dq are not of one shape (m,).
    """
    at = _coordinates("q", q)
    direction = _coordinates("dq", dq)
    if at.shape != direction.shape:
        raise ShapeError(
            f"expected q and dq of one shape (m,), got {at.shape} and {direction.shape}"
        )
    if not callable(f):
        raise InputError(f"f: expected a function of q, got {safe_repr(f)}")
    step = 0.1 / max(arguments.number("rate", rate, 0.0, 1e100), 1.0)
    terms = []
    for k, weight in enumerate(_WEIGHTS, start=1):
        change = k * step * direction
        ahead = np.asarray(f(at + change))
        behind = np.asarray(f(at - change))
        terms.append(weight / step * (ahead - behind))
    return np.sum(terms, axis=0)


def velocity(
    f: PoseFunction,
    q: ArrayLike,
    dq: ArrayLike,
    frame: NamedFrame,
    rate: float = 1.0,
) -> Array:
    """Twist (ω; v) of a moving pose, by finite differences.

    Parameters
    ----------
    f : callable
        Function of q (m,) that returns the pose (4, 4) of the tool in the base frame.
    q, dq : (m,) array_like
        Coordinates and rates, rad or m, and per s.
    frame : {"space", "body", "hybrid"}
        Ṫ T⁻¹, T⁻¹ Ṫ, or ω of space with ṗ.
    rate : float, default 1.0
        Bound on how fast the tool turns along dq, rad/s.

    Returns
    -------
    V : (6,) ndarray
        The twist, rad/s and m/s.

    Raises
    ------
    InputError
        For another frame, and as `derivative`.
    ShapeError
        If f returns another shape, and as `derivative`.
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
    f: PoseFunction,
    q: ArrayLike,
    frame: NamedFrame,
    rate: float = 1.0,
) -> Array:
    """Jacobian of a function that returns poses, by finite differences.

    Parameters
    ----------
    f : callable
        Function of q (m,) that returns the pose (4, 4) of the tool in the base frame.
    q : (m,) array_like
        Coordinates, rad or m.
    frame : {"space", "body", "hybrid"}
        Frame of the rows, as of `velocity`.
    rate : float, default 1.0
        Bound on how far the tool turns, rad per unit of a coordinate.

    Returns
    -------
    J : (6, m) ndarray
        Rows (ω; v), rad and m per unit of q.

    Raises
    ------
    InputError
        As `velocity`.
    ShapeError
        As `velocity`.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> from poekin.testing.oracles import differences
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> q = [0.1, -1.2, 0.9, -0.5, 0.3, 0.2]
    >>> J = differences.jacobian(arm.fk, q, "hybrid")  # of one's own function
    >>> bool(np.abs(arm.jacobian(q, "hybrid") - J).max() < 1e-13)
    True
    """
    at = _coordinates("q", q)
    columns = [velocity(f, at, direction, frame, rate) for direction in np.eye(len(at))]
    return np.reshape(columns, (len(at), 6)).T


def _coordinates(name: str, q: ArrayLike) -> Array:
    try:
        values = np.asarray(q, dtype=float)
    except (TypeError, ValueError) as fault:
        raise InputError(f"{name}: expected numbers (m,), got {safe_repr(q)}") from fault
    if values.ndim != 1:
        raise ShapeError(f"{name}: expected shape (m,), one configuration, got {values.shape}")
    return values


def _axial(X: Array) -> Array:
    """Vector of the skew part of X."""
    K = X - X.T
    return np.array([K[2, 1], K[0, 2], K[1, 0]]) / 2
