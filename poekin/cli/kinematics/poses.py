"""Poses out of the arguments of a command or a file, and the options that go with them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from typer import Argument, Option

from ...errors import InputError, quote
from ...formats.poses import pose_rows
from ...formats.poses.layout import NAMED, PoseLayout, layout
from ...formats.poses.read import pose_columns, read_file, read_text
from ...formats.text.numbers import real
from ...groups.arrays import Array
from ...model.chain import Chain
from ...progress_line import ProgressLine
from .. import array_files
from ..formats.units import SI, SaidUnits
from ..output import name

FORMAT_HELP = (
    "The numbers of a pose, never guessed: matrix (12 or 16, row by row: T00 T01 T02 T03 T10 ..., m), quat (x y z in m"
    " and a unit quaternion, with --quaternion), ros (x y z qx qy qz qw), rotvec or ur (x y z rx ry rz, m and rad), rpy"
    " (roll pitch yaw, m and rad); in mm and degrees abc or kuka, wpr or fanuc, abb, staubli, yaskawa, mitsubishi,"
    " kawasaki, doosan. A pose may be text as the controller writes it."
)
Poses = Annotated[
    list[str] | None,
    Argument(metavar="POSE...", help="One pose, in the numbers of --format."),
]
Format = Annotated[str | None, Option("--format", metavar="FORMAT", help=FORMAT_HELP)]
Quaternion = Annotated[
    str | None,
    Option(
        "--quaternion",
        metavar="wxyz|xyzw",
        help="The order of the quaternion in --format quat; never guessed.",
    ),
]
Input = Annotated[
    str | None,
    Option(
        "--input",
        metavar="FILE",
        help="Poses, one a row: CSV, what a controller or ROS prints, .npy, or - (stdin).",
    ),
]
Output = Annotated[
    Path | None,
    Option("-o", "--output", help="Where the joints go: a .csv, .npy or .json file."),
]
Seed = Annotated[
    int,
    Option(
        "--seed",
        min=0,
        help="Of the random starts: the same seed gives the same result.",
    ),
]
Task = Annotated[
    str,
    Option(
        "--task",
        help="What to hold: pose, position, rotation, direction (position and tool's z axis), or "
        "planar (position in the arm's plane and the angle in it).",
    ),
]
NoLimits = Annotated[bool, Option("--no-limits", help="Let the joints leave their limits.")]

UNSOLVED = 1
"""The exit code where not all is solved."""


def read(
    words: Sequence[str] | None,
    given: str | None,
    format: str | None,
    quaternion: str | None,
    units: SaidUnits = SI,
) -> Array:
    """The poses (N, 4, 4) that a command line names; NaN where a row is not finite. Raises:
    InputError, PoseError, FileError, with file and line.
    """
    chosen = pose_layout(format, quaternion, units)
    if given is not None:
        if words:
            raise InputError(
                f"either a pose or --input expected, got both ({quote(words[0])} and {quote(given)})"
            )
        return _read_file(given, chosen, units)
    T = read_text(" ".join(words), chosen, units.said(), "the pose") if words else ()
    if len(T) != 1:
        raise InputError(f"one pose expected, got {len(T)}; or --input with a file")
    return T


def pose_layout(
    format: str | None,
    quaternion: str | None,
    units: SaidUnits,
    *,
    joints: bool = True,
) -> PoseLayout:
    """Layout that --format, --quaternion, --mm and --deg name; joints, whether --deg is of joints too.
    Raises: InputError.
    """
    if format is None:
        raise InputError(
            f"--format: expected one of {NAMED}; the format of a pose is never guessed"
        )
    return layout(format, quaternion, mm=units.mm, deg=units.deg, joints=joints)


def _read_file(given: str, chosen: PoseLayout, units: SaidUnits) -> Array:
    place = array_files.called(given)
    if Path(given).suffix.lower() != ".npy":
        return _read_text_file(given, chosen, units, place)
    tail: tuple[int, ...] = ()
    if len(chosen.columns) == 16:
        tail = (4, 4)
    rows, _ = array_files.read_rows(given, pose_columns(chosen), None, tail=tail)
    return pose_rows.to_poses(rows, chosen, lambda i: f"{place}, row {i}")


def _read_text_file(given: str, chosen: PoseLayout, units: SaidUnits, place: str) -> Array:
    file = array_files.to_open(given)
    with ProgressLine(f"reading {place}") as progress:
        return read_file(file, chosen, units.said(), place, progress)


def numbers(words: Sequence[str], what: str) -> Array:
    """Words as numbers. Raises: InputError that says which is none."""
    values = [real(word) for word in words]
    for i, value in enumerate(values):
        if value is None:
            raise InputError(f"{what} {i + 1}: a number expected, got {quote(words[i])}")
    return np.array(values, float)


def words_of(text: str | None) -> list[str]:
    """The words of an argument, commas or blanks between them."""
    return (text or "").replace(",", " ").split()


def option_numbers(text: str, option: str) -> Array:
    """The numbers of an option. Raises: InputError."""
    return numbers(words_of(text), f"{option}: number")


def check_count(values: Array, chain: Chain, where: str = "", remedy: str = "") -> None:
    """Refuse other than one number for each coordinate. Raises: InputError."""
    if len(values) != chain.dof:
        names = ", ".join(map(name, chain.q_names))
        expected = f"{chain.dof} coordinates expected ({names})"
        raise InputError(f"{where}{expected}, got {len(values)}{remedy}")


def coordinates(
    text: str | None,
    chain: Chain,
    option: str,
    units: SaidUnits = SI,
) -> Array | None:
    """The numbers of an option with one for each coordinate, commas or blanks between them, in rad
    and m.
    """
    if text is None:
        return None
    values = option_numbers(text, option)
    check_count(values, chain, f"{option}: ")
    return units.to_si(values, chain)


def for_each(
    text: str | None,
    chain: Chain,
    option: str,
    units: SaidUnits = SI,
) -> Array | float | None:
    """The numbers of an option with one for all coordinates or one for each, in rad and m."""
    if text is None or len(words_of(text)) != 1:
        return coordinates(text, chain, option, units)
    (value,) = option_numbers(text, option)
    if units.mm or units.deg:
        return units.to_si(np.full(chain.dof, value), chain)
    return float(value)
