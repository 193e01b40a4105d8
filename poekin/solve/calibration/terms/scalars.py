"""Readings and conditions as scalars of any kind: numbers of many rows at once, or scalars that record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ....groups.arrays import Array
from .conditions import Conditions

SineCosine = Callable[[Sequence[float], float], tuple[Any, Any]]


class Scalars(NamedTuple):
    """Readings and conditions, named as in `Conditions`.

    `sine_cosine(factors, offset)` is of the sum of factors[k] q_k, plus an offset, rad.
    """

    q: Sequence[Any]
    payload: Any
    gravity: Sequence[Any]
    approach: Sequence[Any]
    previous: Sequence[Any]
    drift: Any
    sine_cosine: SineCosine


Columns = Callable[[Scalars], Sequence[Any]]
"""Columns of a basis: coefficient j multiplies number j, added to the reading of its owner."""


def linear(factors: Sequence[float], q: Sequence[Any], offset: float) -> Any:
    """Sum of factors[k] q_k, plus an offset."""
    total: Any = offset
    for factor, x in zip(factors, q, strict=True):
        if factor:
            total = total + factor * x
    return total


def of_rows(q: Array, conditions: Conditions) -> Scalars:
    """Each scalar an array (N,) of the rows of q (N, m)."""
    columns = list(q.T)

    def sine_cosine(factors: Sequence[float], offset: float) -> tuple[Array, Array]:
        x = linear(factors, columns, offset)
        return np.sin(x), np.cos(x)

    return Scalars(
        columns,
        conditions.payload,
        list(conditions.gravity.T),
        list(conditions.approach.T),
        list(conditions.previous.T),
        conditions.drift,
        sine_cosine,
    )
