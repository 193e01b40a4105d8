"""Counts of a range of samples in the cells of a map, and their sums, in any order the same."""

from __future__ import annotations

import functools
import pickle
import time
from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ..bins import TopList
from ..pose_samples import NumberedPoses
from ..samples import Samples
from ..solutions import best_solutions
from ..sweep import KeepRule, Sweep
from .fused import fused, mask_numbers

NO_MEASURE = -np.inf
NO_SAMPLE = -1
_AT_ONCE = 2**30  # samples that the kernel adds to a sum at once
_POSES = 2**11  # poses that are solved at once
_HALF = 32  # bits of a sum's lower half
_FINE = 2.0**-40  # unit of a sum
_NONE = np.empty(0)
_NO_SUMS = np.empty(0, np.int64)


class SweepPart(NamedTuple):
    """Cells (K,) that a range of samples fell into, how many each, and what is kept of the measure,
    two arrays as in `Totals`; `outside` fell into none.
    """

    cells: np.ndarray | slice
    counts: np.ndarray
    best: np.ndarray
    attained: np.ndarray
    outside: int


class Totals:
    """Counts of all cells, how many samples fell into none, and what is kept of the measure.

    Measures have the sign that makes what is kept the largest. By the sweep's `rule`:

    - "extreme": `best` of each cell, and the first sample that has `attained` it
    - "sum": `best` and `attained` are the upper and lower halves of whole numbers of 2^-40
    - "top": `best` in descending order, and the samples that have `attained` them
    """

    def __init__(self, sweep: Sweep) -> None:
        self.sweep = sweep
        self.rule: KeepRule = sweep.rule
        count = sweep.cells.count
        self.counts = np.zeros(count, np.int64)
        self.outside = 0
        size = 0 if self.rule == "count" else count
        if isinstance(sweep.cells, TopList):
            size = sweep.cells.length
        self.best: np.ndarray = np.full(size, NO_MEASURE)
        self.attained = np.full(size, NO_SAMPLE, np.int64)
        if self.rule == "sum":
            self.best = np.zeros(size, np.int64)
            self.attained = np.zeros(size, np.int64)

    def run(self, first: int, last: int) -> None:
        """Adds samples first ... last - 1."""
        samples = self.sweep.samples
        for start in range(first, last, _AT_ONCE):
            end = min(start + _AT_ONCE, last)
            if isinstance(samples, NumberedPoses):
                self._add_poses(samples, start, end)
            else:
                self._add_configurations(samples, start, end)
            if self.rule == "sum":
                self._carry(slice(None))

    def _add_configurations(self, samples: Samples, first: int, last: int) -> None:
        from ...engine.kernels.sweep import sweep_kernel  # which imports Numba

        sweep = self.sweep
        measure = sweep.measured
        # the code is held until the call is over
        code = fused(sweep.chain, measure, sweep.mask)
        self.outside += sweep_kernel.swept.call(
            code.address,
            first,
            last,
            samples.numbers(),
            samples.bounds,
            sweep.cells.numbers(),
            sweep.cells.place(),
            measure.whole_numbers(sweep.chain, sweep.sign),
            measure.numbers(sweep.chain),
            *mask_numbers(sweep.mask),
            *self._kept(),
        )

    def _add_poses(self, samples: NumberedPoses, first: int, last: int) -> None:
        from ...engine.kernels.sweep import pose_kernel  # which imports Numba

        sweep = self.sweep
        measure = sweep.measured
        # whole blocks wherever a range begins: where ik_all searches, it begins by the place in its batch
        for start in range(first - first % _POSES, last, _POSES):
            end = min(start + _POSES, samples.count)
            T = samples.poses(np.arange(start, end))
            found = best_solutions(sweep.chain, T, measure, sweep.mask)
            self.outside += pose_kernel.kept.call(
                start,
                max(first - start, 0),
                min(last - start, len(T)),
                T,
                found.chosen,
                sweep.cells.numbers(),
                sweep.cells.place(),
                measure.whole_numbers(sweep.chain, sweep.sign),
                found.values,
                *self._kept(),
            )

    def _kept(self) -> tuple[np.ndarray, ...]:
        """The arrays that a kernel adds to: counts, best, attained, sums."""
        if self.rule == "sum":
            return self.counts, _NONE, self.attained, self.best
        return self.counts, self.best, self.attained, _NO_SUMS

    def part(self) -> SweepPart:
        """The cells that are not empty."""
        cells = np.flatnonzero(self.counts)
        kept: slice | np.ndarray = cells
        if self.rule == "count" or self.rule == "top":
            kept = slice(None)
        return SweepPart(
            cells,
            self.counts[cells],
            self.best[kept],
            self.attained[kept],
            self.outside,
        )

    def whole(self) -> SweepPart:
        """All cells, as they are."""
        return SweepPart(slice(None), self.counts, self.best, self.attained, self.outside)

    def add(self, part: SweepPart) -> None:
        """Adds a part. The sum of several is the same in any order: counts and sums are whole numbers,
        and of equal measures the smallest number of a sample stays.
        """
        cells = part.cells
        self.outside += part.outside
        self.counts[cells] += part.counts
        if self.rule == "sum":
            self.best[cells] += part.best
            self.attained[cells] += part.attained
            self._carry(cells)
        elif self.rule == "extreme":
            best = self.best[cells]
            attained = self.attained[cells]
            is_first = (part.best == best) & (part.attained < attained)
            is_better = (part.best > best) | is_first
            self.best[cells] = np.where(is_better, part.best, best)
            self.attained[cells] = np.where(is_better, part.attained, attained)
        elif self.rule == "top":
            best = np.concatenate([self.best, part.best])
            attained = np.concatenate([self.attained, part.attained])
            order = np.lexsort((attained, -best))[: len(self.best)]
            self.best = best[order]
            self.attained = attained[order]

    def means(self) -> Array:
        """Means of the measure in each cell, of sums."""
        sums = self.best * (2.0**_HALF * _FINE) + self.attained * _FINE
        counts = np.maximum(self.counts, 1)
        return sums / counts

    def _carry(self, cells: np.ndarray | slice) -> None:
        """Brings the lower halves of sums below 2^32."""
        rest = self.attained[cells]
        self.best[cells] += rest >> _HALF
        self.attained[cells] = rest & (2**_HALF - 1)


def part_of(pickled: bytes, first: int, last: int) -> SweepPart:
    """Part of samples first ... last - 1 of a sweep: a function of these alone."""
    sweep = _unpickled(pickled)
    totals = Totals(sweep)
    totals.run(first, last)
    return totals.part()


def timed_part(pickled: bytes, first: int, last: int) -> tuple[SweepPart, float]:
    """Part of samples first ... last - 1 of a sweep, and the seconds that it took."""
    start = time.perf_counter()
    part = part_of(pickled, first, last)
    return part, time.perf_counter() - start


# A worker gets the same sweep with each of its parts.
@functools.lru_cache(4)
def _unpickled(sweep: bytes) -> Sweep:
    return pickle.loads(sweep)
