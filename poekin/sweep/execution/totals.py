"""Counts of a range of samples in the cells of a map, and their sums, in any order the same."""

from __future__ import annotations

import functools
import pickle
from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ..cells import Cells
from ..sweep import Sweep
from .fused import fused

NO_MEASURE = -np.inf
NO_SAMPLE = -1


class SweepPart(NamedTuple):
    """Cells (K,) that a range of samples fell into, how many each, and the best measure and its first
    sample; `outside` fell into none.
    """

    cells: np.ndarray | slice
    counts: np.ndarray
    best: Array
    attained: np.ndarray
    outside: int


class Totals:
    """Counts, best measures and their samples of all cells, and how many samples fell into none."""

    def __init__(self, cells: Cells, is_measured: bool) -> None:
        measured = cells.count if is_measured else 0
        self.counts = np.zeros(cells.count, np.int64)
        self.best = np.full(measured, NO_MEASURE)
        self.attained = np.full(measured, NO_SAMPLE, np.int64)
        self.outside = 0

    def run(self, sweep: Sweep, first: int, last: int) -> None:
        """Adds samples first ... last - 1."""
        from ...engine.kernels.sweep import sweep_kernel  # which imports Numba

        samples = sweep.samples
        cells = sweep.cells
        # the code is held until the call is over
        code = fused(sweep.chain, sweep.measure)
        self.outside += sweep_kernel.swept.call(
            code.address,
            first,
            last,
            samples.numbers(),
            samples.bounds,
            cells.numbers(),
            cells.place(),
            self.counts,
            self.best,
            self.attained,
        )

    def part(self) -> SweepPart:
        """The cells that are not empty."""
        cells = np.flatnonzero(self.counts)
        measured = cells if len(self.best) else cells[:0]
        return SweepPart(
            cells,
            self.counts[cells],
            self.best[measured],
            self.attained[measured],
            self.outside,
        )

    def whole(self) -> SweepPart:
        """All cells, as they are."""
        return SweepPart(slice(None), self.counts, self.best, self.attained, self.outside)

    def add(self, part: SweepPart) -> None:
        """Adds a part. The sum of several is the same in any order: counts are whole numbers, and of
        equal measures the smallest number of a sample stays.
        """
        cells = part.cells
        self.outside += part.outside
        self.counts[cells] += part.counts
        if len(self.best):
            best = self.best[cells]
            attained = self.attained[cells]
            is_first = (part.best == best) & (part.attained < attained)
            is_better = (part.best > best) | is_first
            self.best[cells] = np.where(is_better, part.best, best)
            self.attained[cells] = np.where(is_better, part.attained, attained)


def part_of(pickled: bytes, first: int, last: int) -> SweepPart:
    """Part of samples first ... last - 1 of a sweep: a function of these alone."""
    sweep = _unpickled(pickled)
    totals = Totals(sweep.cells, sweep.is_measured)
    totals.run(sweep, first, last)
    return totals.part()


# A worker gets the same sweep with each of its parts.
@functools.lru_cache(4)
def _unpickled(sweep: bytes) -> Sweep:
    return pickle.loads(sweep)
