"""Configurations of readings: which rows of q are the same, but for what joints scatter by; and the
folds that they are drawn into.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array

NEAR = 1e-3
"""rad or m: readings that differ by less, one by one, are of one configuration."""


def configurations(q: Array) -> NDArray[np.intp]:
    """Number (N,) of the configuration of each of the readings (N, m), from 0 in order of first
    appearance.

    Coordinate by coordinate, twice, the rows of a group are sorted, and parted where a gap is wide.
    """
    count = len(q)
    label = np.zeros(count, np.intp)
    for column in np.tile(q, 2).T:
        order = np.lexsort((column, label))
        apart = np.diff(label[order]) != 0
        apart |= np.diff(column[order]) > NEAR
        label[order[1:]] = np.cumsum(apart)
        label[order[:1]] = 0
    _, first, label = np.unique(label, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.intp)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[label]


class Folds(NamedTuple):
    """Number of folds, and the seed by which configurations are drawn into them."""

    count: int
    seed: int

    def of(self, label: NDArray[np.intp]) -> NDArray[np.intp]:
        """Fold (N,) of each reading; label (N,), its configuration."""
        _, first = np.unique(label, return_index=True)
        order = np.random.default_rng(self.seed).permutation(len(label))
        # each configuration as its first reading is drawn
        order = label[order[np.isin(order, first)]]
        found = np.empty(len(first), np.intp)
        for k, drawn in enumerate(np.array_split(order, self.count)):
            found[drawn] = k
        return found[label]
