"""Poses out of the arguments of a command or a file, and the options that go with them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from typer import Argument, Option

from ...errors import InputError, quote
from ...formats.text import pose_rows
from ...formats.text.numbers import real
from ...groups.arrays import Array
from ...model.chain import Chain
from .. import array_files
from ..model import refuse_options
from ..output import Progress, name

FORMAT_HELP = (
    "The numbers of a pose: 12 (the first three rows of the 4x4 matrix, row by row: T00 T01 T02 T03 T10 ..., m), 16"
    " (all four rows, as fk writes them) or 7 (x y z in m and a unit quaternion, with --quaternion)."
)
Poses = Annotated[
    list[str] | None,
    Argument(metavar="POSE...", help="One pose, in the numbers of --format."),
]
Format = Annotated[str | None, Option("--format", metavar="12|16|7", help=FORMAT_HELP)]
Quaternion = Annotated[
    str | None,
    Option(
        "--quaternion",
        metavar="wxyz|xyzw",
        help="The order of the quaternion in --format 7; never guessed.",
    ),
]
Input = Annotated[
    str | None,
    Option(
        "--input",
        metavar="FILE",
        help="Poses, one a row: a .csv or .npy file, or - (CSV on stdin).",
    ),
]
Output = Annotated[
    Path | None,
    Option("--output", help="Where the joints go: a .csv, .npy or .json file."),
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

OPTIONS = (
    *("--tip", "--base", "--input", "--format", "--quaternion", "--q0", "--nearest-to", "--task"),
    *("--no-limits", "--output", "--json", "--seed"),
)
UNSOLVED = 1
"""The exit code where not all is solved."""


def read(
    words: Sequence[str] | None,
    given: str | None,
    format: str | None,
    quaternion: str | None,
) -> Array:
    """The poses (N, 4, 4) that a command line names; NaN where a row is not finite. Raises:
    InputError, PoseError, FileError, with file and line.
    """
    refuse_options(words or (), OPTIONS)
    if format is None:
        raise InputError(
            "--format: expected 12, 16 or 7, the numbers of a pose, and the format is never guessed"
        )
    try:
        names = pose_rows.columns(format, quaternion)
    except InputError as fault:
        raise InputError(f"--{fault}") from fault
    if given is not None:
        if words:
            raise InputError(
                f"either a pose or --input expected, got both ({quote(words[0])} and {quote(given)})"
            )
        return _read_file(given, names, format, quaternion)
    if len(words or ()) != len(names):
        asked = f"{len(names)} numbers expected ({' '.join(names)})"
        raise InputError(f"a pose: {asked}, got {len(words or ())}; or --input with a file")
    row = numbers(words or (), "the pose's number")
    return pose_rows.to_poses(row[None], format, quaternion, lambda _: "the pose")


def _read_file(given: str, names: Sequence[str], format: str, quaternion: str | None) -> Array:
    place = array_files.called(given)
    tail: tuple[int, ...] = ()
    if format == "16":
        tail = (4, 4)
    with Progress(f"reading {place}") as progress:
        rows, lines = array_files.read_rows(given, names, "column", progress, tail=tail)

    def where(i: int) -> str:
        if lines is None:
            return f"{place}, row {i}"
        return f"{place}:{lines[i]}"

    return pose_rows.to_poses(rows, format, quaternion, where)


def numbers(words: Sequence[str], what: str, unit: str = "") -> Array:
    """Words as numbers. Raises: InputError that says which is none."""
    values = [real(word) for word in words]
    for i, value in enumerate(values):
        if value is None:
            raise InputError(f"{what} {i + 1}: a number expected{unit}, got {quote(words[i])}")
    return np.array(values, float)


def check_count(values: Array, chain: Chain, where: str = "", remedy: str = "") -> None:
    """Refuse other than one number for each coordinate. Raises: InputError."""
    if len(values) != chain.dof:
        names = ", ".join(map(name, chain.q_names))
        expected = f"{chain.dof} coordinates expected ({names})"
        raise InputError(f"{where}{expected}, got {len(values)}{remedy}")


def coordinates(text: str | None, chain: Chain, option: str) -> Array | None:
    """The numbers of an option with one for each coordinate, commas or blanks between them."""
    if text is None:
        return None
    values = numbers(text.replace(",", " ").split(), f"{option}: number")
    check_count(values, chain, f"{option}: ")
    return values


def for_each(text: str | None, chain: Chain, option: str) -> Array | float | None:
    """The numbers of an option with one for all coordinates or one for each."""
    words = (text or "").replace(",", " ").split()
    if len(words) == 1:
        return float(numbers(words, f"{option}: number")[0])
    return coordinates(text, chain, option)
