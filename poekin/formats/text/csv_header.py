"""Headers of CSV files: which column is which name, and the unit that a header may say.

`X [mm]`, `X (mm)` and `X_mm` are the column X in mm. A name is taken in another case where only one
name fits.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ...errors import InputError, UnknownName, quote, suggest

_BRACKETS = re.compile(r"(.*)[\[(]([^\[\]()]*)[\])]", re.DOTALL)
_SUFFIX = re.compile(r"(.*)_(mm|m|deg|rad)", re.IGNORECASE | re.DOTALL)
_UNITS = {
    **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), "m"),
    **dict.fromkeys(("mm", "millimetre", "millimetres", "millimeter", "millimeters"), "mm"),
    **dict.fromkeys(("rad", "radian", "radians"), "rad"),
    **dict.fromkeys(("deg", "degree", "degrees", "°"), "deg"),
    **dict.fromkeys(("s", "sec", "second", "seconds"), "s"),
}
_STEMS = ("q", "j", "joint", "joint_", "axis", "axis_", "theta")
_NUMBERED = re.compile(rf"({'|'.join(_STEMS)})(\d+)(?![^\W_])", re.IGNORECASE)
COORDINATE = "coordinate"
"""What messages call the columns of coordinates."""
_SAME_KIND = {"m": "mm", "mm": "m", "rad": "deg", "deg": "rad"}
Conversion = Callable[[np.ndarray], np.ndarray]
CONVERSIONS: dict[tuple[str, str], Conversion] = {
    ("mm", "m"): lambda x: x / 1000.0,
    ("m", "mm"): lambda x: x * 1000.0,
    ("deg", "rad"): np.deg2rad,
    ("rad", "deg"): np.rad2deg,
}


def numbered(count: int) -> tuple[str, ...]:
    """q1 ... qm, the names that coordinates have where a file does not use their own."""
    return tuple(f"q{i + 1}" for i in range(count))


def coordinate_names(q_names: tuple[str, ...]) -> tuple[tuple[str, ...], ...]:
    """Names that a file may have for the coordinates: q1 ... qm, the chain's own, and others that are
    numbered from 1 or from 0.
    """
    count = len(q_names)
    own = {name.casefold() for name in q_names}
    found = [numbered(count), q_names]
    for stem in _STEMS:
        for start in (1, 0):
            names = tuple(f"{stem}{i + start}" for i in range(count))
            if own.isdisjoint(names):
                found.append(names)
    return tuple(dict.fromkeys(found))


def numbered_coordinates(words: Iterable[str]) -> int:
    """Number of coordinates that a header's words name by numbers, as `coordinate_names` has them, with
    or without a unit.
    """
    found: dict[str, set[str]] = {}
    for word in words:
        if coordinate := _NUMBERED.match(word):
            found.setdefault(coordinate[1].casefold(), set()).add(coordinate[2])
    return max(map(len, found.values()), default=0)


class Columns(NamedTuple):
    """Columns that a file is to have.

    Fields: names, in the order in which they are taken; what, their kind in messages; units, that
    each is to come in, where a header may say another, "" for none; said, units that the user said, which a
    header may not contradict; besides, columns that are passed over; first, columns that a header
    may name together, too: where it does, they are taken before the others, in s; last, names at the end
    that a file may leave out together.
    """

    names: tuple[str, ...]
    what: str
    units: tuple[str, ...] = ()
    said: tuple[str, ...] = ()
    besides: tuple[str, ...] = ()
    first: tuple[str, ...] = ()
    last: tuple[str, ...] = ()

    def with_first(self) -> Columns:
        """Columns of a file that has the first ones, too."""
        units = ("s",) * len(self.first) + self.units
        return self._replace(names=self.first + self.names, units=units)

    def as_named(self, words: Sequence[str]) -> Columns:
        """Columns of a file that numbers the coordinates, where its words, with or without units, do."""
        if self.what != COORDINATE:
            return self
        every = coordinate_names(self.names)
        each = tuple(dict.fromkeys(itertools.chain(*every)))
        known = {heading.name for heading in headings(words, each)}
        own_first = (self.names, *every)
        names = next((some for some in own_first if known.issuperset(some)), self.names)
        return self._replace(names=names)

    def without_last(self) -> Columns:
        """Columns of a file that leaves the last ones out."""
        count = len(self.names) - len(self.last)
        return self._replace(names=self.names[:count], units=self.units[:count])


class Heading(NamedTuple):
    """A header's word: the name of its column and the unit it says, "" for none."""

    name: str
    unit: str


