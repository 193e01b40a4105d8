"""Measurements as CSV files, in and out: joint readings and what was measured at them, one row an
observation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any, NamedTuple, get_args

import numpy as np

from ....checks import choice
from ....errors import (
    InputError,
    ShapeError,
    UnknownName,
    escape_unprintable,
    quote,
    safe_repr,
    suggest,
)
from ....formats.poses import pose_rows
from ....formats.poses.layout import PoseFormat
from ....formats.poses.layout import layout as pose_layout
from ....formats.text import csv_header, csv_rows
from ....formats.text.atomic_write import FilePath, write_whole
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import finite
from ....model.coordinates import coordinates
from ..model.configurations import Repeats, average_repeats
from ..terms.condition_columns import ConditionColumn, condition_columns
from . import columns
from .columns import ColumnLayout
from .header import NO_HEADER, SI, Convention, read_header
from .measurement import Measurement, MeasurementKind, rows_of
from .points import Distances, Points
from .poses import EyeInHand, EyeToHand, Poses

KINDS: dict[str, type[Measurement]] = {
    "poses": Poses,
    "eye-in-hand": EyeInHand,
    "eye-to-hand": EyeToHand,
    "points": Points,
    "distances": Distances,
}


class MeasurementTable(NamedTuple):
    """The rows of a file of measurements: joint readings q (N, m), the measured values (N, k) in
    the order of the layout's columns, the file and line of each row, and columns (N,) of conditions.
    """

    q: Array
    values: Array
    layout: ColumnLayout
    sources: list[str]
    conditions: Mapping[str, Array] = MappingProxyType({})


def read(  # noqa: PLR0913 - options by keyword
    path: FilePath,
    chain: Chain,
    *,
    kind: MeasurementKind | None = None,
    ignore: Iterable[str] = (),
    progress: csv_rows.Progress | None = None,
    format: PoseFormat | None = None,
    mm: bool | None = None,
    deg: bool | None = None,
    rename: Mapping[str, str] | None = None,
    repeats: Repeats = "keep",
    **known: Any,
) -> tuple[Array, Measurement]:
    """Joint readings and the measurements made at them, out of a CSV file with one a line.

    The first line names the columns, in any order; lines above it that begin with #, // or % are
    passed over, and where numbers alone follow, the last of them is the first line. Coordinates: by
    the chain's q_names, or q1 ... qm in their order (or j, joint, joint_, axis, axis_, theta, from 1
    or 0). Measurement: T00 ... T23 or T00 ... T33 (T, row by row), or x, y, z, qw, qx, qy, qz (unit
    quaternion, by its names in any order), or x, y, z, roll, pitch, yaw, or the columns of `format`:
    poses; x, y, z or px, py, pz: one point; x1, y1, z1, x2, ...: several; distance. Numbers are in
    rad and m unless `format`, `mm`, `deg` or the first line (`X [mm]`, `q1_deg`) says something else.
    Commas, semicolons (with decimal commas), tabs or blanks are between.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file.
    chain : Chain
        The arm whose coordinates were read.
    kind : {"poses", "eye-in-hand", "eye-to-hand", "points", "distances"}, optional
        Kind of the measurements; by default as the columns say, and "poses" of poses.
    ignore : str or iterable of str, default ()
        Columns that are passed over, whatever is in them.
    progress : callable, optional
        Called as progress(characters read, size).
    format : str, optional
        What the numbers of poses are, as in `poekin.poses.from_numbers`: "abc", "wpr", "ur", ...
    mm : bool, optional
        Whether lengths are in mm: of the measurements, and of joints that slide.
    deg : bool, optional
        Whether angles are in degrees: joints, and those of `format`.
    rename : mapping of str to str, optional
        Names that are taken for those of columns in the file: {"x_t": "x [mm]"}.
    repeats : {"keep", "average"}, default "keep"
        Rows at the same configuration (to 1 mrad and 1 mm) stay as they are, and `calibrate` takes
        them as clusters; or their mean is taken, as by `average_repeats`.
    **known : Any
        Other arguments of the kind of measurement: covariance, points, frame, centre, point,
        guess, board, camera.

    Returns
    -------
    q : (N, m) ndarray
        Joint readings, rad or m.
    measurements : Poses, EyeInHand, EyeToHand, Points or Distances
        The measurements; of poses, as of T_base_tip in the base frame.

    Raises
    ------
    FileError
        If the file cannot be read.
    UnknownName
        If a column is none of these, or `known` names nothing that the kind has.
    InputError
        If a column is missing or there twice, the kind does not fit, or, with file and line, a cell
        is empty, no number or not finite.
    PoseError
        With file and line, if the columns make no pose.

    Notes
    -----
    Accuracy: the numbers in the file. Source: none, a format of poekin's own.
    """
    choice(repeats, get_args(Repeats), "repeats")
    convention = Convention.of(format, mm, deg)._replace(rename=rename or {})
    table = read_table(
        path,
        chain,
        kind=kind,
        ignore=ignore,
        progress=progress,
        convention=convention,
    )
    made = make_measurement(table, kind, known)
    if repeats == "average":
        return average_repeats(table.q, made)
    return table.q, made


def read_table(
    path: FilePath | int,
    chain: Chain | Callable[[list[str], str], Chain],
    where: str = "",
    *,
    kind: MeasurementKind | None = None,
    ignore: Iterable[str] = (),
    progress: csv_rows.Progress | None = None,
    convention: Convention = SI,
    conditions: bool = False,
) -> MeasurementTable:
    """The numbers of a file of measurements, before anything is made of them; the file is read
    once, so it may be a pipe, or the number of an open one. Parameters and errors: those of `read`;
    chain, the arm, or what makes it of the first line's words and place; where, what messages call
    the file (default: its path); conditions, whether columns of payload, temperature and time are read.
    """
    if kind is not None:
        choice(kind, KINDS, "kind")
    if isinstance(ignore, str):
        ignore = (ignore,)
    passed_over = tuple(ignore)
    header = NO_HEADER
    told: list[ConditionColumn] = []

    def choose(words: list[str], here: str) -> list[int]:
        nonlocal header, told, chain
        words = convention.renamed(words, here)
        if not isinstance(chain, Chain):
            chain = chain(words, here)
        if conditions:
            told = condition_columns(words, {*chain.q_names, *passed_over}, here)
        of_others = (*passed_over, *(column.word for column in told))
        header = read_header(words, chain, of_others, here, convention)
        layout = header.layout
        if kind is not None and kind not in layout.kinds:
            kinds = " or ".join(layout.kinds)
            those = f"the columns {columns.describe(layout)} are those of {kinds}"
            raise InputError(f"{here}: {those}, and kind is {safe_repr(kind)}")
        return [*header.indices, *(column.index for column in told)]

    with csv_rows.opened(path, where) as (stream, where, size):
        rows, lines = csv_rows.read_chosen(stream, choose, where, progress, size)
    names = [*header.names, *(column.word for column in told)]
    for i, k in np.argwhere(~np.isfinite(rows)):
        raise InputError(
            f"{where}:{lines[i]}, column {quote(names[k])}: expected a finite number, got "
            f"{rows[i, k]}; leave the line out where nothing was measured"
        )
    sources = [f"{where}:{line}" for line in lines]
    for k, convert in header.conversions:
        rows[:, k] = convert(rows[:, k])
    q, values, given = np.split(rows, [chain.dof, len(header.names)], axis=1)
    found = {column.name: column.factor * x for column, x in zip(told, given.T, strict=True)}
    return MeasurementTable(q, values, header.layout, sources, found)


def write(path: FilePath, chain: Chain, q: Any, measurement: Measurement) -> None:
    """Write measurements and the joint readings they were made at as `read` reads them.

    Kind, covariances and what is known of points and frames are not in the file.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file, which appears whole or not at all.
    chain : Chain
        The arm whose coordinates were read.
    q : (N, m) array_like or dict
        Joint readings, rad or m; those are written that the measurement has.
    measurement : Poses, EyeInHand, EyeToHand, Points or Distances
        Measurements at rows of q.

    Raises
    ------
    ShapeError
        If q does not have a row for each measurement.
    InputError
        If q is not finite, or `measurement` is none.
    FileError
        If the file cannot be written.

    Notes
    -----
    Accuracy: exact, read back to the last bit. Source: none, a format of poekin's own.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 20, kind="points")
    >>> pk.calibration.write("points.csv", arm, made.q, made.measurements)
    >>> q, points = pk.calibration.read("points.csv", arm)
    >>> bool((q == made.q).all()), len(points)
    (True, 20)
    """
    measured, values = _columns(measurement)
    q = coordinates(q, chain.q_names)
    rows = rows_of(measurement, len(values))
    unlike = measurement.rows is None and len(q) != len(values)
    if q.ndim != 2 or unlike or (rows >= len(q)).any():
        raise ShapeError(
            f"q: expected shape (N, {chain.dof}) with a row for each of {len(values)}, got {q.shape}"
        )
    q = finite(q, "q")
    names = chain.q_names
    q1_to_qm = csv_header.numbered(chain.dof)
    # names that another reader, or this one, would take for something else
    if set(names) & {*measured, *q1_to_qm} or any(
        escape_unprintable(name).strip() != name for name in names
    ):
        names = q1_to_qm
    table = np.column_stack([q[rows], values])
    text = csv_rows.text((*names, *measured), table)
    write_whole(path, text.encode())


def make_measurement(
    table: MeasurementTable,
    kind: str | None,
    known: dict[str, Any],
) -> Measurement:
    """The measurement that a table holds. Parameters: kind and known, as those of `read`; so are
    the errors.
    """
    kind = kind or table.layout.kinds[0]
    made = KINDS[kind]
    first, *others = (field.name for field in fields(made) if field.name != "rows")  # type: ignore[arg-type]
    for name in known:
        if name not in others:
            raise UnknownName(f"{quote(name)} is nothing that {kind} have; {suggest(name, others)}")
    return made(**{first: _values(table, kind, known)}, **known)


def _values(
    table: MeasurementTable,
    kind: str,
    known: dict[str, Any],
) -> Array:
    """The measured values of a table as the kind of measurement takes them."""
    values = table.values
    pose = table.layout.pose
    if pose is not None:
        return pose_rows.to_poses(values, pose, table.sources.__getitem__)
    if kind == "points":
        count = len(table.layout.columns) // 3
        if count > 1 and "points" not in known:
            raise InputError(
                f"points: the file has {count} points a line; say where they are in the tip frame, "
                "(k, 3), or points=None"
            )
        return values.reshape(-1, count, 3)
    distances = values[:, 0]
    for i in np.flatnonzero(distances <= 0):
        raise InputError(f"{table.sources[i]}: expected a distance above 0, got {distances[i]:g}")
    return distances


def _columns(measurement: Measurement) -> tuple[tuple[str, ...], Array]:
    """The names and values (N, k) of the columns of a measurement."""
    if isinstance(measurement, (Poses, EyeInHand, EyeToHand)):
        twelve = pose_layout("12")
        return twelve.columns, pose_rows.to_rows(np.asarray(measurement.T), twelve)
    if isinstance(measurement, Points):
        p = np.asarray(measurement.p)
        count = p.shape[1]
        names = columns.point_columns(count) if count > 1 else ("x", "y", "z")
        return names, p.reshape(len(p), -1)
    if isinstance(measurement, Distances):
        return ("distance",), np.asarray(measurement.d)[:, None]
    every = ", ".join(kind.__name__ for kind in KINDS.values())
    raise InputError(f"measurement: expected one of {every}, got {safe_repr(measurement)}")
