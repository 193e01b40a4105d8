"""Cells that are none of space, as the kernels take them: four whole numbers, four others."""

from __future__ import annotations

import numpy as np

from poekin.sweep.bins import Bins, TopList


def taken(cells):
    numbers, place = cells.numbers(), cells.place()
    assert (numbers.dtype, place.dtype) == (np.int64, np.float64)
    return numbers.tolist(), place.tolist()


def test_bins_are_told_by_a_minus_one_with_their_number_their_beginning_and_how_many_there_are_in_one():
    bins = Bins(0.5, 2.5, 8)
    assert taken(bins) == ([-1, 8, 0, 0], [0.5, 0, 0, 4])
    assert bins.describe() == {"lower": 0.5, "upper": 2.5, "bins": 8}


def test_a_list_of_the_best_is_one_cell_told_by_a_minus_two():
    best = TopList(5)
    assert taken(best) == ([-2, 1, 0, 0], [0, 0, 0, 0])
    assert (best.describe(), best.count, best.length) == ({"top": 5}, 1, 5)
