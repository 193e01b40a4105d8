"""Paths between two poses or two configurations, over s: 0 at the one, 1 at the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, ShapeError, safe_repr
from ...groups import se3, so3
from ...groups.arrays import Array, numbers, poses
from ...groups.so3.exp_log import exp_of_vectors


def screw(T_s0: ArrayLike, T_s1: ArrayLike, s: ArrayLike) -> Array:
    """T(s) = T_s0 e^{s xi}, xi = log(T_s0^-1 T_s1): one screw motion, of constant body twist xi per
    unit of s.

    The tool turns about one axis and slides along it, all the time; its origin runs on a helix, on
    a straight line only where the two poses have the same rotation (`line`).

    Parameters: T_s0, T_s1 (..., 4, 4), poses of the tool in one frame, m; s (...), also outside 0
    ... 1. Leading axes are broadcast: two poses and s (N,) give (N, 4, 4). Returns: (..., 4, 4),
    T_s0 and T_s1 themselves at s = 0 and 1. At half a turn, where there are two ways round, the one
    of `se3.log`. NaN in an element gives NaN in that element. Raises: PoseError, ShapeError,
    InputError. Accuracy: that of `se3.log` and `se3.exp`
    (tests/solve/test_motions.py). Source: Park 1994, Lemmas 2 and 4.
    """
    T_s0, T_s1, s = _together(T_s0, T_s1, s)
    start = _exact(T_s0)
    xi = se3.log(se3.inverse(start) @ _exact(T_s1))
    return _with_ends(start @ se3.exp(s[..., None] * xi), T_s0, T_s1, s)


def line(T_s0: ArrayLike, T_s1: ArrayLike, s: ArrayLike) -> Array:
    """p(s) = p_0 + s (p_1 - p_0) and R(s) = R_0 e^{s w}, w = log(R_0^T R_1): the tool's origin on a
    straight line.

    The rotation is apart from it: about one axis, of constant angular velocity per unit of s.
    Parameters, returns, errors and accuracy: those of `screw`. Source: Park 1994, Lemmas 1 and 3.
    """
    T_s0, T_s1, s = _together(T_s0, T_s1, s)
    R_0 = _exact(T_s0)[..., :3, :3]
    R_1 = _exact(T_s1)[..., :3, :3]
    T = T_s0.copy()
    T[..., :3, :3] = R_0 @ exp_of_vectors(s[..., None] * so3.log(np.swapaxes(R_0, -1, -2) @ R_1))
    T[..., :3, 3] += s[..., None] * (T_s1[..., :3, 3] - T_s0[..., :3, 3])
    return _with_ends(T, T_s0, T_s1, s)


def joint(q_0: ArrayLike, q_1: ArrayLike, s: ArrayLike) -> Array:
    """q(s) = q_0 + s (q_1 - q_0): a straight line in the space of the coordinates, without taking
    turns off.

    Parameters: q_0, q_1 (..., m), rad or m; s (...), broadcast against their leading axes. Returns:
    (..., m), q_0 and q_1 themselves at s = 0 and 1. Raises: ShapeError, InputError. Accuracy: three
    roundings. Source: none, a line.
    """
    q_0 = numbers(q_0, "q_0")
    q_1 = numbers(q_1, "q_1")
    s = numbers(s, "s")[..., None]
    if not q_0.ndim or not q_1.ndim or q_0.shape[-1] != q_1.shape[-1]:
        raise ShapeError(
            f"q_0, q_1: expected (..., m) with the same m, got {q_0.shape} and {q_1.shape}"
        )
    try:
        return np.where(s == 1, q_1, q_0 + s * (q_1 - q_0))
    except ValueError as error:
        shapes = f"{q_0.shape}, {q_1.shape} and s {s.shape[:-1]}"
        raise ShapeError(f"q_0, q_1: the leading axes do not broadcast: {shapes}") from error


def path_lengths(T_s0: ArrayLike, T_s1: ArrayLike, along: str = "line") -> Array:
    """Lengths of a path between two poses: the way of the tool's origin (m) and the angle turned
    (rad).

    Both are passed evenly in s, so |p'| = length s' and |omega| = angle s': what `minimum_time` needs.
    Parameters: T_s0, T_s1 (..., 4, 4); along "line" (|p_1 - p_0|) or "screw" (|v| of xi = (omega;
    v), the length of the helix). Returns: (..., 2), m and rad. Raises: PoseError, ShapeError,
    InputError. Accuracy: that of `se3.log`.
    """
    if not isinstance(along, str) or along not in ("line", "screw"):
        raise InputError(f"along: expected 'line' or 'screw', got {safe_repr(along)}")
    T_s0, T_s1, _ = _together(T_s0, T_s1, 0.0)
    start = _exact(T_s0)
    end = _exact(T_s1)
    xi = se3.log(se3.inverse(start) @ end)
    way = end[..., :3, 3] - start[..., :3, 3]
    if along == "screw":
        way = xi[..., 3:]
    return np.stack([np.linalg.norm(way, axis=-1), np.linalg.norm(xi[..., :3], axis=-1)], axis=-1)


def _together(T_s0: ArrayLike, T_s1: ArrayLike, s: ArrayLike) -> tuple[Array, Array, Array]:
    """Two arrays of poses and s, of the same leading axes."""
    T_s0 = poses(T_s0, "T_s0")
    T_s1 = poses(T_s1, "T_s1")
    s = numbers(s, "s")
    try:
        batch = np.broadcast_shapes(T_s0.shape[:-2], T_s1.shape[:-2], s.shape)
    except ValueError as error:
        shapes = f"T_s0 {T_s0.shape}, T_s1 {T_s1.shape} and s {s.shape}"
        raise ShapeError(f"the leading axes do not broadcast: {shapes}") from error
    shape = (*batch, 4, 4)
    return np.broadcast_to(T_s0, shape), np.broadcast_to(T_s1, shape), np.broadcast_to(s, batch)


def _exact(T: Array) -> Array:
    """The poses with rotations to rounding: two that each miss by what is accepted would miss by
    more together.
    """
    T = T.copy()
    T[..., :3, :3] = exp_of_vectors(so3.log(T[..., :3, :3]))
    return T


def _with_ends(T: Array, T_s0: Array, T_s1: Array, s: Array) -> Array:
    """The path with the poses as they were given at its ends."""
    s = s[..., None, None]
    return np.where(s == 0, T_s0, np.where(s == 1, T_s1, T))
