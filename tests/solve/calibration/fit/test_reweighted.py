"""Least squares repeated with weights: what is left out, and what counts as rounding."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.fit.reweighted import ROUNDS, TRIMS, Weighted, reweighted


def mean_of(values):
    """The weighted mean of some numbers, and how far each is from it."""

    def solve(w):
        mean = float(w @ values / w.sum())
        return Weighted(mean, np.abs(values - mean))

    return solve


def test_rows_beyond_four_medians_are_left_out_and_the_others_count_evenly():
    values = np.array([-3.9, -1, -1, -1, 0, 1, 1, 1, 3.9, 4.1, -4.1, 1000, -1000])
    mean, median, kept = reweighted(mean_of(values), len(values), 1, 1e-9)
    assert kept.tolist() == [True] * 9 + [False] * 4
    assert mean == pytest.approx(0, abs=1e-9)
    assert median == pytest.approx(np.median(np.abs(values - mean)))


def test_as_many_rows_are_kept_as_there_have_to_be():
    off = np.array([0.0, 0, 0, 0, 0, 7, 5, 9, 8])
    for need, more in ((1, []), (5, []), (6, [6]), (7, [5, 6]), (8, [5, 6, 8])):
        kept = reweighted(lambda w: Weighted(None, off), 9, need, 0.5).kept
        assert np.flatnonzero(kept).tolist() == [0, 1, 2, 3, 4, *more]


def test_the_median_is_that_of_all_rows_kept_or_not():
    off = np.array([1.0, 2.0, 3.0, 100.0, 200.0])
    found = reweighted(lambda w: Weighted(None, off), 5, 1, 1e-13)
    assert np.flatnonzero(found.kept).tolist() == [0, 1, 2]
    assert found.median == 3.0


def test_what_is_rounding_is_kept_whatever_the_median_is():
    weights = []

    def solve(w):
        weights.append(w)
        return Weighted(None, np.array([0.0, 0, 0, 0, 1e-14, 1e-12]))

    kept = reweighted(solve, 6, 1, 1e-13).kept
    assert kept.tolist() == [True] * 5 + [False]
    assert len(weights) == 3  # weights that have settled are not solved for again
    assert weights[0].tolist() == [1.0] * 6
    assert weights[1] == pytest.approx([1, 1, 1, 1, 1, 0.1])


def test_rows_that_take_turns_to_miss_are_solved_for_in_every_round():
    weights = []

    def solve(w):
        weights.append(w)
        residuals = np.ones(6)
        residuals[len(weights) % 6] = 100.0
        return Weighted(None, residuals)

    reweighted(solve, 6, 1, 1e-13)
    assert len(weights) == 1 + ROUNDS + TRIMS
