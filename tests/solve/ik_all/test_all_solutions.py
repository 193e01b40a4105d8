"""What is said of all solutions: how many, how they were found, and how sure it is; and limits in
whole turns.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.solve.ik_all.all_solutions import AllSolutions, in_words, missing_probability
from poekin.solve.ik_all.closed_form import ClosedForm
from poekin.solve.ik_all.ik_all_search import Found, accepted, turns_within
from poekin.solve.joint_units import periods

Z = [0, 0, 1.0]
ARM = pk.Chain.from_space([screw.revolute(Z, [0, 0, 0]), screw.prismatic(Z), screw.revolute(Z, [1, 0, 0])], np.eye(4),
               limits=[[-4, 8], [-1, 2], [-np.inf, np.inf]])  # fmt: skip


def found(count, *, ends=0, restarts=0, full=False, self_motion_coordinates=(), width=6, hits=None):
    hits = np.full(count, 7.0) if hits is None else np.array(hits, float)
    return Found(
        np.zeros((count, width)), hits, ends, restarts, full, False, self_motion_coordinates
    )


@pytest.mark.parametrize("one, inside, closed, words", [
    (found(0), 0, "closed form (EAIK, X)", "0 solutions: closed form (EAIK, X)"),
    (found(1), 1, "by X", "1 solution: by X"),
    (found(8), 3, "by X", "8 solutions, 3 of them within the limits: by X"),
    (found(1, self_motion_coordinates=("a",)), 1, "by X",
     "infinitely many solutions, along which 'a' move; one of them: by X"),
    (found(2, self_motion_coordinates=("a", "b")), 2, "by X",
     "infinitely many solutions, along which 'a', 'b' move; one of them and 1 that stands alone: by X"),
    (found(4, self_motion_coordinates=("a",)), 0, "by X",
     "infinitely many solutions, along which 'a' move; one of them and 3 that "
     "stand alone, 0 of them within the limits: by X"),
])  # fmt: skip
def test_solutions_are_counted_in_words(one, inside, closed, words):
    assert in_words(one, inside, closed) == words


def test_a_search_says_how_often_each_was_found_and_an_odd_number():
    even = found(2, ends=30, restarts=40, hits=[20, 10])
    chance = (1 - 0.5 * 10 / 30) ** 30
    assert missing_probability(even) == pytest.approx(chance)
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
    assert missing_probability(found(4)) == 0
    for nothing in (
        found(2, self_motion_coordinates=("a",)),
        found(40, full=True),
        found(0, restarts=9),
    ):
        assert np.isnan(missing_probability(nothing))
    assert in_words(found(40, ends=99, restarts=9, full=True), 40, None).startswith(
        "at least 40 solutions"
    )


@pytest.mark.parametrize("bounds, words", [
    ((0.0, 0.0), "closed form (EAIK, six)"),
    ((0.0, 2e-6), "closed form (EAIK, six) of the arm made exact, at most 0 m and 2e-06 rad away, tried down to the "
     "target"),
    ((3e-6, 0.0), "closed form (EAIK, six) of the arm made exact, at most 3e-06 m and 0 rad away, tried down to the "
     "target"),
])  # fmt: skip
def test_a_closed_form_says_whose_and_of_which_arm(bounds, words):
    class Solver:
        def getKinematicFamily(self):
            return "six"

    form: Any = pk.load("puma560").chain().to_hp()
    assert ClosedForm(form, Solver(), *bounds).said() == words


def test_results_of_one_target_and_of_many_are_read_alike():
    nothing = np.zeros(2)
    many = AllSolutions([np.zeros((1, 6)), np.ones((2, 6))], [], ["1 solution", "2 solutions"], "search",
                        np.array([1, 2]), nothing, nothing, nothing, nothing, nothing)  # fmt: skip
    assert repr(many) == "<AllSolutions of 2 targets by search: 3 in all>"
    assert (many.of(1) == 1).all()
    zero = np.array(0.0)
    one = AllSolutions(
        np.ones((2, 6)), [], "2 solutions", "closed form", np.array(2), zero, zero, zero, zero, zero
    )
    assert repr(one) == "<AllSolutions by closed form: 2 solutions>"
    assert one.of().shape == (2, 6)


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
    first, last = turns_within(ARM, Q, True)
    np.testing.assert_array_equal(first[:, 0], [0, -1, -1, 1, 0])
    np.testing.assert_array_equal(last[:, 0], [1, 0, 0, 1, 1])
    np.testing.assert_array_equal(
        first[:, 1], [0, 1, 0, 0, 0]
    )  # beyond its limits a slide has no turn that helps
    np.testing.assert_array_equal(last[:, 1], 0)
    assert (first[:, 2] == -np.inf).all()
    assert (last[:, 2] == np.inf).all()
    first, last = turns_within(ARM, Q, False)
    np.testing.assert_array_equal(first, np.tile([-np.inf, 0, -np.inf], (5, 1)))
    np.testing.assert_array_equal(last, np.tile([np.inf, 0, np.inf], (5, 1)))


@pytest.mark.parametrize("length, bound", [(1.0, 1e-10), (99.0, 1e-10), (1000.0, 1e-9)])
def test_of_a_long_arm_a_solution_is_as_near_as_its_pose_is_known(length, bound):
    arm = pk.Chain.from_space([screw.revolute(Z, [0, 0, 0])], pk.se3.exp([0, 0, 0, length, 0, 0]))
    assert accepted(arm) == pytest.approx(bound, rel=0.01)
