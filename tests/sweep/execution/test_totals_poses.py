"""Poses are solved in whole blocks wherever a range begins, and only those of the range count."""

from __future__ import annotations

import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import poekin as pk
from poekin.sweep import Cells, PoseSamples, Random, Sweep
from poekin.sweep.execution import totals as module
from poekin.sweep.execution.totals import SweepPart, Totals
from poekin.sweep.solutions import BestSolutions
from tests.sweep.arms import two_links

ARM = pk.load("ur5e").chain(tip="tool0")
ONE = Cells((-9.0, -9.0, -9.0), 18.0, (1, 1, 1))
POSES = PoseSamples.random([0] * 3, [1] * 3, 5000, seed=4)


@pytest.mark.parametrize(
    ("first", "last", "blocks"),
    [
        (0, 5000, [(0, 2048), (2048, 4096), (4096, 5000)]),
        (2500, 4200, [(2048, 4096), (4096, 5000)]),
        (2048, 4096, [(2048, 4096)]),
        (2047, 2049, [(0, 2048), (2048, 4096)]),
        (4999, 5000, [(4096, 5000)]),
    ],
)
def test_a_range_asks_for_the_blocks_that_it_is_in(monkeypatch, first, last, blocks):
    asked = []

    def best_solutions(chain, T, measure, mask):
        asked.append(T)
        values = T[:, 0, 3].copy()
        return BestSolutions(np.zeros((1, 6)), np.zeros(len(T), np.int64), values)

    monkeypatch.setattr("poekin.sweep.execution.totals.best_solutions", best_solutions)
    totals = Totals(Sweep(ARM, POSES, ONE, "manipulability"))
    totals.run(first, last)
    for T, (start, end) in zip(asked, blocks, strict=True):
        np.testing.assert_array_equal(T, POSES.poses(np.arange(start, end)))
    x = POSES.poses(np.arange(first, last))[:, 0, 3]
    assert (totals.counts.tolist(), totals.outside) == ([last - first], 0)
    assert (totals.best[0], totals.attained[0]) == (x.max(), first + x.argmax())


def test_parts_of_a_map_that_only_counts_add_up_by_their_cells():
    arm = two_links()
    sweep = Sweep(arm, Random.of(arm, 10), Cells((-1.0, -1.0, -1.0), 1.0, (2, 2, 2)))
    totals = Totals(sweep)
    nothing = np.empty(0)
    for cells, counts, outside in (([1, 6], [2, 5], 3), ([6], [1], 1)):
        part = SweepPart(np.array(cells), np.array(counts), nothing, nothing, outside)
        totals.add(part)
    assert totals.counts.tolist() == [0, 2, 0, 0, 0, 0, 6, 0]
    assert totals.outside == 4
    assert np.asarray(totals.part().cells).tolist() == [1, 6]
    assert totals.part().counts.tolist() == [2, 6]
    assert [len(x) for x in (totals.best, totals.part().best, totals.part().attained)] == [0, 0, 0]


def test_a_part_says_how_long_it_took_and_a_sweep_is_unpickled_once(monkeypatch):
    arm = two_links()
    pickled = pickle.dumps(Sweep(arm, Random.of(arm, 21), ONE))
    unpickled = []
    monkeypatch.setattr(
        module, "pickle", SimpleNamespace(loads=lambda x: unpickled.append(x) or pickle.loads(x))
    )
    clock = iter([100.0, 100.75, 200.0, 200.25])
    monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    parts = [module.timed_part(pickled, first, first + 10) for first in (0, 10)]
    assert [seconds for _, seconds in parts] == [0.75, 0.25]
    assert [part.counts.tolist() for part, _ in parts] == [[10], [10]]
    assert unpickled == [pickled]
