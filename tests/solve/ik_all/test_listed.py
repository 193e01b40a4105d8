"""Solutions that one kernel lists: the same as those that are looked for one by one."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.ik_all import ik_all as module
from poekin.solve.ik_all.closed_form import closed_form
from poekin.solve.ik_all.solution_sets.found import Tally
from poekin.solve.ik_all.solution_sets.listing import ListedPart, Listing, gathered
from poekin.solve.ik_all.solution_sets.places import Places
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion

from .perturbed import perturbed


def arms(name: str) -> pk.Chain:
    if name == "perturbed":
        return perturbed(pk.load("ur5").chain(), 1)
    return pk.load(name).chain()


def one_by_one(monkeypatch, *given, **options):
    with monkeypatch.context() as patch:
        patch.setattr(module._Question, "is_plain", False)
        return pk.ik_all(*given, **options)


@pytest.mark.parametrize("limits", [True, False])
@pytest.mark.parametrize("name", ["ur5", "puma560", "kr5", "irb140", "cobra600", "perturbed"])
def test_they_are_the_solutions_that_are_found_one_by_one_with_all_that_is_said_of_them(
    monkeypatch, name, limits
):
    chain = arms(name)
    if chain.dof == 6:
        chain = chain.replace(limits=np.tile([-np.pi, 2 * np.pi], (6, 1)))
    T = chain.fk(chain.random(3, 40))
    T[7, 0, 3] += 40.0  # out of reach
    T[8, 1, 1] = np.nan
    found = pk.ik_all(chain, T, limits=limits)
    expected = one_by_one(monkeypatch, chain, T, limits=limits)
    np.testing.assert_allclose(found.q, expected.q, atol=1e-9)
    for what in ("revolutions", "counts", "anywhere", "continuum", "complete", "p_missing"):
        np.testing.assert_array_equal(getattr(found, what), getattr(expected, what))
    assert list(found.explanation) == list(expected.explanation)
    both = found.counts > 0
    for what in ("position_error", "rotation_error"):
        assert (getattr(found, what)[both] <= 1e-12 * chain.reach).all()
        assert np.isnan(getattr(found, what)[~both]).all()


def test_a_locked_joint_keeps_its_value_in_each_of_them(monkeypatch):
    chain = pk.load("panda").chain(tip="panda_hand")
    q = chain.random(5, 30)
    q[:, 6] = 0.8
    lock = {"panda_joint7": 0.8}
    found = pk.ik_all(chain, chain.fk(q), lock=lock)
    expected = one_by_one(monkeypatch, chain, chain.fk(q), lock=lock)
    np.testing.assert_allclose(found.q, expected.q, atol=1e-9)
    assert (found.q[:, 6] == 0.8).all()


def test_near_a_singular_wrist_all_solutions_are_listed_and_are_complete():
    # the fifth joint of 1e-5 rad: its pair stands 2e-5 rad apart, the others are turned by pi
    chain = pk.load("puma560").chain()
    q = np.array([0.3, -0.8, 0.4, 0.7, 1e-5, -0.4])
    found = pk.ik_all(chain, chain.fk(q), limits=False)
    assert found.complete
    assert found.counts == 8
    # where the wrist is singular, angles are known to rounding over the sine of the fifth
    assert np.abs(found.solutions - q).max(axis=1).min() < 1e-9


def test_a_rounded_arm_is_complete_by_its_exact_twin_and_elimination_where_that_is_in_doubt():
    # right angles of 1.5708, as files have them: the axes miss each other by micrometres
    chain = perturbed(pk.load("puma560").chain(), 3, angle=4e-6, length=1e-6)
    T = chain.fk(chain.random(8, 200))
    found = pk.ik_all(chain, T, limits=False)
    assert found.method == "closed form"
    assert np.mean(found.complete) > 0.95
    expected = pk.ik_all(chain, T, limits=False, method="elimination")
    both = found.complete & expected.complete
    np.testing.assert_array_equal(found.counts[both], expected.counts[both])
    np.testing.assert_allclose(found.q, expected.q, atol=1e-7)


@pytest.mark.parametrize("name", ["ur5", "puma560", "kr5", "irb140", "perturbed"])
def test_a_target_far_out_of_reach_has_no_solutions_without_a_search(monkeypatch, name):
    chain = arms(name)
    T = chain.fk(chain.random(4, 30))
    T[10:, :3, 3] *= 10.0
    expected = one_by_one(monkeypatch, chain, T)
    monkeypatch.setattr(module, "_searched", None)
    found = pk.ik_all(chain, T)
    np.testing.assert_array_equal(found.counts, expected.counts)
    assert (found.anywhere[10:] == 0).all()
    assert found.complete.all()
    assert found.explanation[15] == expected.explanation[15]


@pytest.mark.parametrize("name", ["stanford", "cobra600"])
def test_of_prismatic_joints_a_search_says_that_there_is_no_solution(name):
    closed = closed_form(arms(name))
    assert closed is not None
    assert closed.none_below == -np.inf


def test_threads_list_the_same():
    chain = pk.load("kr5").chain()
    T = chain.fk(chain.random(6, 700))
    alone = pk.ik_all(chain, T)
    shared = pk.ik_all(chain, T, parallel=True)
    np.testing.assert_array_equal(alone.q, shared.q)
    np.testing.assert_array_equal(alone.counts, shared.counts)


def outcome(owner: list[int], within: list[int], name: str) -> Listing:
    count = len(within)
    numbers = np.arange(len(owner), dtype=float)
    places = Places(numbers[:, None], np.array(owner, int), numbers.astype(int), np.array(within))
    tally = Tally(
        found=np.array(within),
        least_hits=np.ones(count),
        ends=np.full(count, 2),
        restarts=np.zeros(count, int),
        full=np.zeros(count, bool),
        sure=np.ones(count, bool),
        self_motion={0: SelfMotion((name,), np.zeros(1))},
    )
    return Listing(places, np.stack([numbers, numbers], axis=1), tally)


def test_parts_of_a_batch_are_put_together_target_by_target():
    first = ListedPart(np.array([0, 3]), outcome([0, 0, 1], [2, 1], "a"))
    second = ListedPart(np.array([2]), outcome([0], [1], "b"))
    whole = gathered([first, second], 4)
    assert whole.places.owner.tolist() == [0, 0, 2, 3]
    assert whole.places.q.ravel().tolist() == [0.0, 1.0, 0.0, 2.0]
    assert whole.places.number.tolist() == [0, 1, 0, 2]
    assert whole.errors[:, 0].tolist() == [0.0, 1.0, 0.0, 2.0]
    assert whole.places.within.tolist() == [2, 0, 1, 1]
    assert whole.tally.found.tolist() == [2, 0, 1, 1]
    assert whole.tally.ends.tolist() == [2, 0, 2, 2]
    assert {k: one.names for k, one in whole.tally.self_motion.items()} == {0: ("a",), 2: ("b",)}
