"""The columns of a file of measurements: which are coordinates, and what the others make together."""

from __future__ import annotations

import re
from collections import Counter
from typing import NamedTuple

from ....errors import InputError, UnknownName, join_names, quote, suggest
from ....formats.poses.layout import OF_CONTROLLERS, PoseLayout
from ....formats.poses.layout import layout as pose_layout
from ....formats.text.csv_header import coordinate_names
from ....formats.text.numbers import real

_OF_POSES = ("poses", "eye-in-hand", "eye-to-hand")
_LAYOUTS = (
    "T00 ... T23, or x y z qw qx qy qz, or x y z roll pitch yaw, or x y z, or x1 y1 z1 x2 ..., or "
    "distance"
)


class ColumnLayout(NamedTuple):
    """The columns of a measurement, in the order in which they are taken, and the kinds that they
    may be of.

    pose: what the numbers of poses are, None of anything else.
    """

    columns: tuple[str, ...]
    kinds: tuple[str, ...]
    pose: PoseLayout | None = None


POSES = (pose_layout("16"), pose_layout("12"), pose_layout("quat", "wxyz"), pose_layout("rpy"))
"""What the numbers of poses may be where no format is given: their names tell."""
_OTHERS = (
    ColumnLayout(("px", "py", "pz"), ("points",)),
    ColumnLayout(("x", "y", "z"), ("points",)),
    ColumnLayout(("distance",), ("distances",)),
)


def of_poses(poses: tuple[PoseLayout, ...]) -> tuple[ColumnLayout, ...]:
    """The layouts that a file may have, with poses of these."""
    return (*(ColumnLayout(pose.columns, _OF_POSES, pose) for pose in poses), *_OTHERS)


STANDARD = of_poses(POSES)


def parse_header(
    header: list[str],
    q_names: tuple[str, ...],
    ignore: tuple[str, ...],
    here: str,
    fixed: tuple[ColumnLayout, ...] = STANDARD,
) -> tuple[tuple[str, ...], ColumnLayout]:
    """The names of the coordinates and the layout of the measurement that a header's columns make,
    with none left.

    Raises: UnknownName, InputError, that begin with `here`.
    """
    words = [word for word in header if word not in ignore]
    if words and all(real(word) is not None for word in words):
        raise InputError(
            f"{here}: a first line that names the columns expected, it has numbers alone"
        )
    for word, times in Counter(words).items():
        if times > 1:
            raise InputError(f"{here}: the column {quote(word)} is there {times} times")
    given = set(words)
    every = coordinate_names(q_names)
    for names in (q_names, *every):
        if given > set(names):
            rest = given - set(names)
            for layout in (*fixed, _points(rest)):
                if rest == set(layout.columns):
                    return names, layout
    names = max(every, key=lambda some: len(given.intersection(some)))
    missing = [name for name in names if name not in given]
    if missing:
        raise InputError(
            f"{here}: no column for the coordinate {quote(missing[0])}; expected {join_names(q_names)},"
            f" or q1 ... q{len(q_names)}; available: {join_names(words)}, of which rename= says what they are"
        )
    raise _fault([word for word in words if word not in names], here, fixed)


def _fault(
    rest: list[str],
    here: str,
    fixed: tuple[ColumnLayout, ...],
) -> InputError | UnknownName:
    """The error of columns that make no measurement."""
    if not rest:
        return InputError(f"{here}: no column of a measurement; expected {_expected(fixed)}")
    there = set(rest)
    if formats := _formats(there, fixed):
        return InputError(
            f"{here}: the columns {' '.join(pose_layout(formats[0]).columns)} make a pose of "
            f"{', '.join(map(_in_words, formats))}: format= (--format) says of which"
        )
    every = [layout for layout in (*fixed, _points(there)) if layout.columns]
    whole = [layout for layout in every if set(layout.columns) <= there]
    if whole:
        most = max(whole, key=lambda layout: len(layout.columns))
        known = set(most.columns)
        extra = quote(next(word for word in rest if word not in known))
        return UnknownName(
            f"{here}: the column {extra} is neither a coordinate nor one of {describe(most)}; "
            f"ignore=[{extra}] passes it over"
        )
    begun = max(every, key=lambda layout: len(set(layout.columns) & there) / len(layout.columns))
    if not there.isdisjoint(begun.columns):
        missing = next(name for name in begun.columns if name not in there)
        return InputError(f"{here}: of the columns {describe(begun)}, {quote(missing)} is missing")
    close = suggest(rest[0], [name for layout in fixed for name in layout.columns], 3)
    return UnknownName(
        f"{here}: {quote(rest[0])} is neither a coordinate nor part of a measurement ({_expected(fixed)});"
        f" {close}; rename= says what it is, ignore=[{quote(rest[0])}] passes it over"
    )


def _in_words(format: str) -> str:
    """A format of a pose in six numbers, with what the last three are."""
    layout = pose_layout(format)
    what = "a rotation vector" if layout.rotation == "vector" else "angles"
    units: list[str] = list(dict.fromkeys(layout.units))
    return f"{quote(format)} ({what}, {' and '.join(units)})"


def _formats(words: set[str], fixed: tuple[ColumnLayout, ...]) -> list[str]:
    """Formats of poses, not among those that are expected, whose three angles or parts of a vector
    are there, in whatever case.
    """
    there = {word.casefold() for word in words}
    expected = {layout.pose.format for layout in fixed if layout.pose}
    layouts = [
        x for x in map(pose_layout, ("rpy", "rotvec", *OF_CONTROLLERS)) if len(x.columns) == 6
    ]
    others = [x for x in layouts if x.format not in expected]
    return [x.format for x in others if there.issuperset(map(str.casefold, x.columns))]


def _expected(fixed: tuple[ColumnLayout, ...]) -> str:
    if len(fixed) < len(STANDARD):
        return ", or ".join(map(describe, fixed))
    return _LAYOUTS


def _points(words: set[str]) -> ColumnLayout:
    """The columns x1 y1 z1 ... xk yk zk of as many points as the words speak of."""
    numbers = [int(word[1:]) for word in words if re.fullmatch(r"[xyz][1-9][0-9]{0,5}", word)]
    count = min(max(numbers, default=0), len(words))
    return ColumnLayout(point_columns(count), ("points",))


def point_columns(count: int) -> tuple[str, ...]:
    """x1 y1 z1 ... xk yk zk of k points."""
    return tuple(f"{axis}{i + 1}" for i in range(count) for axis in "xyz")


def describe(layout: ColumnLayout) -> str:
    """A layout's columns as messages call them."""
    names = layout.columns
    if len(names) > 7:
        return f"{names[0]} ... {names[-1]}"
    return " ".join(names)
