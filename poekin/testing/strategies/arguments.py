"""Checks of the arguments of strategies, at the call: a case that is drawn later could not say what
was wrong.

Every function returns the value in its plain form. Parameters: what, the argument's name for the
message; value or given, what arrived. Raises: InputError with the name of the argument, what was
expected and what arrived.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Collection
from typing import Any

from ...checks import is_real
from ...errors import InputError, safe_repr, suggest


def number(
    what: str,
    value: Any,
    low: float,
    high: float,
) -> float:
    """A finite number from low to high, which are both allowed."""
    real = math.nan
    if is_real(value):
        real = float(value)
    if not low <= real <= high:
        raise InputError(
            f"{what}: expected a number from {low:g} to {high:g}, got {safe_repr(value)}"
        )
    return real


def magnitudes(what: str, value: Any) -> tuple[float, float]:
    """Two finite numbers with 0 < smallest <= largest, between which magnitudes are drawn (0 is
    drawn beside them).
    """
    expected = f"{what}: expected finite numbers (smallest, largest), 0 < smallest <= largest, got {safe_repr(value)}"
    try:
        smallest, largest = value
    except (TypeError, ValueError) as fault:
        raise InputError(expected) from fault
    numbers = is_real(smallest) and is_real(largest)
    if not numbers or not 0 < smallest <= largest < math.inf:
        raise InputError(expected)
    return float(smallest), float(largest)


def counts(
    least: Any,
    most: Any,
    floor: int = 0,
) -> tuple[int, int]:
    """`min_joints` and `max_joints`: whole numbers with floor <= min_joints <= max_joints."""
    try:
        low = operator.index(least)
        high = operator.index(most)
    except TypeError:
        low = high = -1
    if not floor <= low <= high or isinstance(least, bool) or isinstance(most, bool):
        raise InputError(
            f"expected whole numbers with {floor} <= min_joints <= max_joints, got min_joints = {safe_repr(least)},"
            f" max_joints = {safe_repr(most)}"
        )
    return low, high


def shape(value: Any) -> tuple[int, ...]:
    """The shape of leading axes: a tuple of whole numbers, none below 0."""
    try:
        sizes = tuple(map(operator.index, value))
    except TypeError:
        sizes = (-1,)
    if any(size < 0 for size in sizes):
        raise InputError(
            f"shape: expected a tuple of whole numbers >= 0, such as () or (3, 1, 2), got {safe_repr(value)}"
        )
    return sizes


def some(
    what: str,
    given: Any,
    known: Collection[str],
) -> tuple[str, ...]:
    """One or more of the words that are known; a single one need not stand in a tuple."""
    words = (given,) if isinstance(given, str) else given
    try:
        chosen = tuple(words)
    except TypeError:
        chosen = ()
    for word in chosen:
        if word not in known:
            raise InputError(f"{what}: there is no {safe_repr(word)}; {suggest(str(word), known)}")
    if not chosen:
        raise InputError(f"{what}: expected some of {', '.join(known)}, got {safe_repr(given)}")
    return chosen


def moves(model: Any) -> int:
    """The number of coordinates m of a chain or robot."""
    m = getattr(model, "dof", None)
    if not isinstance(m, int):
        raise InputError(
            f"expected a chain or a robot, with `dof` and `limits`, got {safe_repr(model)}"
        )
    return m
