"""Checks of arguments: numbers, truth values, and words of a given list."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, TypeGuard

import numpy as np

from .errors import InputError, safe_repr

KERNEL_INT = 2**62
"""Bound of the whole numbers that the kernels take."""


class _Required:
    """Default of an argument that must be given, so that its absence can list the choices."""

    def __repr__(self) -> str:
        return "<required>"


REQUIRED: Any = _Required()

_FLOATS = (float, np.floating)
_REAL = (int, np.integer, *_FLOATS)


def is_real(value: Any) -> bool:
    """Whether it is a real number; True and False are none."""
    return isinstance(value, _REAL) and not isinstance(value, bool)


def is_whole(value: Any, least: int) -> TypeGuard[int]:
    """Whether it is a whole number from `least` on; True and False are none."""
    return is_real(value) and not isinstance(value, _FLOATS) and value >= least


def positive(value: Any, what: str) -> float:
    """A positive finite number. Raises: InputError."""
    if not is_real(value) or not 0 < value < math.inf:
        raise InputError(f"{what}: expected a positive number, got {safe_repr(value)}")
    return float(value)


def whole(
    value: Any,
    what: str,
    least: int,
    below: float = math.inf,
) -> int:
    """A whole number from `least` on, below a bound. Raises: InputError."""
    if not is_whole(value, least) or value >= below:
        raise InputError(f"{what}: expected a whole number from {least} on, got {safe_repr(value)}")
    return int(value)


def true_or_false(value: Any, what: str) -> None:
    """Refuses a value that is neither True nor False. Raises: InputError."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{what}: expected True or False, got {safe_repr(value)}")


def choice(
    value: object,
    known: Iterable[str],
    what: str,
    hint: str = "",
) -> None:
    """Refuses a value that is none of the known words, with a list of them. Raises: InputError."""
    if isinstance(value, str) and value in known:
        return
    got = "it was left out" if value is REQUIRED else f"got {safe_repr(value)}"
    raise InputError(f"{what}: expected {alternatives(known)}, {got}{hint}")


def alternatives(words: Iterable[str]) -> str:
    """The words in quotes, joined by commas and an "or"."""
    *others, last = map(repr, words)
    return f"{', '.join(others)} or {last}" if others else last
