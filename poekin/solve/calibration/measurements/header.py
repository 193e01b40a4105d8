"""The first line of a file of measurements: columns, what the numbers of poses are, and units."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from ....errors import PoekinError, UnknownName, quote, suggest
from ....formats.poses.layout import AngleUnit, LengthUnit, PoseLayout
from ....formats.poses.layout import layout as pose_layout
from ....formats.poses.read import said_units
from ....formats.text import csv_header
from ....formats.text.csv_header import COORDINATE, Columns, Conversion, Heading, coordinate_names
from ....model.chain import Chain
from .columns import POSES, ColumnLayout, of_poses, parse_header


class Convention(NamedTuple):
    """Format of poses and units that a user said of a file, None where nothing was said; the names
    that columns of the file are to have, and units of some of these.
    """

    pose: PoseLayout | None = None
    mm: bool | None = None
    deg: bool | None = None
    rename: Mapping[str, str] = MappingProxyType({})
    units: Mapping[str, str] = MappingProxyType({})

    @classmethod
    def of(cls, format: Any, mm: bool | None, deg: bool | None) -> Convention:
        """Convention of a format's name; the order of a quaternion is in its columns' names. Raises:
        InputError.
        """
        if format is None:
            return cls(None, mm, deg)
        order = "wxyz" if format in ("quat", "7") else None
        pose = pose_layout(format, order, mm=mm, deg=deg, joints=True)
        return cls(pose, mm, deg)

    @property
    def length(self) -> LengthUnit:
        """Unit of lengths."""
        return "mm" if self.mm else "m"

    def layouts(self) -> tuple[tuple[ColumnLayout, ...], ...]:
        """The layouts that a file may have, in the order in which they are tried."""
        if self.pose is None:
            angle: AngleUnit = "deg" if self.deg else "rad"
            poses = [pose._replace(length=self.length, angle=angle) for pose in POSES]
            return (of_poses(tuple(poses)),)
        own, *others = of_poses((self.pose,))
        return (own,), tuple(others)

    def renamed(self, words: list[str], here: str) -> list[str]:
        """The words of a header with the names and units that were said. Raises: UnknownName."""
        words = _replaced(words, self.rename, "rename", here)
        with_units = {name: f"{name} [{unit}]" for name, unit in self.units.items()}
        return _replaced(words, with_units, "units", here)

    def joint_unit(self, chain: Chain, k: int) -> str:
        """Unit of a coordinate."""
        if chain.is_angle(k):
            return "deg" if self.deg else "rad"
        return self.length


def _replaced(
    words: list[str],
    names: Mapping[str, str],
    what: str,
    here: str,
) -> list[str]:
    """Words with others in the place of some. Raises: UnknownName where one is not there."""
    for name in names:
        if name not in words:
            raise UnknownName(f"{here}: {what}: no column {quote(name)}; {suggest(name, words)}")
    return [names.get(word, word) for word in words]


class Header(NamedTuple):
    """Columns of a file: their names and indices, coordinates first; the layout of the others; and
    what makes the units of a column, by its number, those that are taken.
    """

    names: tuple[str, ...]
    indices: list[int]
    layout: ColumnLayout
    conversions: list[tuple[int, Conversion]]


NO_HEADER = Header((), [], ColumnLayout((), ()), [])
SI = Convention()


def read_header(
    words: list[str],
    chain: Chain,
    ignore: tuple[str, ...],
    here: str,
    convention: Convention = SI,
) -> Header:
    """The columns that a header's words name, with their units.

    Raises: UnknownName, InputError, that begin with `here`.
    """
    faults: list[PoekinError] = []
    for layouts in convention.layouts():
        headings = _headings(words, chain, ignore, layouts)
        try:
            names = [heading.name for heading in headings]
            joints, layout = parse_header(names, chain.q_names, ignore, here, layouts)
            return _header(headings, joints, layout, chain, convention, here)
        except PoekinError as fault:
            faults.append(fault)
    raise faults[0]


def _headings(
    words: list[str],
    chain: Chain,
    ignore: tuple[str, ...],
    layouts: tuple[ColumnLayout, ...],
) -> list[Heading]:
    """Names and units of a header's words, of those that a file may have."""
    measured = [name for layout in layouts for name in layout.columns]
    coordinates = [name for names in coordinate_names(chain.q_names) for name in names]
    known = dict.fromkeys((*chain.q_names, *measured, *coordinates))
    headings = list(csv_header.headings(words, tuple(known)))
    for k, word in enumerate(words):
        if word in ignore:
            headings[k] = Heading(word, "")
    return headings


def _header(
    headings: list[Heading],
    names: tuple[str, ...],
    layout: ColumnLayout,
    chain: Chain,
    convention: Convention,
    here: str,
) -> Header:
    said = said_units(convention.mm, convention.deg)
    coordinates = range(chain.dof)
    units = tuple(convention.joint_unit(chain, k) for k in coordinates)
    of_values = (convention.length,) * len(layout.columns)
    if layout.pose is not None:
        of_values = layout.pose.units
    joints = Columns(names, COORDINATE, units, said)
    measured = Columns(layout.columns, "column", of_values, said)
    found = list(csv_header.conversions(headings, joints, here).items())
    values = csv_header.conversions(headings, measured, here)
    found += [(chain.dof + k, convert) for k, convert in values.items()]
    # then to rad and m; poses are made of numbers in their own units
    taken = units if layout.pose is not None else units + of_values
    to_si = {"mm": "m", "deg": "rad"}
    found += [
        (k, csv_header.CONVERSIONS[unit, to_si[unit]])
        for k, unit in enumerate(taken)
        if unit in to_si
    ]
    every = (*names, *layout.columns)
    places = {heading.name: i for i, heading in enumerate(headings)}
    indices = [places[name] for name in every]
    return Header(every, indices, layout, found)
