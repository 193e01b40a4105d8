"""Runs of points at which something holds, with the worst point of each, and what is said of them."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.solve.path.path_events import (
    PathEvent,
    at_limit,
    events_of,
    exceeds,
    joint_at_limit,
    points,
)
from poekin.solve.path.path_interval import (
    PathInterval,
    intervals,
    intervals_at_limits,
    limits_of_joints,
)

VALUES = np.array([3.0, 9.0, 4.0, 1.0, 5.0, 2.0, 6.0])


@pytest.mark.parametrize(("mask", "runs"), [
    ("0000000", []),
    ("1111111", [(0, 6, 1)]),
    ("1000000", [(0, 0, 0)]),
    ("0000001", [(6, 6, 6)]),
    ("1110110", [(0, 2, 1), (4, 5, 4)]),
    ("0101011", [(1, 1, 1), (3, 3, 3), (5, 6, 6)]),
])  # fmt: skip
@pytest.mark.parametrize("shift", [0, 2])
def test_each_run_is_an_interval_with_its_worst_point(mask, runs, shift):
    found = intervals(np.array([c == "1" for c in mask]), -VALUES, VALUES, 0.5, "a", shift)
    assert found == [
        PathInterval(first + shift, last + shift, "a", worst + shift, -float(VALUES[worst]), 0.5)
        for first, last, worst in runs
    ]


def test_of_an_interval_name_and_bound_may_be_left_out():
    [whole] = intervals(VALUES > 4.5, VALUES, VALUES)[:1]
    assert whole == PathInterval(1, 1, "", 1, 9.0, 0.0)
    assert [type(getattr(whole, name)) for name in ("first", "worst", "value", "bound")] == [
        int, int, float, float,
    ]  # fmt: skip
    wrong: Any = whole
    with pytest.raises(FrozenInstanceError):
        wrong.first = 3


def test_values_at_a_limit_within_a_billionth_are_intervals_in_order():
    x = np.array([[1.0, 0.0], [2.0 - 5e-10, 0.0], [2.0, -3.0], [0.0, 7.0], [-1.0 + 5e-10, 7.0]])
    limits = np.array([[-1.0, 2.0], [-np.inf, 7.0]])
    found = intervals_at_limits(x, limits, ["a", "b"])
    assert found == (
        PathInterval(1, 2, "a", 2, 2.0, 2.0),
        PathInterval(3, 4, "b", 3, 7.0, 7.0),
        PathInterval(4, 4, "a", 4, -1.0 + 5e-10, -1.0),
    )


def test_joints_have_limits_of_their_own_where_any_is_finite():
    Z = [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0.0, 1.0)]
    chain = pk.Chain.from_space(Z, np.eye(4))
    assert limits_of_joints(chain) is None
    one = chain.replace(joint_limits=[[-np.inf, 1.5], [-np.inf, np.inf]])
    np.testing.assert_array_equal(
        np.asarray(limits_of_joints(one)), [[-np.inf, 1.5], [-np.inf, np.inf]]
    )


ONE = PathInterval(4, 4, "a", 4, 1.23456, 2.3456789)
SOME = PathInterval(4, 9, "b", 7, 1.23456, 2.3456789)


@pytest.mark.parametrize(("said", "words"), [
    (points(ONE), "pose 4"),
    (points(SOME), "poses 4 to 9"),
    (at_limit(ONE), "pose 4: 'a' at its limit 2.34568"),
    (joint_at_limit(SOME), "poses 4 to 9: joint 'b' at its own limit 2.34568"),
    (exceeds(SOME, "speed", "s"), "poses 4 to 9: 'b' exceeds its speed, 1.235 of 2.346 (rad or m)/s at 7"),
])  # fmt: skip
def test_an_interval_is_said_with_its_points_and_numbers(said, words):
    assert said == words


def test_each_stretch_is_an_event_of_its_kind():
    assert list(events_of("limit", [ONE, SOME], points)) == [
        PathEvent(4, 4, "limit", "pose 4"),
        PathEvent(4, 9, "limit", "poses 4 to 9"),
    ]
