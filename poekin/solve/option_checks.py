"""Checks of options: whole numbers, and words of a given list."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..errors import InputError, safe_repr


def is_whole(value: Any, least: int) -> bool:
    """Whether it is a whole number from `least` on; True and False are none."""
    integer = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    return integer and bool(value >= least)


def whole(value: Any, what: str, least: int) -> int:
    """A whole number from `least` on. Raises: InputError."""
    if not is_whole(value, least):
        raise InputError(f"{what}: expected a whole number from {least} on, got {safe_repr(value)}")
    return int(value)


def one_of(value: object, known: Iterable[str], what: str) -> None:
    """Refuse a value that is none of the known words. Raises: InputError."""
    if not isinstance(value, str) or value not in known:
        listed = ", ".join(map(repr, known))
        raise InputError(f"{what}: expected one of {listed}, got {safe_repr(value)}")
