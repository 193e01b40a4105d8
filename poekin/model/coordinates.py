"""Configurations as users give them, made arrays: an array in the order of the coordinates' names,
or something with names.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from ..errors import (
    InputError,
    ShapeError,
    UnknownName,
    join_names,
    quote,
    safe_repr,
    suggest,
)
from ..groups.arrays import Array, numbers
from ..groups.objects import labels


def coordinates(
    q: Any,
    names: tuple[str, ...],
    what: str = "q",
) -> Array:
    """q as a float64 array (..., m) in the order of `names`: of an array, or of a dict or a pandas
    Series or DataFrame (its columns) whose labels are the names, in any order.

    Raises ShapeError that says how many and which coordinates are expected, UnknownName for a name
    that is none, InputError for a name that is missing or there twice and for what is no number.
    """
    if type(q) is np.ndarray:
        array = numbers(q, what)
    elif isinstance(q, Mapping):
        array = _from_dict(q, names, what)
    else:
        marks = labels(q)
        array = numbers(q, what) if marks is None else _from_labels(q, marks, names, what)
    if array.ndim == 0 or array.shape[-1] != len(names):
        expected = join_names(names) or "none"
        raise ShapeError(
            f"{what}: expected {len(names)} coordinates on the last axis ({expected}), got shape {array.shape}"
        )
    return array


def one_configuration(q: Any, names: tuple[str, ...]) -> Array:
    """One finite configuration (m,) as `coordinates` reads it.

    Raises: what `coordinates` does, and InputError for a batch and what is not finite.
    """
    array = coordinates(q, names)
    if array.ndim != 1 or not np.isfinite(array).all():
        raise InputError(
            f"q: expected one finite configuration ({len(names)},), got {safe_repr(array.tolist())}"
        )
    return array


def _known(
    given: Collection[Any],
    names: tuple[str, ...],
    what: str,
) -> None:
    """Raises UnknownName or InputError where the names given are not those of the coordinates."""
    for name in given:
        if name not in names:
            raise UnknownName(f"{what}: no coordinate {quote(name)}; {suggest(str(name), names)}")
    missing = [name for name in names if name not in given]
    if missing:
        raise InputError(f"{what}: no value for {join_names(missing)}")


def _from_labels(
    q: Any,
    marks: tuple[Any, ...],
    names: tuple[str, ...],
    what: str,
) -> Array:
    _known(marks, names, what)
    if len(marks) > len(names):
        raise InputError(
            f"{what}: the label {quote(max(marks, key=marks.count))} appears more than once"
        )
    return numbers(q.to_numpy(), what)[..., [marks.index(name) for name in names]]


def _from_dict(q: Mapping, names: tuple[str, ...], what: str) -> Array:
    _known(q, names, what)
    values = [numbers(q[name], f"{what}[{quote(name)}]") for name in names]
    try:
        return np.stack(np.broadcast_arrays(*values), axis=-1) if values else np.empty(0)
    except ValueError as error:
        shapes = ", ".join(list(dict.fromkeys(str(value.shape) for value in values))[:12])
        raise ShapeError(f"{what}: the values' shapes do not broadcast: {shapes}") from error
