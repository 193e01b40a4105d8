"""Poses of rows of numbers and rows of poses, by the layout of the numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np

from ...engine.kernels import group_kernels
from ...errors import PoekinError, PoseError
from ...groups import euler, se3, so3
from ...groups.arrays import Array, map_kernel, poses
from ...groups.so3.exp_log import exp_of_vectors
from ...groups.vectors import norms, rotation_part, translation_part
from ...model.kinematics.analytic import quaternion_wxyz
from .layout import PoseLayout

NORM = 1e-3
"""Largest deviation from 1 of a quaternion's length; it is divided by its length."""

_WXYZ_OF = {"wxyz": [0, 1, 2, 3], "xyzw": [3, 0, 1, 2]}
_OF_WXYZ = {"wxyz": [0, 1, 2, 3], "xyzw": [1, 2, 3, 0]}


def to_poses(
    rows: Array,
    layout: PoseLayout,
    where: Callable[[int], str],
) -> Array:
    """T (N, 4, 4) of rows (N, k). A row that is not finite gives NaN, and no error.

    where(i): how messages call row i. Raises: PoseError, with the row, for what is no pose: a
    rotation that misses orthonormality by more than 1e-5, a quaternion whose length misses 1 by
    more than 1e-3.
    """
    T = np.full((len(rows), 4, 4), np.nan)
    good = np.asarray(np.isfinite(rows).all(axis=1))
    if layout.rotation != "matrix":
        R = _rotations(rows, good, layout, where)
        T[good] = se3.pose(R, _in_metres(rows[good, :3], layout))
        return T
    given = rows.shape[1] // 4
    T[good] = np.eye(4)
    T[good, :given] = rows[good].reshape(-1, given, 4)
    T[good, :3, 3] = _in_metres(translation_part(T[good]), layout)
    try:
        return poses(T)
    except PoekinError:
        for i in np.flatnonzero(good).tolist():
            _check(T[i], where(i))
        raise


def to_rows(T: Array, layout: PoseLayout) -> Array:
    """Rows (N, k) of poses (N, 4, 4); of the two quaternions of a rotation the one with w >= 0."""
    scale = 1000.0 if layout.length == "mm" else 1.0
    R = rotation_part(T)
    if layout.rotation == "matrix":
        size = len(layout.columns)
        rows = T.copy()
        rows[:, :3, 3] *= scale
        return rows[:, : size // 4].reshape(len(T), size) + 0.0
    p = scale * translation_part(T)
    return np.concatenate([p, _rotation_numbers(R, layout)], axis=1) + 0.0


def _in_metres(lengths: Array, layout: PoseLayout) -> Array:
    if layout.length == "mm":
        return lengths / 1000.0
    return lengths


def _rotations(
    rows: Array,
    good: np.ndarray,
    layout: PoseLayout,
    where: Callable[[int], str],
) -> Array:
    """R of the rows that are good."""
    numbers = rows[:, 3:]
    degrees = layout.angle == "deg"
    if layout.rotation in _WXYZ_OF:
        with np.errstate(over="ignore"):  # of numbers whose squares are none
            size = norms(numbers)
        for i in np.flatnonzero(good & ~(np.abs(size - 1) <= NORM)).tolist():
            raise PoseError(
                f"{where(i)}: the quaternion's length is {size[i]:.6g}, expected 1 within {NORM:g}"
            )
        Q = numbers[:, _WXYZ_OF[layout.rotation]]
        return map_kernel(group_kernels.so3_from_quaternion, 1, (3, 3), Q[good])
    if layout.rotation == "vector":
        vectors = np.deg2rad(numbers) if degrees else numbers
        return exp_of_vectors(vectors[good])
    if layout.reverse:
        numbers = numbers[:, ::-1]
    sequence = cast(euler.Sequence, layout.rotation)
    return euler.rotations(numbers[good], sequence, degrees=degrees)


def _rotation_numbers(R: Array, layout: PoseLayout) -> Array:
    degrees = layout.angle == "deg"
    if layout.rotation in _OF_WXYZ:
        return quaternion_wxyz(R)[:, _OF_WXYZ[layout.rotation]]
    if layout.rotation == "vector":
        vectors = so3.log(R)
        return np.rad2deg(vectors) if degrees else vectors
    sequence = cast(euler.Sequence, layout.rotation)
    angles = euler.angles(R, sequence, degrees=degrees)
    return angles[:, ::-1] if layout.reverse else angles


def _check(T: Array, where: str) -> None:
    try:
        poses(T)
    except PoseError as fault:
        raise PoseError(f"{where}: {str(fault).removeprefix('T is no pose: ')}") from fault
