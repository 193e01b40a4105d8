"""Evidence of the values of a redundant coordinate is taken together, target by target."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.ik_all import ik_all as module
from poekin.solve.ik_all.solution_sets.evidence import Evidence, Sampling, SolverUsed
from poekin.solve.ik_all.solution_sets.found import Tally
from poekin.solve.ik_all.solution_sets.listing import Listing
from poekin.solve.ik_all.solution_sets.places import Places
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion

USED = SolverUsed("closed form", "X")
MOVING = {2: SelfMotion(("b",), np.zeros(2))}
# of six rows: found, rarest, ends, restarts; of two targets at three values, or of six targets
FOUND, LEAST = np.array([2, 1, 4, 1, 0, 2]), np.array([4.0, 6, 3, 5, 0, 2])
ENDS, RESTARTS = np.array([8, 6, 12, 5, 0, 10]), np.array([9, 7, 13, 6, 4, 11])


def evidence(n: int, redundant: int | None) -> Evidence:
    question: Any = SimpleNamespace(
        n_swivel=n,
        redundant=redundant,
        given=SimpleNamespace(q_names=("a", "b")),
        free=np.array([True, False, True]),
    )
    tally = Tally(
        FOUND,
        LEAST,
        ENDS,
        RESTARTS,
        full=np.array([False, False, False, False, True, False]),
        sure=np.array([True, False, True, True, True, True]),
        self_motion=MOVING,
    )
    within = np.array([1, 1, 3, 0, 0, 2])
    places = Places(np.zeros((0, 2)), np.zeros(0, int), np.zeros(0, int), within)
    finite = np.repeat([True, False], 3) if redundant is not None else np.arange(6) != 5
    return module._evidence(question, Listing(places, np.zeros((0, 2)), tally), finite, USED)


def test_a_solution_is_missing_where_it_is_missing_at_any_value():
    said = evidence(3, 1)
    # no value has a continuum or is full of the first target's but the third, of which nothing is known
    assert np.isnan(said.p_missing).all()
    assert said.finite.tolist() == [True, False]
    assert said.found.tolist() == [7, 3]
    assert said.within.tolist() == [5, 2]
    assert said.least_hits.tolist() == [3, 0]
    assert said.ends.tolist() == [26, 15]
    assert said.restarts.tolist() == [29, 21]
    assert said.full.tolist() == [False, True]
    assert said.sure.tolist() == [False, True]
    assert said.sampling == Sampling("b", 3)
    assert said.self_motion == {}
    assert (said.free, said.solver) == (2, USED)


def test_of_each_target_alone_its_own_numbers_are_the_evidence():
    said = evidence(1, None)
    chance = (1 - 0.5 * LEAST[:2] / ENDS[:2]) ** ENDS[:2]
    np.testing.assert_allclose(said.p_missing[:2], chance)
    assert np.isnan(said.p_missing[[2, 4, 5]]).all()
    assert said.found.tolist() == FOUND.tolist()
    assert said.least_hits.tolist() == LEAST.tolist()
    assert said.sampling is None
    assert said.self_motion == MOVING


def test_chances_of_values_are_taken_together_as_of_independent_ones(monkeypatch):
    each = np.array([0.5, 0.2, 0.0, 0.1, 0.1, 1.0])
    monkeypatch.setattr(module, "missing_probability", lambda tally: each)
    said = evidence(3, 1)
    np.testing.assert_allclose(said.p_missing, [1 - 0.5 * 0.8, np.nan])
    said = evidence(2, 1)
    # rows 4 and 6 are of targets that are not finite
    np.testing.assert_allclose(said.p_missing, [1 - 0.5 * 0.8, np.nan, np.nan])


def test_an_arm_without_coordinates_has_no_solutions_to_list():
    words = "ik_all: expected an arm of one to six coordinates, the chain has none"
    with pytest.raises(InputError, match=f"^{words}$"):
        pk.ik_all(pk.Chain.from_space([], np.eye(4)), np.eye(4))


def test_a_geared_arm_has_its_solutions_in_its_own_coordinates():
    arm = pk.load("ur5").chain()
    gears = np.diag([2.0, 1, 1, -3, 1, 1])
    geared = arm.replace(coupling=gears, q_names=list("abcdef"), limits=None, velocity_limits=None)
    q = np.array([[0.3, -1.2, 1.1, 0.2, 0.8, 0.1], [1.1, -0.7, 1.6, -0.3, -1.0, 2.0]])
    found = pk.ik_all(geared, geared.fk(q), limits=False)
    assert found.method == "closed form"
    for k in range(2):
        own = found.solutions[k]
        assert np.abs(own - q[k]).max(axis=1).min() < 1e-9
        np.testing.assert_allclose(
            geared.fk(own), np.tile(geared.fk(q[k]), (len(own), 1, 1)), atol=1e-9
        )


def test_of_joints_with_limits_of_their_own_no_solution_is_beyond_them():
    arm = pk.load("ur5").chain()
    own = np.tile([-2.0, 2.5], (6, 1))
    q = np.array([0.3, -1.2, 1.1, 0.2, 0.8, 0.1])
    every = pk.ik_all(arm, arm.fk(q), limits=False).solutions
    within = ((every >= -2.0) & (every <= 2.5)).all(axis=1)
    found = pk.ik_all(arm.replace(joint_limits=own, limits=None), arm.fk(q))
    assert 0 < within.sum() < len(every)
    np.testing.assert_allclose(found.solutions, every[within], atol=1e-9)
