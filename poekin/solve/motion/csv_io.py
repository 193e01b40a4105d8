"""Poses and joints as CSV files, in and out."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, ShapeError, safe_repr
from ...formats.text import csv_rows, pose_rows
from ...formats.text.atomic_write import write_whole
from ...groups.arrays import Array, numbers, poses
from ...model.chain import Chain

Path = str | os.PathLike[str]
TIME = "time"


def read_poses(path: Path, format: str, *, quaternion: str | None = None) -> Array:
    """Poses (N, 4, 4), m, out of a CSV file with one pose a line, all in one frame.

    Parameters: path;
    format: "12", the first three rows of T, row by row (T00 T01 T02 T03 T10 ... T23); "16", all
    four rows; "7": x y z and a unit quaternion, whose order has to be said: quaternion "wxyz" or
    "xyzw". A first line may name the columns (T00 ..., or x y z qw qx qy qz) and so order them. A
    line with nan gives a pose of NaN.
    Returns: T (N, 4, 4). Source: none, a format of poekin's own.
    Raises: FileError; PoseError and InputError with file and line; UnknownName for a header with
    another name.
    """
    names = pose_rows.columns(format, quaternion)
    rows, lines, where = _read(path, names, "column")
    return pose_rows.to_poses(rows, format, quaternion, lambda i: f"{where}:{lines[i]}")


def write_poses(path: Path, T: ArrayLike, format: str, *, quaternion: str | None = None) -> None:
    """Write poses (N, 4, 4) as `read_poses` reads them, with a header; the file appears whole or
    not at all.

    Numbers are written in the shortest form that reads back as the same float.

    Parameters: path; T (N, 4, 4), m, in any one frame; format and quaternion, as `read_poses`.
    Raises: PoseError, ShapeError, InputError, FileError. Source: none, a format of poekin's own.
    """
    T = poses(T)
    if T.ndim != 3:
        raise ShapeError(f"T: expected poses (N, 4, 4), got {T.shape}")
    header = pose_rows.columns(format, quaternion)
    write_whole(path, csv_rows.text(header, pose_rows.to_rows(T, format, quaternion)).encode())


def read_joints(path: Path, names: Chain | Sequence[str]) -> tuple[Array, Array | None]:
    """q (N, m), rad or m, out of a CSV file with one configuration a line, and times (N,), s, where
    it has them.

    Parameters: path; names, of the coordinates, or the chain that has them.
    A first line may name the columns, in any order; with a
    further column `time`, the first or in any place that the header says, there are times. Returns:
    q and times or None. Raises: FileError; InputError with file and line; UnknownName for a header
    with another name.
    Source: none, a format of poekin's own.
    """
    names = _names(names)
    more = () if TIME in names else (TIME,)
    rows, _, _ = _read(path, names, "coordinate", more)
    if rows.shape[1] > len(names):
        return rows[:, 1:], rows[:, 0]
    return rows, None


def write_joints(
    path: Path, q: ArrayLike, names: Chain | Sequence[str], *, times: ArrayLike | None = None
) -> None:
    """Write q (N, m) as `read_joints` reads it, with a header and, where given, times (N,) in the
    first column.

    The file appears whole or not at all. Parameters: path; q, times; names, as `read_joints`.
    Raises: ShapeError, InputError, FileError. Source: none, a format of poekin's own.
    """
    names = _names(names)
    q = numbers(q, "q")
    if q.ndim != 2 or q.shape[1] != len(names):
        raise ShapeError(f"q: expected shape (N, {len(names)}), got {q.shape}")
    if times is not None:
        t = numbers(times, "times")
        if t.shape != q.shape[:1]:
            raise ShapeError(f"times: expected shape ({len(q)},), got {t.shape}")
        names = (TIME, *names)
        q = np.column_stack([t, q])
    write_whole(path, csv_rows.text(names, q).encode())


def _names(names: Any) -> tuple[str, ...]:
    if isinstance(names, Chain):
        return names.q_names
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise InputError(f"names: expected a chain or names of coordinates, got {safe_repr(names)}")
    return tuple(names)


def _read(
    path: Path, names: Sequence[str], what: str, first: Sequence[str] = ()
) -> tuple[Array, np.ndarray, str]:
    with csv_rows.opened(path) as (stream, where, _):
        return *csv_rows.read(stream, names, where, what, first=first), where
