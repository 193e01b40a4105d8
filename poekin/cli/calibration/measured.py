"""The measurements that `poekin calibrate` is given: files, and what the options say of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, get_args

import numpy as np

from ...checks import choice, positive
from ...errors import InputError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...progress_line import ProgressLine
from ...solve.calibration.measurements import data
from ...solve.calibration.measurements.header import SI, Convention
from ...solve.calibration.measurements.measurement import Measurement
from ...solve.calibration.model.configurations import Averages, Repeats, averages
from ..array_files import to_open
from ..kinematics.poses import option_numbers
from ..model import STANDARD_INPUT, STDIN
from ..output import complain, path_text
from . import reflectors


class MeasurementOptions(NamedTuple):
    """Options about measurements: see the help of each."""

    kind: Sequence[Any]
    point: Sequence[str]
    centre: str | None
    frame: str | None
    sigma_angle: float | None
    sigma_length: float | None
    ignore: Sequence[str]
    convention: Convention = SI
    repeats: str = "keep"
    separations: str | None = None


class Measured(NamedTuple):
    """Joint readings q (N, m), the sets of measurements made at them, the file and line of each row of
    q, and columns (N,) of conditions.
    """

    q: Array
    sets: list[Measurement]
    sources: list[str]
    conditions: dict[str, Array]


_TAKES = {"points": ("point", "frame"), "poses": ("frame",), "distances": ("point", "centre")}
"""The options that say something of measurements of a kind."""


def read(paths: Sequence[str], chain: Chain, options: MeasurementOptions) -> Measured:
    """The measurements in files, one set a file.

    Raises: what `data.read` does; InputError for options that do not fit.
    """
    choice(options.repeats, get_args(Repeats), "--repeats")
    kinds = list(options.kind) or [None] * len(paths)
    if len(options.kind) == 1:
        kinds *= len(paths)
    if len(kinds) != len(paths):
        raise InputError(
            f"--kind: expected one for all files or one for each of {len(paths)}, got {len(kinds)}"
        )
    tables = []
    for path, kind in zip(paths, kinds, strict=True):
        place = STANDARD_INPUT if path in STDIN else ""
        with ProgressLine(f"reading {place or path_text(path)}") as progress:
            tables.append(
                data.read_table(
                    to_open(path, "measurements"),
                    chain,
                    place,
                    kind=kind,
                    ignore=options.ignore,
                    progress=progress,
                    convention=options.convention,
                    conditions=True,
                )
            )
    made = [kind or table.layout.kinds[0] for kind, table in zip(kinds, tables, strict=True)]
    check_fit(options, made)
    readings = [np.empty((0, chain.dof))]
    sets: list[Measurement] = []
    sources: list[str] = []
    columns = []
    for kind, table in zip(made, tables, strict=True):
        known = known_arguments(options, kind, len(table.layout.columns) // 3)
        s = data.make_measurement(table, kind, known)
        every = np.arange(len(table.q))
        found = Averages(table.q, s, dict(table.conditions), every)
        if options.repeats == "average":
            found = averages(table.q, every, s, table.conditions)
        rows = np.arange(len(found.q)) + len(sources)
        sets.append(found.measurements.with_rows(rows))
        readings.append(found.q)
        columns.append(found.conditions)
        sources += [table.sources[row] for row in found.first]
    if options.repeats == "average":
        count = sum(len(table.q) for table in tables)
        complain(f"{count} rows are averaged: {len(sources)} configurations")
    if reflectors.are_unknown(options.point):
        sets += reflectors.with_separations(sets, paths, options.separations, options.convention)
    return Measured(np.concatenate(readings), sets, sources, _conditions(columns, paths))


def _conditions(
    columns: Sequence[dict[str, Array]],
    paths: Sequence[str],
) -> dict[str, Array]:
    """Conditions of all rows. Raises: InputError where a file does not say what another one says."""
    names = dict.fromkeys(name for own in columns for name in own)
    for own, path in zip(columns, paths, strict=True):
        for name in names:
            if name not in own:
                raise InputError(
                    f"{path_text(path)}: expected a column {quote(name)}, as another file has one;"
                    f" --ignore {name} passes that over"
                )
    return {name: np.concatenate([own[name] for own in columns]) for name in names}


def check_fit(options: MeasurementOptions, kinds: Sequence[str]) -> None:
    """Refuse options of which no file knows anything."""
    for name in ("point", "frame", "centre"):
        takers = [kind for kind, takes in _TAKES.items() if name in takes]
        if getattr(options, name) and not set(kinds) & set(takers):
            raise InputError(
                f"--{name}: expected with {' or '.join(takers)} only, got {', '.join(dict.fromkeys(kinds))}"
            )
    unknown = reflectors.are_unknown(options.point)
    if unknown and "points" not in kinds:
        raise InputError(f"--point unknown: expected with points only, got {', '.join(kinds)}")
    if options.separations is not None and not unknown:
        raise InputError("--separations: expected with --point unknown only")
    for option in ("sigma_angle", "sigma_length"):
        sigma = getattr(options, option)
        if sigma is not None:
            positive(sigma, option)
    if options.sigma_angle is not None and not any(_angular(kind) for kind in kinds):
        raise InputError(
            "--sigma-angle: expected with measured poses only, and there are lengths alone"
        )
    if (options.sigma_angle is None) != (options.sigma_length is None) and any(
        map(_angular, kinds)
    ):
        raise InputError(
            "--sigma-angle and --sigma-length: of measured poses, both expected or neither"
        )


def _angular(kind: str) -> bool:
    return bool(data.KINDS.get(kind, Measurement).angular)


def known_arguments(options: MeasurementOptions, kind: str, points: int) -> dict[str, Any]:
    """The other arguments of `data.read` for measurements of this kind."""
    known: dict[str, Any] = {}
    takes = _TAKES.get(kind, ())
    if options.sigma_length is not None:
        known["covariance"] = _covariance(options.sigma_angle, options.sigma_length, kind, points)
    if reflectors.are_unknown(options.point):
        known |= {"points": reflectors.SHARED} if kind == "points" else {}
    elif options.point and "point" in takes:
        positions = np.array([point(text, "--point", options) for text in options.point])
        # of several, distances are to the first
        known |= {"points": positions} if kind == "points" else {"point": positions[0]}
    if options.frame is not None and "frame" in takes:
        known["frame"] = options.frame
    if options.centre is not None and "centre" in takes:
        known["centre"] = point(options.centre, "--centre", options)
    return known


def _covariance(angle: float | None, length: float, kind: str, points: int) -> Any:
    """Covariance of one measurement of this kind, of so many points."""
    if kind == "distances":
        return length**2
    if _angular(kind):
        deviations = np.repeat(np.array([angle, length], float), 3)
    else:
        deviations = np.full(3 * points, length)
    return np.diag(np.square(deviations))


def point(text: str, option: str, options: MeasurementOptions) -> Array:
    """A point, in m, of an option that is in the unit of lengths."""
    p = vector(text, option)
    return p / 1000.0 if options.convention.mm else p


def vector(text: str, option: str) -> Array:
    """Three numbers, commas or blanks between them. Raises: InputError."""
    values = option_numbers(text, option)
    if len(values) != 3:
        raise InputError(f"{option}: three numbers expected (x,y,z), got {len(values)}")
    return values
