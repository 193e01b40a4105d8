"""A positive number for each coordinate, as users give limits and steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError, safe_repr
from ..groups.arrays import Array, numbers
from ..model.chain import Chain
from ..model.coordinates import coordinates


def per_coordinate(value: Any, chain: Chain, what: str) -> Array:
    """A positive number for each coordinate. Raises: InputError, ShapeError, UnknownName."""
    if not isinstance(value, Mapping) and not numbers(value, what).ndim:
        value = np.full(chain.dof, float(value))
    array = coordinates(value, chain.q_names, what)
    if array.ndim != 1:
        raise ShapeError(
            f"{what}: expected one number, or one a coordinate ({chain.dof},), got shape {array.shape}"
        )
    if not (array > 0).all():
        raise InputError(f"{what}: expected positive numbers, got {safe_repr(array.tolist())}")
    return np.ascontiguousarray(array)
