"""Files of sweeps of one joint at a time, by which nothing but their first lines tells of the arm."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError, UnknownName, join_names, quote, suggest
from ....formats.text.csv_header import numbered, numbered_coordinates
from ....groups.arrays import Array
from ....model import screw
from ....model.chain import Chain
from ....progress_line import ProgressLine
from ....solve.calibration.circles.joint_sweep import HELD, JointSweep
from ....solve.calibration.measurements import data
from ....solve.calibration.measurements.data import MeasurementTable
from ....solve.calibration.measurements.header import Convention
from ....solve.calibration.measurements.poses import Poses
from ...array_files import called, to_open
from ...model import STANDARD_INPUT, STDIN

SWEEP = re.compile(r"sweep of joint (\d+)")
"""A sweep as messages of the library call it."""
_TURNS = screw.revolute(np.ones(3), np.zeros(3))
_SLIDES = screw.prismatic(np.ones(3))


class SweepFile(NamedTuple):
    """Sweep of a joint and the file that it is from, as messages call it."""

    sweep: JointSweep
    file: str


def read(
    files: Sequence[str],
    names: Sequence[str],
    slides: Sequence[str],
    ignore: Sequence[str],
    convention: Convention,
) -> tuple[Chain, list[SweepFile]]:
    """Some arm with joints of these names, or as many as the files number, and the sweep of each.

    Raises: what `data.read` does; InputError where the files are not one sweep of each joint.
    """
    given = _arm(names, slides) if names else None
    tables = [_read(path, given, slides, ignore, convention) for path in files]
    count = tables[0].q.shape[1]
    arm = given or _arm(numbered(count), slides)
    sweeps = []
    for path, table in zip(files, tables, strict=True):
        place = called(path)
        if table.q.shape[1] != count:
            raise InputError(
                f"{place}: columns of {table.q.shape[1]} joints, and of {count} in {called(files[0])}"
            )
        sweeps.append(SweepFile(_sweep(table, arm, place), place))
    _check_each_once(sweeps, arm)
    return arm, sweeps


def _arm(names: Sequence[str], slides: Sequence[str]) -> Chain:
    """Some arm with joints of these names and kinds: by it columns are read. Raises: UnknownName."""
    for name in slides:
        if name not in names:
            raise UnknownName(f"--prismatic: no joint {quote(name)}; {suggest(name, names)}")
    screws = [_SLIDES if name in slides else _TURNS for name in names]
    return Chain.from_space(screws, np.eye(4), joint_names=names)


def _read(
    path: str,
    arm: Chain | None,
    slides: Sequence[str],
    ignore: Sequence[str],
    convention: Convention,
) -> MeasurementTable:
    """Rows of a file, of as many joints as its first line numbers where nothing names them."""

    def arm_of(words: list[str], here: str) -> Chain:
        count = numbered_coordinates(words)
        if not count:
            raise InputError(
                f"{here}: expected columns of joints, q1, q2, ..., or --joints with their names, got "
                f"{join_names(words)}"
            )
        return _arm(numbered(count), slides)

    with ProgressLine(f"reading {called(path)}") as progress:
        return data.read_table(
            to_open(path, "sweeps"),
            arm or arm_of,
            STANDARD_INPUT if path in STDIN else "",
            ignore=ignore,
            progress=progress,
            convention=convention,
        )


def _sweep(table: MeasurementTable, arm: Chain, place: str) -> JointSweep:
    """The sweep in a file's rows, of the joint that moved. Raises: InputError."""
    q = table.q
    if not len(q):
        raise InputError(f"{place}: expected readings of a sweep, got none")
    if table.layout.pose is None and table.values.shape[1] != 3:
        columns = ", ".join(table.layout.columns)
        raise InputError(f"{place}: expected one point a line, or poses, got {columns}")
    made = data.make_measurement(table, None, {})
    measured = made.T if isinstance(made, Poses) else table.values
    off = np.abs(q - np.median(q, axis=0))
    joint = int(np.argmax(off.max(axis=0)))
    off[:, joint] = 0.0
    _check_stands(off, table.sources, arm, joint)
    slides = arm.kinds[joint] == "prismatic"
    kind = "prismatic" if slides else "revolute"
    name = arm.joint_names[joint]
    try:
        return JointSweep(joint, q, measured, kind)
    except InputError as fault:
        message = str(fault).replace("in degrees?", "in degrees? --deg says so")
        raise InputError(SWEEP.sub(lambda _: f"{place}, {name}", message)) from fault


def _check_stands(
    off: Array,
    sources: Sequence[str],
    arm: Chain,
    joint: int,
) -> None:
    """Refuse a sweep in which others than its joint are off (N, n) from where they stand."""
    row, other = divmod(int(np.argmax(off)), off.shape[1])
    if off[row, other] <= HELD:
        return
    names = arm.joint_names
    unit = "m" if arm.kinds[other] == "prismatic" else "rad"
    raise InputError(
        f"{sources[row]}: {names[other]} is off by {off[row, other]:.3g} {unit} from where it stands; "
        f"expected {names[joint]} alone to move, the others within {HELD:g}"
    )


def _check_each_once(sweeps: Sequence[SweepFile], arm: Chain) -> None:
    """Refuse two sweeps of a joint, and a joint without one. Raises: InputError."""
    files: dict[int, str] = {}
    for sweep, file in sweeps:
        if sweep.joint in files:
            name = arm.joint_names[sweep.joint]
            raise InputError(
                f"{file}: {name} moves, as in {files[sweep.joint]}; one file a joint expected"
            )
        files[sweep.joint] = file
    missing = [name for joint, name in enumerate(arm.joint_names) if joint not in files]
    if missing:
        raise InputError(f"expected a sweep of each joint, there is none of {join_names(missing)}")
