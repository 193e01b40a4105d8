"""TOML in and out, its values read key by key, every fault with file and key."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ...checks import alternatives
from ...errors import (
    MissingExtra,
    ModelError,
    escape_unprintable,
    quote,
    safe_repr,
    suggest,
)
from ...groups.arrays import Array
from . import xml
from .atomic_write import FilePath


def read(path: FilePath) -> dict[str, Any]:
    """The content of a TOML file. Raises: FileError for what cannot be read; ModelError for what is
    not TOML.
    """
    return parse(*xml.read_text(path))


_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*"""
_DEEP_KEY = re.compile(rf"(?<![\w-])(?:{_PART}){{32}}")
_LARGEST = 10**4300
"""Least number that Python does not write in decimal digits; tomllib reads it in hexadecimal."""


def parse(text: str, place: str) -> dict[str, Any]:
    """The content of a TOML text; place is what messages call it.

    Raises: ModelError for what is no TOML, a key of more than 32 parts (tomllib takes the square of
    their number, in time), and a whole number of more than 4300 digits.
    """
    if deep := _DEEP_KEY.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        raise ModelError(
            f"{place}:{line}: expected keys of at most 32 parts, a.b.c has three, got a longer one"
        )
    try:
        data = tomllib.loads(text)
    except RecursionError as fault:
        raise ModelError(f"{place}: not TOML: its brackets are nested too deeply") from fault
    except ValueError as fault:  # TOMLDecodeError, or an integer of more than 4300 digits
        raise ModelError(f"{place}: not TOML: {escape_unprintable(fault, 200)}") from fault
    ahead: list[Any] = [data]
    while ahead:
        value = ahead.pop()
        if isinstance(value, int) and value >= _LARGEST:
            raise ModelError(
                f"{place}: expected whole numbers of at most 4300 digits, got a longer one"
            )
        if isinstance(value, dict):
            ahead.extend(value.values())
        if isinstance(value, list):
            ahead.extend(value)
    return data


def make_text(data: Mapping[str, Any]) -> str:
    """Dicts, lists, numbers, texts as TOML; numbers keep all their digits. Raises: MissingExtra
    without tomli-w.
    """
    try:
        import tomli_w
    except ImportError as missing:
        raise MissingExtra("tomli-w", "formats", "writing TOML") from missing
    return tomli_w.dumps(data)


class Keys:
    """One table of a TOML file: its keys, each as what it is expected to be.

    Parameters: data, the table; place, file and keys that lead to it, as messages call it; known,
    the keys it may have. Raises, from every method: ModelError that says file and key, what was
    expected and what arrived.
    """

    def __init__(
        self,
        data: Mapping[str, Any],
        place: str,
        known: Iterable[str] | None = None,
    ) -> None:
        self.data = data
        self.place = place
        if known is None:
            return
        every = tuple(known)
        for key in data:
            if key not in every:
                raise ModelError(f"{place}: no such key: {quote(key)}; {suggest(key, every)}")

    def fault(self, key: str, message: str) -> ModelError:
        """An error about this key, to be raised."""
        return ModelError(f"{self.place}: {escape_unprintable(key, 80)}: {message}")

    def value(self, key: str) -> Any:
        """Value of a key, which must be there."""
        if key not in self.data:
            raise ModelError(f"{self.place}: {escape_unprintable(key, 80)} is missing")
        return self.data[key]

    def table(
        self,
        key: str,
        known: Iterable[str] | None = None,
    ) -> Keys:
        """The table of that name."""
        return self._table(self.value(key), key, known)

    def tables(
        self,
        key: str,
        known: Sequence[str],
    ) -> list[Keys]:
        """The tables in a list, none where the key is missing."""
        values = self.data.get(key, [])
        if not isinstance(values, list):
            raise self.fault(key, f"expected [[{key}]] tables, got {safe_repr(values)}")
        return [self._table(value, f"{key} {i + 1}", known) for i, value in enumerate(values)]

    def _table(
        self,
        value: Any,
        key: str,
        known: Iterable[str] | None,
    ) -> Keys:
        if not isinstance(value, dict):
            raise self.fault(key, f"expected a table, got {safe_repr(value)}")
        return Keys(value, f"{self.place}: {escape_unprintable(key, 80)}", known)

    def text(
        self,
        key: str,
        among: Sequence[str] | None = None,
    ) -> str:
        """A text, of those in `among`."""
        value = self.value(key)
        if not isinstance(value, str):
            raise self.fault(key, f"expected a text, got {safe_repr(value)}")
        if among is not None and value not in among:
            raise self.fault(key, f"expected {alternatives(among)}, got {quote(value)}")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts."""
        values = self.value(key)
        if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
            raise self.fault(key, f"expected a list of texts, got {safe_repr(values)}")
        return tuple(values)

    def truth(self, key: str) -> bool:
        """true or false."""
        value = self.value(key)
        if not isinstance(value, bool):
            raise self.fault(key, f"expected true or false, got {safe_repr(value)}")
        return value

    def whole(self, key: str) -> int:
        """A whole number from 0 on."""
        return int(self.wholes(key, ()))

    def number(self, key: str, *, finite: bool = True) -> float:
        """A number."""
        return float(self.array(key, (), finite=finite))

    def array(
        self,
        key: str,
        shape: tuple[int | None, ...],
        *,
        finite: bool = True,
    ) -> Array:
        """Numbers of that shape, in lists of lists; None: any number (the first axis only)."""
        found: list[float] = []
        self._collect(key, self.value(key), shape, found)
        array = np.array(found, float)
        if finite and not np.isfinite(array).all():
            raise self.fault(key, f"expected finite numbers, got {array[~np.isfinite(array)][0]}")
        return array.reshape([len(self.value(key)) if size is None else size for size in shape])

    def wholes(
        self,
        key: str,
        shape: tuple[int | None, ...],
    ) -> np.ndarray:
        """Whole numbers from 0 on, of that shape, as `array`."""
        array = self.array(key, shape)
        bad = (array < 0) | (array != np.floor(array)) | (array >= 2**53)
        if bad.any():
            raise self.fault(key, f"expected whole numbers from 0 on, got {array[bad].flat[0]:g}")
        return array.astype(np.intp)

    def _collect(
        self,
        key: str,
        value: Any,
        shape: tuple[int | None, ...],
        found: list[float],
    ) -> None:
        if shape:
            if not isinstance(value, list) or shape[0] not in (None, len(value)):
                raise self._list_fault(key, value, shape)
            for item in value:
                self._collect(key, item, shape[1:], found)
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.fault(key, f"expected a number, got {safe_repr(value)}")
        else:
            found.append(_as_float(value))

    def _list_fault(
        self,
        key: str,
        value: Any,
        shape: tuple[int | None, ...],
    ) -> ModelError:
        expected = "numbers"
        if shape[1:]:
            expected = "lists"
        if shape[0] is not None:
            expected = f"{shape[0]} {expected}"
        got = safe_repr(value)
        if isinstance(value, list):
            got = f"{len(value)} of them"
        return self.fault(key, f"expected a list of {expected}, got {got}")


def _as_float(value: float) -> float:
    """Number as a float; an integer that is too large for one is infinite."""
    try:
        return float(value)
    except OverflowError:
        if value < 0:
            return -math.inf
        return math.inf
