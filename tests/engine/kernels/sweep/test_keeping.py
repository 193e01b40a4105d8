"""What a range of samples leaves in the cells, uncompiled, against NumPy and whole numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.engine.kernels.sweep import keeping
from poekin.engine.kernels.sweep.tiles import OUTSIDE

Ends = tuple[int, int]
COUNT, CELLS = 40, 5
SEEDS = st.integers(0, 2**32 - 1)
RANGES = st.tuples(st.integers(0, COUNT), st.integers(0, COUNT))


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Measures, some of them equal, and cells of samples."""
    rng = np.random.default_rng(seed)
    return rng.integers(-9, 10, COUNT) / 2.0, rng.integers(OUTSIDE, CELLS, COUNT)


@given(SEEDS, RANGES)
def test_samples_of_the_range_are_counted_each_in_its_cell_and_those_in_none(seed, ends: Ends):
    _, found = drawn(seed)
    counts = np.arange(CELLS)
    outside = keeping.count_cells(found, *ends, counts)
    part = found[slice(*ends)]
    assert outside == (part == OUTSIDE).sum()
    added = np.bincount(part[part != OUTSIDE], minlength=CELLS)
    np.testing.assert_array_equal(counts - np.arange(CELLS), added)


@given(SEEDS, RANGES, st.sampled_from([1.0, -1.0]))
def test_each_cell_counts_and_keeps_the_first_sample_of_its_largest_measure(seed, ends: Ends, sign):
    values, found = drawn(seed)
    best = np.full(CELLS, -math.inf)
    attained = np.full(CELLS, -1)
    counts = np.arange(CELLS)
    outside = keeping.keep_best(sign, values, found, *ends, 1000, counts, best, attained)
    samples = range(*ends)
    assert outside == sum(found[k] == OUTSIDE for k in samples)
    for cell in range(CELLS):
        own = [k for k in samples if found[k] == cell]
        largest = max((sign * values[k] for k in own), default=-math.inf)
        first = min((1000 + k for k in own if sign * values[k] == largest), default=-1)
        assert (counts[cell] - cell, best[cell], attained[cell]) == (len(own), largest, first)


@given(SEEDS, RANGES, st.integers(1, 6), st.sampled_from([1.0, -1.0]))
def test_the_largest_of_all_stand_in_descending_order_the_first_of_equal_ones_first(
    seed, ends: Ends, size, sign
):
    values, _ = drawn(seed)
    best = np.full(size, -math.inf)
    attained = np.full(size, -1)
    keeping.keep_top(sign, values, *ends, 1000, best, attained)
    order = sorted(range(*ends), key=lambda k: (-sign * values[k], k))[:size]
    expected = [(sign * values[k], 1000 + k) for k in order]
    expected += [(-math.inf, -1)] * (size - len(order))
    assert list(zip(best.tolist(), attained.tolist(), strict=True)) == expected


@given(SEEDS, RANGES)
def test_sums_are_whole_numbers_of_units_in_two_parts(seed, ends: Ends):
    values, found = drawn(seed)
    values = values * np.pi
    sums = np.zeros(CELLS, np.int64)
    rest = np.zeros(CELLS, np.int64)
    keeping.add(values, found, *ends, sums, rest)
    for cell in range(CELLS):
        own = [values[k] for k in range(*ends) if found[k] == cell]
        total = sum(math.floor(value * 2.0**40 + 0.5) for value in own)
        assert int(sums[cell]) * 2**32 + int(rest[cell]) == total
        assert 0 <= rest[cell] <= (2**32 - 1) * len(own)


@pytest.mark.parametrize("value", [1e30, -1e30, math.inf, -math.inf])
def test_a_measure_beyond_all_sums_counts_as_the_largest(value):
    sums = np.zeros(1, np.int64)
    rest = np.zeros(1, np.int64)
    keeping.add(np.array([value]), np.array([0]), 0, 1, sums, rest)
    assert int(sums[0]) * 2**32 + int(rest[0]) == math.copysign(2**62, value)


def test_bins_begin_at_their_place_and_what_is_before_or_behind_them_is_in_none():
    values = np.full(64, 0.3)
    values[:8] = 0.0999, 0.1, 0.149, 0.15, 0.249, 0.251, math.nan, -1.0
    found = np.full(64, 77)
    keeping.write_bins((keeping.BINS, 3), (0.1, 0.0, 0.0, 20.0), values, found)
    assert found[:8].tolist() == [OUTSIDE, 0, 0, 0, 2, OUTSIDE, OUTSIDE, OUTSIDE]
    keeping.write_bins((keeping.TOP, 3), (0.1, 0.0, 0.0, 20.0), values, found)
    assert not found.any()


def test_masked_samples_of_the_range_are_in_no_cell_and_have_no_measure():
    masked = np.array([True, False, True, True, False, True])
    found = np.arange(6)
    values = np.arange(6.0)
    assert keeping.leave_out(masked, 1, 5, found, values) == 2
    assert found.tolist() == [0, 1, OUTSIDE, OUTSIDE, 4, 5]
    np.testing.assert_array_equal(values, [0, 1, math.nan, math.nan, 4, 5])


NOTHING, NO_SUMS = np.empty(0), np.empty(0, np.int64)
CUBES, LIST = (0, 2, 1, 1), (keeping.TOP, 1, 0, 0)
FOUND = np.array([OUTSIDE, 1, 0, 1, OUTSIDE, 1])
VALUES = np.array([9.0, 2.0, 3.0, 1.0, 9.0, 9.0])


def test_a_block_is_kept_as_its_arrays_and_its_cells_ask_for():
    # samples 1 to 4 of a block that begins with number 50, less counting as more
    def kept(cells, best, attained, sums):
        counts = np.array([100, 200])
        outside = keeping.keep(cells, -1.0, VALUES, FOUND, 1, 5, 50, counts, best, attained, sums)
        return outside, counts.tolist()

    best, attained = np.full(2, -math.inf), np.full(2, -1)
    assert kept(CUBES, best, attained, NO_SUMS) == (1, [101, 202])
    assert (best.tolist(), attained.tolist()) == ([-3, -1], [52, 53])

    best, attained = np.full(3, -math.inf), np.full(3, -1)
    assert kept(LIST, best, attained, NO_SUMS) == (1, [101, 202])
    assert (best.tolist(), attained.tolist()) == ([-1, -2, -3], [53, 51, 52])

    sums, rest = np.zeros((2, 2), np.int64)
    assert kept(CUBES, NOTHING, rest, sums) == (1, [101, 202])
    assert (sums.tolist(), rest.tolist()) == ([3 * 2**8, 3 * 2**8], [0, 0])

    assert kept(CUBES, NOTHING, NO_SUMS, NO_SUMS) == (1, [101, 202])
