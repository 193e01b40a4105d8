"""What a user gives as q, made an array: an array in the order of the coordinates' names, or a dict of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError, UnknownName, closest, listed, shown
from ..groups.arrays import Array, numbers


def coordinates(q: Any, names: tuple[str, ...], what: str = "q") -> Array:
    """q as a float64 array (..., m) in the order of `names`.

    Raises ShapeError that says how many and which coordinates are expected, UnknownName for a name that is none,
    InputError for a name that is missing and for what is no number.
    """
    array = _from_dict(q, names, what) if isinstance(q, Mapping) else numbers(q, what)
    if array.ndim == 0 or array.shape[-1] != len(names):
        expected = listed(names) or "none"
        raise ShapeError(
            f"{what}: expected {len(names)} coordinates on the last axis ({expected}), got shape {array.shape}"
        )
    return array


def _from_dict(q: Mapping, names: tuple[str, ...], what: str) -> Array:
    for name in q:
        if name not in names:
            raise UnknownName(f"{what}: no coordinate {shown(name)}; {closest(name, names)}")
    missing = [name for name in names if name not in q]
    if missing:
        raise InputError(f"{what}: no value for {listed(missing)}")
    values = [numbers(q[name], f"{what}[{shown(name)}]") for name in names]
    try:
        return np.stack(np.broadcast_arrays(*values), axis=-1) if values else np.empty(0)
    except ValueError as error:
        shapes = ", ".join(list(dict.fromkeys(str(value.shape) for value in values))[:12])
        raise ShapeError(f"{what}: the values' shapes do not broadcast: {shapes}") from error
