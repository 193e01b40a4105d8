"""Options about the columns of measurements: names, units, and what the numbers of poses are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from typer import Option

from ....checks import alternatives
from ....errors import InputError, quote
from ....solve.calibration.measurements.header import Convention
from ....solve.calibration.terms import condition_columns

Texts = list[str] | None
Ignore = Annotated[
    Texts,
    Option("--ignore", metavar="COLUMN", help="A column to pass over; may be repeated."),
]
Rename = Annotated[
    Texts,
    Option(
        "--rename",
        metavar="COLUMN=NAME",
        help="A column of the files under the name that it is to have: x_t=x; may be repeated.",
    ),
]
Format = Annotated[
    str | None,
    Option(
        "--format",
        metavar="FORMAT",
        help="What the columns of poses are: abc, wpr, ur, ..., as in ik (default: as their names say).",
    ),
]
Mm = Annotated[
    bool | None,
    Option("--mm/--m", help="Lengths in the files, of --point and --centre in mm."),
]
Deg = Annotated[
    bool | None,
    Option("--deg/--rad", help="Angles in the files in degrees: joints, and those of --format."),
]
Unit = Annotated[
    Texts,
    Option(
        "--unit",
        metavar="UNIT|COLUMN,...=UNIT",
        help="Where the first line says none: mm, m, deg or rad, as --mm and --deg; or of columns: "
        "x,y,z=mm; may be repeated.",
    ),
]
Repeats = Annotated[
    str,
    Option(
        "--repeats",
        help="Rows at one configuration (1 mrad, 1 mm, 1 g): keep, as clusters, or average.",
    ),
]
_OF_ALL = {"mm": ("mm", True), "m": ("mm", False), "deg": ("deg", True), "rad": ("deg", False)}
"""Units of all columns: the option that says the same, and its value."""
_OF_COLUMNS = (*_OF_ALL, *(unit for units in condition_columns.UNITS.values() for unit in units))


def convention_of(
    format: str | None,
    mm: bool | None,
    deg: bool | None,
    unit: Sequence[str] | None,
    rename: Sequence[str] | None,
) -> Convention:
    """Convention of the files that the options tell. Raises: InputError."""
    said = {"mm": mm, "deg": deg}
    columns: dict[str, str] = {}
    for word in unit or ():
        names, equals, own = word.rpartition("=")
        if equals:
            columns |= dict.fromkeys(parts(names), _checked(own.strip(), word))
            continue
        for part in parts(own):
            if part not in _OF_ALL:
                raise InputError(
                    f"--unit: expected {alternatives(_OF_ALL)}, or columns with their unit as in x,y,z=mm,"
                    f" got {quote(part)}"
                )
            option, value = _OF_ALL[part]
            if said[option] not in (None, value):
                raise InputError(f"--unit: {part}, and another unit of the same numbers was said")
            said[option] = value
    found = Convention.of(format, said["mm"], said["deg"])
    return found._replace(rename=renamed_columns(rename), units=columns)


def parts(words: str) -> list[str]:
    """The words of an option, with commas between."""
    return [word.strip() for word in words.split(",")]


def listed(words: Sequence[str] | None) -> list[str] | None:
    """The names in a repeated option, each of which may hold several with commas between."""
    return None if words is None else [part for word in words for part in parts(word)]


def _checked(unit: str, word: str) -> str:
    """The unit of columns. Raises: InputError where it is none."""
    if unit not in _OF_COLUMNS:
        raise InputError(
            f"--unit {quote(word)}: expected {alternatives(_OF_COLUMNS)}, got {quote(unit)}"
        )
    return unit


def renamed_columns(renamed: Sequence[str] | None) -> dict[str, str]:
    """Names of columns, of words `COLUMN=NAME`. Raises: InputError."""
    pairs = {}
    for word in renamed or ():
        column, _, wanted = word.partition("=")
        if not column or not wanted:
            raise InputError(
                f"--rename: expected the column's name in the file, = and the name that it is to have, as"
                f" x_t=x; got {quote(word)}"
            )
        pairs[column] = wanted
    return pairs
