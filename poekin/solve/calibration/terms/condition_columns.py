"""Columns of conditions in a file of measurements: payload, temperature and time of each row."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from typing import NamedTuple

from ....checks import alternatives
from ....errors import InputError, quote

UNITS = {
    "payload": {"kg": 1.0, "g": 1e-3},
    "temperature": {"K": 1.0, "C": 1.0, "°C": 1.0},
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
}
"""Units of the columns by name, each as a multiple of the first, which holds where none is said. Of
temperatures only differences count.
"""
_HEADING = re.compile(r"(\w+?)\s*(?:[\[(]([^\[\]()]*)[\])])?")


class ConditionColumn(NamedTuple):
    """A column of a condition: its number, the word in the header, and what its numbers are multiplied by."""

    name: str
    index: int
    word: str
    factor: float


def condition_columns(
    words: Sequence[str], others: Collection[str], here: str
) -> list[ConditionColumn]:
    """The columns of conditions among a header's words, but for `others`, which mean something else.

    Raises: InputError, that begins with `here`, for another unit and for a condition that is there twice.
    """
    found: dict[str, ConditionColumn] = {}
    for index, word in enumerate(words):
        heading = _HEADING.fullmatch(word.strip())
        if word in others or heading is None or heading[1].lower() not in UNITS:
            continue
        name = heading[1].lower()
        units = UNITS[name]
        unit = heading[2] or next(iter(units))
        if unit.strip() not in units:
            raise InputError(
                f"{here}: the column {quote(word)}: expected {alternatives(units)}, got {quote(unit)}"
            )
        if name in found:
            raise InputError(
                f"{here}: both {quote(found[name].word)} and {quote(word)}: expected one"
            )
        found[name] = ConditionColumn(name, index, word, units[unit.strip()])
    return list(found.values())