def headings(words: Sequence[str], names: Sequence[str]) -> list[Heading]:
    """Name and unit of each word of a header; of none of the names, the word itself."""
    known = set(names)
    folded: dict[str, list[str]] = {}
    for name in names:
        folded.setdefault(name.casefold(), []).append(name)

    def named(word: str) -> str:
        """The name that a word is, in another case where only one is; "" for none."""
        if word in known:
            return word
        alike = folded.get(word.casefold(), [])
        return alike[0] if len(alike) == 1 else ""

    return [_heading(word, named) for word in words]


def _heading(word: str, named: Callable[[str], str]) -> Heading:
    exact = named(word)
    if exact:
        return Heading(exact, "")
    for pattern in (_BRACKETS, _SUFFIX):
        found = pattern.fullmatch(word)
        if not found:
            continue
        unit = found[2].strip().lower()
        if unit in _UNITS:
            name = found[1].rstrip()
            return Heading(named(name) or name, _UNITS[unit])
    return Heading(word, "")


def order(headings: Sequence[Heading], columns: Columns, where: str) -> list[int]:
    """Indices of the columns in the order of their names. Raises: UnknownName, InputError."""
    words = [heading.name for heading in headings]
    names = columns.names
    known = {*names, *columns.besides}
    for word in words:
        if word not in known:
            raise UnknownName(
                f"{where}: {quote(word)} is neither a number nor a {columns.what};"
                f" {suggest(word, names)}"
            )
    place = {word: k for k, word in enumerate(words)}
    missing = [n for n in names if n not in place]
    if missing or len(place) != len(words):
        fault = "a name appears twice"
        if missing:
            fault = f"{quote(missing[0])} is missing"
        raise InputError(
            f"{where}: the header has to name each of the {len(names)} {columns.what}s once; {fault}"
        )
    return [place[n] for n in names]


def conversions(
    headings: Sequence[Heading],
    columns: Columns,
    where: str,
) -> dict[int, Conversion]:
    """By the number of a name, what makes its unit of the one that the header says.

    Raises: InputError for a unit that the column cannot have, that contradicts what the user said,
    or that not all columns of its kind have.
    """
    unit_of = dict(headings)
    found: dict[int, Conversion] = {}
    common: dict[str, tuple[str, str]] = {}
    units = itertools.chain(columns.units, itertools.repeat(""))
    for k, (name, wanted) in enumerate(zip(columns.names, units, strict=False)):
        unit = unit_of[name]
        if wanted:
            kind = min(wanted, _SAME_KIND.get(wanted, wanted))
            other, same = common.setdefault(kind, (name, unit))
            if same != unit:
                raise InputError(
                    f"{where}: {quote(other)} is in {same or 'no unit'} and {quote(name)} in"
                    f" {unit or 'no unit'}; expected one unit, said with each of them or with none"
                )
        if not unit or unit == wanted:
            continue
        if unit != _SAME_KIND.get(wanted):
            expected = " or ".join(filter(None, (wanted, _SAME_KIND.get(wanted))))
            raise InputError(f"{where}: {quote(name)} in {unit}; expected {expected or 'no unit'}")
        if wanted in columns.said:
            raise InputError(
                f"{where}: the header says that {quote(name)} is in {unit}, and it was said to be in"
                f" {wanted}; leave one of the two out"
            )
        found[k] = CONVERSIONS[unit, wanted]
    return found
