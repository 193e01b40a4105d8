"""Checks of options: numbers, truth values, and words of a given list."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..errors import InputError, safe_repr

KERNEL_INT = 2**62
"""Bound of the whole numbers that the kernels take."""


def is_real(value: Any) -> bool:
    """Whether it is a real number; True and False are none."""
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def true_or_false(value: Any, what: str) -> None:
    """Refuses a value that is neither True nor False. Raises: InputError."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{what}: expected True or False, got {safe_repr(value)}")


def is_whole(value: Any, least: int) -> bool:
    """Whether it is a whole number from `least` on; True and False are none."""
    integer = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    return integer and bool(value >= least)


def whole(value: Any, what: str, least: int, below: float = math.inf) -> int:
    """A whole number from `least` on, below a bound. Raises: InputError."""
    if not is_whole(value, least) or value >= below:
        raise InputError(f"{what}: expected a whole number from {least} on, got {safe_repr(value)}")
    return int(value)


def one_of(value: object, known: Iterable[str], what: str) -> None:
    """Refuse a value that is none of the known words. Raises: InputError."""
    if not isinstance(value, str) or value not in known:
        listed = ", ".join(map(repr, known))
        raise InputError(f"{what}: expected one of {listed}, got {safe_repr(value)}")
