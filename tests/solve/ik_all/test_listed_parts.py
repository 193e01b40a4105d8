"""What the kernel of clear targets is given, and how its rows become a listing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import closed_arm
from poekin.engine.kernels.branches import listed_branches as kernel
from poekin.solve.ik_all import listed as module
from poekin.solve.ik_all.closed_form import ClosedForm, closed_form
from poekin.solve.ik_all.elimination import elimination
from poekin.solve.ik_all.ik_all_search import SearchedArm
from poekin.solve.ik_all.solution_sets.places import Box
from poekin.solve.ik_all.sources import Solvers, solvers_for
from poekin.solve.joint_units import bounds, periods
from poekin.solve.lock import free_chain

UR5 = pk.load("ur5").chain()


def test_locked_coordinates_stand_between_those_of_the_branches():
    branches = np.arange(12.0).reshape(2, 2, 3)
    values = np.array([[np.nan, 0.5, np.nan], [np.nan, 0.7, np.nan]])
    whole = module._with_locked(branches, values, np.array([True, False, True]))
    assert whole.tolist() == [
        [[0, 0.5, 1, 2], [3, 0.5, 4, 5]],
        [[6, 0.7, 7, 8], [9, 0.7, 10, 11]],
    ]
    assert module._with_locked(branches, values, np.ones(2, bool)) is branches


@pytest.mark.parametrize(("off", "rule"), [
    (0.0, [1e-12, closed_arm.DOUBLE, 1e-3, 0.01]),
    (3e-4, [3e-4, max(3e-4, closed_arm.DOUBLE), 1.3e-3, 0.01]),
    (0.02, [0.02, 0.02, 0.021, 0.02]),
])  # fmt: skip
def test_margins_are_wider_by_what_a_near_arm_is_off(off, rule):
    closed = closed_form(UR5)
    assert closed is not None
    near = ClosedForm(closed.arm, 6, closed.family, 1e-9, 1e-9, off)
    np.testing.assert_allclose(module._rule(near), rule, rtol=1e-12)
    eliminated = elimination(UR5)
    assert eliminated is not None
    assert module._rule(eliminated).tolist() == [0, 0, 1e-3, 0]


def test_the_rows_of_clear_targets_are_listed_by_target(monkeypatch):
    monkeypatch.setattr(module, "_UNINTERRUPTED", 2)
    # of each call's two targets the first rows are solutions, one target's after the other's
    n = np.arange(6.0).reshape(3, 2, 1)
    errors = np.concatenate([n, 2 * n, 3 * n], axis=2)
    counts = np.zeros((3, 2), int)
    counts[:, kernel.FOUND], counts[:, kernel.WITHIN] = [3, 9, 5], [2, 0, 1]
    listing = module._listing(n + 0.5, errors, counts, np.array([True, False, True]))
    places, tally = listing.places, listing.tally
    assert places.q.ravel().tolist() == [0.5, 1.5, 4.5]
    assert places.owner.tolist() == [0, 0, 1]
    assert places.within.tolist() == [2, 1]
    others = [k for k in range(3) if k != kernel.PLACES]
    assert places.number.tolist() == errors[[0, 0, 2], [0, 1, 0], kernel.PLACES].tolist()
    assert listing.errors.tolist() == errors[[0, 0, 2], [0, 1, 0]][:, others].tolist()
    assert (tally.found.tolist(), tally.ends.tolist()) == ([3, 5], [3, 5])
    assert tally.least_hits.tolist() == [1, 1]
    assert (tally.restarts.tolist(), tally.full.tolist()) == ([0, 0], [False, False])
    assert (tally.sure.tolist(), tally.self_motion) == ([True, True], {})


def searched(chain: pk.Chain, free: np.ndarray | None = None) -> SearchedArm:
    box = Box(bounds(chain, True), periods(chain))
    return SearchedArm(chain.compile(), box, np.ones(chain.dof, bool) if free is None else free)


def test_a_batch_in_parts_has_the_listing_of_the_whole(monkeypatch):
    T = np.repeat(UR5.fk(UR5.random(3, 12)), 2, axis=0)
    values = np.full((24, 6), np.nan)
    numbers = np.arange(1, 24, 2)
    [stage] = solvers_for(UR5, values, np.ones(6, bool), "auto")
    asked = searched(UR5), T, values, stage.chosen(numbers), numbers
    [whole], left = module.list_clear(*asked)
    assert not left.any()
    assert whole.numbers.tolist() == numbers.tolist()
    monkeypatch.setattr(module, "_AT_ONCE", 5)
    monkeypatch.setattr(module, "_UNINTERRUPTED", 2)
    parts, left = module.list_clear(*asked)
    assert not left.any()
    assert [part.numbers.tolist() for part in parts] == [
        numbers[:5].tolist(), numbers[5:10].tolist(), numbers[10:].tolist(),
    ]  # fmt: skip
    for name in ("q", "number", "within"):
        np.testing.assert_array_equal(
            np.concatenate([getattr(part.listing.places, name) for part in parts]),
            getattr(whole.listing.places, name),
        )


def test_of_fewer_than_six_joints_none_are_clear():
    five = free_chain(UR5, np.array([*[np.nan] * 5, 0.0]))
    closed = closed_form(five)
    solvers: Any = [closed]
    stage = Solvers(solvers, np.zeros(2, int), five, np.ones(5, bool))
    T = five.fk(five.random(0, 2))
    parts, left = module.list_clear(searched(five), T, np.full((2, 5), np.nan), stage, np.arange(2))
    assert (parts, left.tolist()) == ([], [True, True])
