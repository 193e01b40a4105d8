"""Poses as rows of numbers, in the formats "12", "16" and "7", quaternions with their order."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from ...errors import InputError, PoekinError, PoseError, safe_repr
from ...groups import se3
from ...groups.arrays import Array, poses
from ...groups.so3.exp_log import exp_of_vectors
from ...model.kinematics.analytic import quaternion_wxyz

PoseFormat = Literal["12", "16", "7"]
QuaternionOrder = Literal["wxyz", "xyzw"]
FORMATS: tuple[PoseFormat, ...] = get_args(PoseFormat)
ORDERS: tuple[QuaternionOrder, ...] = get_args(QuaternionOrder)
NORM = 1e-3
"""Largest deviation from 1 of a quaternion's length; it is divided by its length."""

_ENTRIES = tuple(f"T{i}{j}" for i in range(4) for j in range(4))


def columns(format: Any, quaternion: Any = None) -> tuple[str, ...]:
    """The names of a format's numbers, in order.

    - "12": the first three rows of T (4x4), row by row: T00 T01 T02 T03 T10 ... T23, so that T03,
      T13, T23 are p
    - "16": all four rows, as `poekin fk` writes them
    - "7": p and then the unit quaternion of R, whose order has to be said: x y z qw qx qy qz, or x
    y z qx qy qz qw Raises: InputError, also for an order that is missing, or of no use.
    """
    if not isinstance(format, str) or format not in FORMATS:
        raise InputError(
            f"format: expected one of {', '.join(FORMATS)} (numbers a pose), got {safe_repr(format)}"
        )
    if format != "7":
        if quaternion is not None:
            raise InputError(
                f"quaternion: the format {format} has none; expected together with the format 7 only"
            )
        return _ENTRIES[: int(format)]
    if not isinstance(quaternion, str) or quaternion not in ORDERS:
        asked = f"got {safe_repr(quaternion)}"
        if quaternion is None:
            asked = "none was given"
        raise InputError(
            f"quaternion: the format 7 needs the order of its quaternion, {' or '.join(ORDERS)}; {asked}"
        )
    parts = (f"q{letter}" for letter in quaternion)
    return ("x", "y", "z", *parts)


def to_poses(
    rows: Array,
    format: str,
    quaternion: str | None,
    where: Any,
) -> Array:
    """T (N, 4, 4) of rows (N, k). A row that is not finite gives NaN, and no error.

    where(i): how messages call row i. Raises: PoseError, with the row, for what is no pose: a
    rotation that misses orthonormality by more than 1e-5, a quaternion whose length misses 1 by
    more than 1e-3.
    """
    columns(format, quaternion)
    T = np.full((len(rows), 4, 4), np.nan)
    good = np.isfinite(rows).all(axis=1)
    if format == "7":
        Q = rows[:, 3:]
        if quaternion == "xyzw":
            Q = Q[:, [3, 0, 1, 2]]
        with np.errstate(over="ignore"):  # of numbers whose squares are none
            size = np.linalg.norm(Q, axis=1)
        for i in np.flatnonzero(good & ~(np.abs(size - 1) <= NORM)):
            raise PoseError(
                f"{where(i)}: the quaternion's length is {size[i]:.6g}, expected 1 within {NORM:g}"
            )
        R = _rotation(Q[good] / size[good, None])
        T[good] = se3.pose(R, rows[good, :3])
        return T
    T[good] = np.eye(4)
    given = int(format) // 4
    T[good, :given] = rows[good].reshape(-1, given, 4)
    try:
        return poses(T)
    except PoekinError:
        for i in np.flatnonzero(good):
            _check(T[i], where(i))
        raise


def to_rows(
    T: Array,
    format: str,
    quaternion: str | None = None,
) -> Array:
    """Rows (N, k) of poses (N, 4, 4); of the two quaternions of a rotation the one with w >= 0."""
    columns(format, quaternion)
    if format != "7":
        size = int(format)
        return T[:, : size // 4].reshape(len(T), size)
    Q = quaternion_wxyz(T[:, :3, :3])
    if quaternion == "xyzw":
        Q = Q[:, [1, 2, 3, 0]]
    p = T[:, :3, 3]
    return np.concatenate([p, Q], axis=1)


def _rotation(Q: Array) -> Array:
    """R of unit quaternions (w, x, y, z), by the rotation vector: 2 atan2(|v|, w) about v."""
    size = np.linalg.norm(Q[:, 1:], axis=1, keepdims=True)
    angle = 2 * np.arctan2(size, Q[:, :1])
    ratio = np.full_like(size, 2.0)
    np.divide(angle, size, out=ratio, where=size > 0)
    return exp_of_vectors(ratio * Q[:, 1:])


def _check(T: Array, where: str) -> None:
    try:
        poses(T)
    except PoseError as fault:
        raise PoseError(f"{where}: {str(fault).removeprefix('T is no pose: ')}") from fault
