"""What is said of all solutions: how many, how they were found, and how sure it is; and limits in
whole turns.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.model import screw
from poekin.solve.ik_all.all_solutions import AllSolutions
from poekin.solve.ik_all.closed_form import ClosedForm
from poekin.solve.ik_all.ik_all_search import accepted
from poekin.solve.ik_all.solution_sets.evidence import (
    Evidence,
    Sampling,
    SolverUsed,
    missing_probability,
)
from poekin.solve.ik_all.solution_sets.found import Found
from poekin.solve.ik_all.solution_sets.places import Box, turns_within
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion
from poekin.solve.joint_units import bounds, periods
from poekin.solve.ragged import Ragged

Z = [0, 0, 1.0]
ARM = pk.Chain.from_space([screw.revolute(Z, [0, 0, 0]), screw.prismatic(Z), screw.revolute(Z, [1, 0, 0])], np.eye(4),
               limits=[[-4, 8], [-1, 2], [-np.inf, np.inf]])  # fmt: skip


def found(count, *, ends=0, restarts=0, full=False, self_motion=(), width=6, hits=None):
    hits = np.full(count, 7.0) if hits is None else np.array(hits, float)
    return Found(
        Ragged(np.zeros((count, width)), np.array([count])),
        hits,
        np.array([ends]),
        np.array([restarts]),
        np.array([full]),
        np.array([False]),
        {0: SelfMotion(self_motion, np.zeros(width))} if self_motion else {},
    )


def evidence(one, inside, closed, **changes):
    used = None if closed is None else SolverUsed("closed form", closed)
    made = Evidence(
        finite=np.array([True]),
        found=one.q.counts,
        within=np.array([inside]),
        least_hits=one.least_hits(),
        ends=one.ends,
        restarts=one.restarts,
        full=one.full,
        sure=np.array([closed is not None]),
        p_missing=missing_probability(one.tally(True)),
        self_motion=one.self_motion,
        free=one.q.rows.shape[1],
        solver=used,
    )
    return replace(made, **changes)


def in_words(one, inside, closed):
    return evidence(one, inside, closed).sentence(0)


@pytest.mark.parametrize("one, inside, closed, words", [
    (found(0), 0, "closed form (X)", "0 solutions: closed form (X)"),
    (found(1), 1, "by X", "1 solution: by X"),
    (found(8), 3, "by X", "8 solutions, 3 of them within the limits: by X"),
    (found(1, self_motion=("a",)), 1, "by X",
     "infinitely many solutions, along which 'a' move; one of them: by X"),
    (found(2, self_motion=("a", "b")), 2, "by X",
     "infinitely many solutions, along which 'a', 'b' move; one of them and 1 that stands alone: by X"),
    (found(4, self_motion=("a",)), 0, "by X",
     "infinitely many solutions, along which 'a' move; one of them and 3 that "
     "stand alone, 0 of them within the limits: by X"),
])  # fmt: skip
def test_solutions_are_counted_in_words(one, inside, closed, words):
    assert in_words(one, inside, closed) == words


def test_a_search_says_how_often_each_was_found_and_an_odd_number():
    even = found(2, ends=30, restarts=40, hits=[20, 10])
    chance = (1 - 0.5 * 10 / 30) ** 30
    assert missing_probability(even.tally(False)) == pytest.approx(chance)
    said = in_words(even, 2, None)
    assert said == (
        "2 solutions: search, 40 tries, each found 10 times or more; one that is half as easy to find as the rarest is "
        f"missing with a chance of {chance:.1g}"
    )
    odd = found(3, ends=30, restarts=40)
    assert in_words(odd, 3, None).endswith(
        "; the number is odd: one of them is a double one, or one is missing"
    )
    assert "odd" not in in_words(found(3, ends=30, restarts=40, width=5), 3, None)
    assert missing_probability(found(4).tally(True)) == 0
    assert np.isnan(missing_probability(found(4).tally(False))), "of a near arm nothing is known"
    for nothing in (
        found(2, self_motion=("a",)),
        found(40, full=True),
        found(0, restarts=9),
    ):
        assert np.isnan(missing_probability(nothing.tally(True)))
    assert in_words(found(40, ends=99, restarts=9, full=True), 40, None).startswith(
        "at least 40 solutions"
    )


@pytest.mark.parametrize("one, closed, exact, finite, complete", [
    (found(8), "by X", True, True, True),
    (found(0), "by X", True, True, True),
    (found(8), "by X", False, True, False),
    (found(8), "by X", True, False, False),
    (found(8, ends=30, restarts=9), "by X", True, True, False),
    (found(8, ends=30, restarts=9), None, True, True, False),
    (found(2, self_motion=("a",)), "by X", True, True, False),
    (found(40, full=True), "by X", True, True, False),
])  # fmt: skip
def test_only_a_closed_form_of_the_arm_itself_finds_all_for_sure(
    one, closed, exact, finite, complete
):
    sure = np.array([exact and closed is not None])
    said = evidence(one, 0, closed, sure=sure, finite=np.array([finite]))
    assert said.complete.tolist() == [complete]
    assert said.continuum.tolist() == [bool(one.self_motion)]


def test_of_a_redundant_arm_the_values_of_its_coordinate_are_said():
    sampling = Sampling("a", 64)
    some = evidence(found(312, ends=900, restarts=1000), 300, None, sampling=sampling)
    assert some.sentence(0).startswith(
        "infinitely many solutions; 312 solutions at 64 values of 'a', 300 of them within the limits: search, "
        "1000 tries, each found 7 times or more; one is missing with a chance of "
    )
    assert (some.complete.tolist(), some.continuum.tolist()) == ([False], [True])
    none = evidence(found(0, restarts=99), 0, None, sampling=sampling)
    assert none.sentence(0) == "0 solutions at 64 values of 'a': search, 99 tries"
    assert none.continuum.tolist() == [False]


@pytest.mark.parametrize("bounds, words", [
    ((0.0, 0.0), "closed form (six)"),
    ((0.0, 2e-6), "closed form (six) of the arm made exact, at most 0 m and 2e-06 rad away, tried down to the "
     "target"),
    ((3e-6, 0.0), "closed form (six) of the arm made exact, at most 3e-06 m and 0 rad away, tried down to the "
     "target"),
])  # fmt: skip
def test_a_closed_form_says_whose_and_of_which_arm(bounds, words):
    assert ClosedForm(np.zeros((10, 8)), 6, "six", *bounds).said() == words


def result(counts: Any, **changes: Any) -> AllSolutions:
    counts = np.array(counts)
    nothing = np.zeros(counts.shape)
    S = int(counts.sum())
    q = np.arange(2.0 * S).reshape(S, 2)
    return AllSolutions(
        q, np.arange(S), counts, "search", counts, nothing > 0, False, nothing, nothing, nothing, {}, **changes
    )  # fmt: skip


def test_results_of_one_target_and_of_many_are_read_alike():
    many = result([1, 2])
    assert repr(many) == "<AllSolutions of 2 targets by search: 3 in all>"
    assert str(many) == "3 solutions of 2 targets, by search"
    np.testing.assert_array_equal(many.of(1), many.q[1:])
    one = result(2)
    assert repr(one) == "<AllSolutions by search: 2 solutions>"
    assert one.of().shape == one.solutions.shape == (2, 2)
    assert one.n_revolutions.tolist() == [0, 1]
    assert one.padded() is not one.q
    np.testing.assert_array_equal(one.padded(), one.q)
    assert one.target_number.tolist() == [0, 0]


def test_solutions_of_a_batch_are_parts_of_one_array_and_no_copies():
    many = result([[2, 0], [3, 1]])
    parts = many.solutions
    assert [len(part) for part in parts] == [2, 0, 3, 1]
    assert len(parts) == 4
    np.testing.assert_array_equal(parts[-2], many.q[2:5])
    assert all(np.shares_memory(part, many.q) for part in parts if len(part))
    assert [part.tolist() for part in parts[1:3]] == [[], many.q[2:5].tolist()]
    assert [n.tolist() for n in many.n_revolutions] == [[0, 1], [], [2, 3, 4], [5]]
    assert many.target_number.tolist() == [0, 0, 2, 2, 2, 3]
    for wrong in (4, -5):
        with pytest.raises(IndexError, match=rf"index {wrong} is out of bounds for 4 targets"):
            parts[wrong]
    assert repr(parts) == "<Ragged of 4: lengths [2 0 3 1]>"


def test_padded_solutions_are_one_array_with_nan_and_numbers_of_places_with_0():
    many = result([[2, 0], [3, 1]])
    whole = many.padded()
    assert whole.shape == (2, 2, 3, 2)
    for index in np.ndindex(2, 2):
        own = many.of(*index)
        np.testing.assert_array_equal(whole[index][: len(own)], own)
        assert np.isnan(whole[index][len(own) :]).all()
    numbers = many.padded("n_revolutions")
    assert numbers.dtype == many.revolutions.dtype
    assert numbers.tolist() == [[[0, 1, 0], [0, 0, 0]], [[2, 3, 4], [5, 0, 0]]]
    assert result(np.zeros((0,), int)).padded().shape == (0, 0, 2)
    wrong: Any = "q"
    with pytest.raises(InputError, match=r"what: expected 'solutions' or 'n_revolutions', got 'q'"):
        many.padded(wrong)


def test_sentences_are_made_when_they_are_asked_for_only(monkeypatch):
    made = []
    monkeypatch.setattr(Evidence, "sentence", lambda self, k: made.append(k) or f"target {k}")
    many = result([1, 2, 0], evidence=evidence(found(1), 1, None))
    sentences = many.explanation
    assert (made, len(sentences)) == ([], 3)
    assert sentences[-1] == "target 2"
    assert made == [2]
    assert list(sentences) == ["target 0", "target 1", "target 2"]


def test_a_result_becomes_json_with_the_solutions_of_each_target():
    document = json.loads(result([1, 0, 2]).to_json())
    assert document["solutions"] == [[[0.0, 1.0]], [], [[2.0, 3.0], [4.0, 5.0]]]
    assert document["n_revolutions"] == [[0], [], [1, 2]]
    assert document["explanation"] == ["1 solution", "0 solutions", "2 solutions"]
    assert document["counts"] == [1, 0, 2]
    assert not {"q", "evidence", "chain", "target"} & set(document)
    assert json.loads(result(1).to_json())["solutions"] == [[0.0, 1.0]]


@pytest.mark.parametrize("known", [
    {},
    {"redundant": "a", "sample": np.zeros(2, int)},
    {"redundant": "a", "chain": ARM},
    {"sample": np.zeros(2, int), "chain": ARM},
])  # fmt: skip
def test_only_a_result_with_samples_has_families(known):
    with pytest.raises(
        InputError,
        match=r"^families: expected a result of ik_all with n_swivel, of a redundant arm$",
    ):
        result(2, **known).families()


def test_whole_turns_that_may_be_added_within_the_limits_are_counted_from_the_fewest_to_the_most():
    np.testing.assert_allclose(periods(ARM), [2 * np.pi, 0, 2 * np.pi])
    Q = np.array(
        [
            [-3.0, 1.5, 0.3],
            [3.0, 2.5, -0.3],
            [8.0, -1.0, 0],
            [-4.5, 2.0, 0],
            [-4 - 5e-13, 2 + 5e-13, 0],
        ]
    )
    first, last = turns_within(Box(bounds(ARM, True), periods(ARM)), Q)
    np.testing.assert_array_equal(first[:, 0], [0, -1, -1, 1, 0])
    np.testing.assert_array_equal(last[:, 0], [1, 0, 0, 1, 1])
    np.testing.assert_array_equal(
        first[:, 1], [0, 1, 0, 0, 0]
    )  # beyond its limits a slide has no turn that helps
    np.testing.assert_array_equal(last[:, 1], 0)
    assert (first[:, 2] == -np.inf).all()
    assert (last[:, 2] == np.inf).all()
    first, last = turns_within(Box(bounds(ARM, False), periods(ARM)), Q)
    np.testing.assert_array_equal(first, np.tile([-np.inf, 0, -np.inf], (5, 1)))
    np.testing.assert_array_equal(last, np.tile([np.inf, 0, np.inf], (5, 1)))


@pytest.mark.parametrize("length, bound", [(1.0, 1e-10), (99.0, 1e-10), (1000.0, 1e-9)])
def test_of_a_long_arm_a_solution_is_as_near_as_its_pose_is_known(length, bound):
    arm = pk.Chain.from_space([screw.revolute(Z, [0, 0, 0])], pk.se3.exp([0, 0, 0, length, 0, 0]))
    assert accepted(arm) == pytest.approx(bound, rel=0.01)
