"""Numbers of solutions in the middles of cells."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, branches

ARM = pk.load("ur5e").chain(tip="tool0")
CELLS = Cells.box([-0.6, -0.6, 0.0], [0.6, 0.6, 0.6], 0.3, side=1)


def test_each_cell_has_the_solutions_of_its_middle():
    counts = branches(ARM, CELLS, turns=2, limits=False)
    assert counts.shape == (4, 4, 2, 12, 2)
    T = CELLS.poses(2)
    for index in np.ndindex(4, 1, 1, 12, 2):
        assert counts[index] == len(pk.ik_all(ARM, T[index], limits=False).solutions)
    # a UR has an even number of solutions, of which eight are the most
    assert {4, 8} <= set(np.unique(counts)) <= {0, 2, 4, 6, 8}


def test_limits_are_kept_where_they_are_asked_for():
    narrow = ARM.replace(limits=[[-0.5, 0.5]] * 6)
    assert branches(narrow, CELLS).sum() < branches(narrow, CELLS, limits=False).sum()
    T = CELLS.poses()
    where = np.argwhere(branches(narrow, CELLS, limits=False) > 0)[0]
    solutions = pk.ik_all(narrow, T[tuple(where)]).solutions
    assert branches(narrow, CELLS)[tuple(where)] == len(solutions)


def test_progress_is_told_for_every_part(monkeypatch):
    from poekin.sweep.maps import branches as module

    monkeypatch.setattr(module, "_AT_ONCE", 100)
    told = []
    counts = branches(ARM, CELLS, limits=False, progress=lambda *done: told.append(done))
    assert told == [(100, 384), (200, 384), (300, 384), (384, 384)]
    monkeypatch.undo()
    np.testing.assert_array_equal(counts, branches(ARM, CELLS, limits=False))


def test_an_arm_with_a_redundant_coordinate_and_no_turn_are_refused():
    with pytest.raises(InputError, match="coordinates"):
        branches(pk.load("panda").chain(tip="panda_hand"), CELLS)
    with pytest.raises(InputError, match="turns"):
        branches(ARM, CELLS, turns=0)
