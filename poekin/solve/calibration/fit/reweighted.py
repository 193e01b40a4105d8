"""Least squares repeated with weights, so that gross outliers do not pull the solution."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ..model.last_result import LastResult

ROUNDS = 20
TRIMS = 3
GROSS = 4.0
"""A row whose residual is more than this many medians is left out at the end: 4 sigma of an error
along one axis, and 6 of the length of one in space.
"""

Value = TypeVar("Value")


class Weighted(NamedTuple, Generic[Value]):
    """Solution of a weighted problem, and the residual (N,) of each row."""

    value: Value
    residuals: Array

    @property
    def median(self) -> float:
        """Median residual."""
        return float(np.median(self.residuals))


class Reweighted(NamedTuple, Generic[Value]):
    """Last solution, its median residual, and the rows (N,) that it was made of."""

    value: Value
    median: float
    kept: NDArray[np.bool_]


def reweighted(
    solve: Callable[[Array], Weighted[Value]],
    count: int,
    need: int,
    floor: float,
    first: Weighted[Value] | None = None,
) -> Reweighted[Value]:
    """Solution of solve(weights (N,)) after nearly least absolute deviations (weights
    min(1, median / residual)) and then the rows within `GROSS` medians, evenly.

    need: number of rows that are kept at least; floor: a residual that is rounding; first: the
    solution that says the first weights, of all rows where it is left out.
    Source of the weights: Huber 1964, with the median of the residuals as his constant.
    """
    last = LastResult[Weighted[Value]]()

    def solved(weights: Array) -> Weighted[Value]:
        # weights that have settled, as those of exact rows do at once, have been solved for
        return last(weights.tobytes(), lambda: solve(weights))

    found = first or solved(np.ones(count))
    for _ in range(ROUNDS):
        scale = max(found.median, floor)
        again = solved(scale / np.maximum(found.residuals, scale))
        if again is found:  # and would be at every further round
            break
        found = again
    kept = np.ones(count, bool)
    for _ in range(TRIMS):
        r = found.residuals
        least = float(np.partition(r, need - 1)[need - 1])
        kept = r <= max(GROSS * found.median, least, floor)
        found = solved(kept.astype(float))
    return Reweighted(found.value, found.median, kept)
