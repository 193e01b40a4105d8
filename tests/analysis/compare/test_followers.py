"""Joints that follow others in two models: the ratios, in words, and from where on they differ."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.followers import follows
from poekin.model import screw
from poekin.model.chain import Chain

TOL_M, TOL_RAD = 1e-5, 1e-4
MAKE = {
    "r": screw.revolute([0, 0, 1], [0, 0, 0]), "p": screw.prismatic([1, 0, 0]),
    "h": screw.helical([0, 0, 1], [0, 0, 0], 0.1),
}  # fmt: skip


def arm(kinds, mark=""):
    return Chain.from_space(
        [MAKE[kind] for kind in kinds],
        np.eye(4),
        joint_names=[f"{mark}{k + 1}" for k in range(len(kinds))],
    )


def compared(C_a, C_b, kinds, directions=None):
    reading: Any = SimpleNamespace(
        directions=np.ones(len(kinds)) if directions is None else np.array(directions, float)
    )
    C_a, C_b = np.array(C_a, float), np.array(C_b, float)
    return follows(C_a, C_b, arm(kinds, "a"), arm(kinds, "b"), reading, Tolerances(TOL_M, TOL_RAD))


def test_the_first_independent_joints_lead_and_the_others_say_what_they_follow():
    C = [[1, 0], [2, 0], [0, 1], [0.5, -3], [0, 0]]
    found = compared(C, C, "rrrrr")
    assert [words for words, _, _ in found] == ["", "follows 2 × 'a1'", "", "follows 0.5 × 'a1' + -3 × 'a3'",
                                                "does not move"]  # fmt: skip
    assert [words for _, words, _ in found] == [words.replace("'a", "'b") for words, _, _ in found]
    assert not any(differ for _, _, differ in found)
    # A leader may go faster than a coordinate of which no joint is the master.
    assert compared([[3.0], [6.0]], [[-3.0], [1.5]], "rr") == [
        ("follows 3 × its coordinate", "follows -3 × its coordinate", True),
        ("follows 2 × 'a1'", "follows -0.5 × 'b1'", True),
    ]
    assert compared([[0.5]], [[1.0]], "r") == [("follows 0.5 × its coordinate", "", True)]
    assert compared([[2.0, 1.0]], [[1.0, 0]], "r") == [
        ("follows 2 × its coordinate + 1 × another coordinate", "", True)
    ]


def test_a_coordinate_is_reversed_with_its_joint():
    assert compared([[1.0]], [[-1.0]], "r") == [("", "follows -1 × its coordinate", True)]
    assert compared([[1.0]], [[1.0]], "r", [-1]) == [("", "", False)]
    with_a_sum = [[1, 0], [1, 1]]
    assert compared(with_a_sum, [[1, 0], [1, -1]], "rr")[1] == (
        "follows 1 × 'a1' + 1 × its coordinate",
        "follows 1 × 'b1' + -1 × its coordinate",
        True,
    )
    assert not any(
        differ for _, _, differ in compared(with_a_sum, [[1, 0], [-1, 1]], "rr", [1, -1])
    )


def test_a_joint_that_another_coordinate_moves_differs():
    assert compared(np.eye(2), np.eye(2)[::-1], "rr") == [
        ("", "follows 1 × the coordinate of 'b2'", True),
        ("", "follows 1 × the coordinate of 'b1'", True),
    ]
    # A coordinate of a joint that was dropped does not count.
    assert not any(differ for _, _, differ in compared([[1, 0, 0], [0, 0, 1]], np.eye(2), "rr"))


@pytest.mark.parametrize("kinds, off", [
    ("rr", TOL_RAD / (2 * np.pi)), ("pr", TOL_RAD), ("rp", TOL_M / (2 * np.pi)), ("pp", TOL_M),
    ("hr", TOL_RAD / (2 * np.pi)), ("ph", TOL_RAD),
])  # fmt: skip
def test_ratios_differ_by_what_a_turn_or_a_metre_of_the_leading_joint_makes_of_them(kinds, off):
    for times, differ in ((0.99, False), (1.01, True)):
        for sign in (1, -1):
            found = compared([[1], [0.5]], [[1], [0.5 + sign * times * off]], kinds)
            assert [changed for _, _, changed in found] == [False, differ]


def test_a_ratio_is_compared_in_the_directions_of_the_first_model():
    C, reversed_ = [[1], [0.5], [0.25]], [[1], [-0.5], [0.25]]
    assert [differ for _, _, differ in compared(C, reversed_, "rrr")] == [False, True, False]
    assert not any(differ for _, _, differ in compared(C, reversed_, "rrr", [1, -1, 1]))
    assert [differ for _, _, differ in compared(C, C, "rrr", [-1, 1, 1])] == [False, True, True]


def test_what_leads_in_one_model_and_follows_in_the_other_differs():
    found = compared([[1, 0], [0, 1]], [[1, 0], [1, 0]], "rr")
    assert found == [("", "", False), ("", "follows 1 × 'b1'", True)]
    # Rounding makes no leader, and of a ratio nothing.
    assert (
        compared([[1, 0], [1 + 1e-10, 1e-10]], [[1, 0], [1, 0]], "rr")[1][0] == "follows 1 × 'a1'"
    )
    assert compared([[1, 0], [0, 1], [1e-13, 1]], [[1, 0], [0, 1], [0, 1]], "rrr")[2] == (
        "follows 1 × 'a2'", "follows 1 × 'b2'", False
    )  # fmt: skip
    assert compared([[1, 0], [1, 1e-8]], [[1, 0], [1, 0]], "rr")[1][0] == (
        "follows 1 × 'a1' + 1e-08 × its coordinate"
    )


def test_a_joint_that_follows_another_beside_its_own_reading_differs_from_one_that_does_not():
    ground = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
    assert compared(ground, np.eye(3), "rrr") == [
        ("", "", False),
        ("", "", False),
        ("follows 1 × 'a2' + 1 × its coordinate", "", True),
    ]
    assert not any(differ for _, _, differ in compared(ground, ground, "rrr"))
    other = [[1, 0, 0], [0, 1, 0], [0, -1, 1]]
    assert [differ for _, _, differ in compared(ground, other, "rrr")] == [False, False, True]


def test_ratios_of_the_second_model_are_said_in_the_directions_of_the_first():
    C = [[1.0, 0.0], [1.0, 1.0]]
    found = compared(C, C, "rr", (1, -1))
    assert found[1] == (
        "follows 1 × 'a1' + 1 × its coordinate",
        "follows -1 × 'b1' + 1 × its coordinate",
        True,
    )
