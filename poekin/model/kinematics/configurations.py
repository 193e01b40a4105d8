"""Configurations and rates of a chain as users give them, made rows of a batch."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import ShapeError
from ...groups.arrays import Array
from ..chain_data import ChainData
from ..coordinates import coordinates
from ..sampling import radians_per_unit
from .degrees import warn_of_degrees


def configurations(chain: ChainData, q: Any) -> tuple[tuple[int, ...], Array]:
    """The batch shape of q and its configurations as rows (N, m)."""
    array = coordinates(q, chain.q_names)
    # Arrays come out of programs, at a microsecond a call; lists and dicts are typed by hand.
    if type(q) is not np.ndarray:
        warn_of_degrees(array, chain.q_names, chain.limits, lambda: radians_per_unit(chain), "q")
    batch = array.shape[:-1]
    return batch, array.reshape(math.prod(batch), chain.dof)


def broadcast_rows(chain: ChainData, **given: Any) -> tuple[tuple[int, ...], list[Array]]:
    """The common batch shape of configurations, rates, ... and each as rows (N, m)."""
    arrays = [coordinates(value, chain.q_names, name) for name, value in given.items()]
    try:
        shape = np.broadcast(*arrays).shape
    except ValueError as error:
        shapes = ", ".join(str(a.shape) for a in arrays)
        raise ShapeError(f"{', '.join(given)} do not broadcast: shapes {shapes}") from error
    batch = shape[:-1]
    rows = []
    for array in arrays:
        if array.shape != shape:  # for nothing, this takes as long as the rest of a call
            array = np.broadcast_to(array, shape)
        rows.append(array.reshape(math.prod(batch), chain.dof))
    return batch, rows
