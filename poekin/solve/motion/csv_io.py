"""Poses and joints as CSV files, in and out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, ShapeError, safe_repr
from ...formats.poses import pose_rows
from ...formats.poses.layout import PoseFormat, QuaternionOrder, layout
from ...formats.text import csv_rows
from ...formats.text.atomic_write import FilePath, write_whole
from ...formats.text.csv_header import COORDINATE, Columns
from ...groups.arrays import Array, numbers, poses
from ...model.chain import Chain

TIME = "time"


def read_poses(
    path: FilePath,
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
) -> Array:
    """Poses read from a CSV file with one pose a line, all in one frame.

    A first line may name the columns (T00 ..., or x y z qw qx qy qz) and so order them. A line with
    nan gives a pose of NaN.

    Parameters
    ----------
    path : path_like
        The file.
    format : {"12", "16", "7"}
        Numbers of a pose: "12", the first three rows of T, row by row (T00 T01 T02 T03 T10 ...
        T23); "16", all four rows; "7", x y z and a unit quaternion.
    quaternion : {"wxyz", "xyzw"}, optional
        Order of the quaternion, which the format "7" needs.

    Returns
    -------
    T : (N, 4, 4) ndarray
        Poses, m.

    Raises
    ------
    FileError
        If the file cannot be read.
    PoseError, InputError
        If a line is no pose; the message has file and line.
    UnknownName
        If the header has another name.

    Notes
    -----
    Source: none, a format of poekin's own.
    """
    chosen = layout(format, quaternion)
    columns = Columns(chosen.columns, "column", chosen.units)
    rows, lines, where = _read(path, columns)
    return pose_rows.to_poses(rows, chosen, lambda i: f"{where}:{lines[i]}")


def write_poses(
    path: FilePath,
    T: ArrayLike,
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
) -> None:
    """Writes poses as `read_poses` reads them, with a header.

    Numbers are written in the shortest form that reads back as the same float.

    Parameters
    ----------
    path : path_like
        The file; it appears whole or not at all.
    T : (N, 4, 4) array_like
        Poses, m, in any one frame.
    format, quaternion : str
        As in `read_poses`.

    Raises
    ------
    PoseError, ShapeError
        If T is no array of poses of that shape.
    InputError
        If the format or the order is none of those.
    FileError
        If the file cannot be written.

    Notes
    -----
    Source: none, a format of poekin's own.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> pk.motion.write_poses("poses.csv", [np.eye(4)], "7", quaternion="xyzw")
    >>> pk.motion.read_poses("poses.csv", "7", quaternion="xyzw").shape
    (1, 4, 4)
    """
    T = poses(T)
    if T.ndim != 3:
        raise ShapeError(f"T: expected poses (N, 4, 4), got {T.shape}")
    chosen = layout(format, quaternion)
    write_whole(path, csv_rows.text(chosen.columns, pose_rows.to_rows(T, chosen)).encode())


def read_joints(path: FilePath, names: Chain | Sequence[str]) -> tuple[Array, Array | None]:
    """Configurations, and times where it has them, from a CSV file with one of them a line.

    A first line may name the columns, in any order; with a further column `time`, the first or in
    any place that the header says, there are times. Columns NAME_velocity, as a `Trajectory` has
    them, are passed over.

    Parameters
    ----------
    path : path_like
        The file.
    names : Chain or sequence of str
        Names of the coordinates, or the chain that has them.

    Returns
    -------
    q : (N, m) ndarray
        Coordinates in the order of the names, rad or m.
    times : (N,) ndarray or None
        Times, s.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If a line is no configuration; the message has file and line.
    UnknownName
        If the header has another name.

    Notes
    -----
    Source: none, a format of poekin's own.
    """
    units = joint_units(names)
    names = _names(names)
    more = () if TIME in names else (TIME,)
    besides = velocity_columns(names)
    rows, _, _ = _read(path, Columns(names, COORDINATE, units, besides=besides, first=more))
    if rows.shape[1] > len(names):
        return rows[:, 1:], rows[:, 0]
    return rows, None


def write_joints(
    path: FilePath,
    q: ArrayLike,
    names: Chain | Sequence[str],
    *,
    times: ArrayLike | None = None,
) -> None:
    """Writes configurations as `read_joints` reads them, with a header.

    Parameters
    ----------
    path : path_like
        The file; it appears whole or not at all.
    q : (N, m) array_like
        Coordinates, rad or m.
    names : Chain or sequence of str
        Names of the coordinates, or the chain that has them.
    times : (N,) array_like, optional
        Times, s, for the first column.

    Raises
    ------
    ShapeError
        If q or `times` has another shape.
    InputError
        If `names` are no names.
    FileError
        If the file cannot be written.

    Notes
    -----
    Source: none, a format of poekin's own.
    """
    names = _names(names)
    rows, t = joints_over_time(q, times, len(names))
    if t is not None:
        names = (TIME, *names)
        rows = np.column_stack([t, rows])
    write_whole(path, csv_rows.text(names, rows).encode())


def velocity_columns(names: Sequence[str]) -> tuple[str, ...]:
    """Names of the columns with the rates of coordinates: NAME_velocity, none of them a name."""
    columns = []
    for name in names:
        column = f"{name}_velocity"
        while column in names:
            column += "_"
        columns.append(column)
    return tuple(columns)


def joints_over_time(
    q: ArrayLike,
    times: ArrayLike | None,
    count: int,
) -> tuple[Array, Array | None]:
    """Configurations (N, count) and their times (N,), where there are any. Raises: ShapeError,
    InputError.
    """
    rows = numbers(q, "q")
    if rows.ndim != 2 or rows.shape[1] != count:
        raise ShapeError(f"q: expected shape (N, {count}), got {rows.shape}")
    if times is None:
        return rows, None
    t = numbers(times, "times")
    if t.shape != rows.shape[:1]:
        raise ShapeError(f"times: expected shape ({len(rows)},), got {t.shape}")
    return rows, t


def _names(names: Any) -> tuple[str, ...]:
    if isinstance(names, Chain):
        return names.q_names
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise InputError(f"names: expected a chain or names of coordinates, got {safe_repr(names)}")
    return tuple(names)


def joint_units(names: Any) -> tuple[str, ...]:
    """Units of a chain's coordinates; of names alone, none are known."""
    if not isinstance(names, Chain):
        return ()
    return tuple("rad" if names.is_angle(k) else "m" for k in range(names.dof))


def _read(path: FilePath, columns: Columns) -> tuple[Array, np.ndarray, str]:
    with csv_rows.opened(path) as (stream, where, _):
        return *csv_rows.read(stream, columns, where), where
