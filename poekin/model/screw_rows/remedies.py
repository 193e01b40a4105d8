"""Remedies for screws that are refused, found by reading the same numbers in other ways."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, norms, rotation_part

UNIT = 1e-9
"""Difference from 1 that is accepted of the length of a screw's direction."""

ROUNDED = 1e-2
"""Largest difference from 1 of the length of a direction that was written with few digits."""


class _Reading(NamedTuple):
    """An expression for an array that was misread, and what it says about the array."""

    expression: str
    means: str
    read: Callable[[Array], Array]


_READINGS = (
    _Reading("{}", "its rows are unit screws", lambda S: S),
    _Reading("{}.T", "its columns are unit screws, as in a Slist", lambda S: S.T),
    _Reading(
        "pk.se3.linear_first({})",
        "its rows are unit screws in the order (v; omega)",
        lambda S: np.roll(S, 3, axis=1),
    ),
    _Reading(
        "pk.se3.linear_first({}.T)",
        "its columns are unit screws in the order (v; omega)",
        lambda S: np.roll(S.T, 3, axis=1),
    ),
)
_MENDS = (
    (ROUNDED, " but for rounding: pass pk.screw.normalised({})"),
    (UNIT, ": pass {}"),
)


def length_errors(S: Array) -> Array:
    """Difference from 1 (n,) of each row's |omega|, or of |v| where omega is 0 to 1e-9."""
    with np.errstate(over="ignore", invalid="ignore"):
        turns = norms(angular_part(S))
        return np.abs(np.where(turns > UNIT, turns, norms(linear_part(S))) - 1.0)


def other_reading(S: Array, what: str) -> str:
    """End of a message: the expressions that make unit screws of an array that was refused.

    Rounded numbers may be exact when read in another way: then both readings are named.
    """
    ways: dict[str, str] = {}
    for most, mend in _MENDS:
        for expression, means, read in _READINGS:
            rows = read(np.atleast_2d(S))
            if rows.size and rows.shape[-1] == 6 and (length_errors(rows) <= most).all():
                if most == ROUNDED or expression != "{}":
                    ways[means] = f"{means}{mend.format(expression.format(what))}"
                break
    if not ways:
        return ""
    return f"; {'; or '.join(ways.values())}"


def matrix_among(values: Any) -> str:
    """End of a message about rows of which one is a matrix (4, 4); nothing where none is."""
    try:
        index = [np.shape(value) for value in values].index((4, 4))
    except (TypeError, ValueError):
        return ""
    matrix = np.asarray(values[index], float)
    skew = not (rotation_part(matrix) + rotation_part(matrix).T).any() and not matrix[3].any()
    remedy = "is no screw; the home pose is an argument of its own"
    if skew:
        remedy = "is [A] of a twist: pass pk.se3.vee of it"
    return f"; the (4, 4) matrix at {index} {remedy}"
