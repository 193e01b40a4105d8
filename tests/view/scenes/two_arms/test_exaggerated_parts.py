"""What an exaggeration is made of: the factor, the motion of an axis, its size, the joints compared."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.view.scenes.two_arms import exaggerated as module

coordinates = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)
ways = coordinates.filter(lambda way: np.linalg.norm(way) > 0.1)


@pytest.mark.parametrize(
    ("largest", "factor"),
    [(0.009, 100), (0.01, 100), (0.0101, 50), (0.1, 10), (0.4, 2), (0.6, 1), (1.0, 1), (7.0, 1)],
)
def test_the_largest_factor_by_which_a_difference_stays_within_a_tenth_of_the_size(largest, factor):
    assert module.visible_factor(largest, 10.0) == factor


def test_the_first_factor_that_fits_is_taken_of_those_that_are_given():
    assert module.visible_factor(0.5, 10.0, (1000.0, 2.0, 1.5)) == 2.0
    assert module.visible_factor(0.5, 10.0, ()) == 1.0


def test_a_difference_is_a_shift_at_the_middle_of_the_arm_and_its_tilt_over_a_tenth_of_the_reach():
    """A turn of 3e-3 rad about z leaves a middle on the axis where it is, and moves one 2 m aside."""
    turn = np.array([0, 0, 3e-3, 0, 0, 0])
    assert module._size(turn, np.array([0.0, 0, 9]), 5.0) == pytest.approx(0.5 * 3e-3)
    assert module._size(turn, np.array([2.0, 0, 9]), 5.0) == pytest.approx(0.5 * 3e-3 + 6e-3)
    back = np.array([0, 0, 3e-3, 0, -6e-3, 0])
    assert module._size(back, np.array([2.0, 0, 9]), 5.0) == pytest.approx(0.5 * 3e-3)


@given(coordinates, ways, coordinates, ways)
@settings(max_examples=25, deadline=None)
def test_the_motion_takes_a_line_to_another_by_the_shortest_way(p, u, r, w):
    """It turns about the common perpendicular, and shifts along it, through the point nearest to p:
    what it moves p by is across the other line, and its turn is as large as the angle between them.
    """
    u, w = u / np.linalg.norm(u), w / np.linalg.norm(w)
    if abs(u @ w) < 1e-3:  # which way is the shortest is no more told
        return
    axes = np.array([pk.screw.revolute(u, p), pk.screw.revolute(w, r)])
    move = module._motion(axes, np.array([False, False]), p)
    other = w * np.sign(u @ w)
    moved = pk.se3.exp(move) @ [*p, 1.0]
    # a line through p and one within a few metres of it, a turn of less than a right angle
    np.testing.assert_allclose(np.cross(moved[:3] - r, w), 0, atol=1e-12)
    np.testing.assert_allclose((moved[:3] - p) @ w, 0, atol=1e-12)
    np.testing.assert_allclose(pk.se3.exp(move)[:3, :3] @ u, other, atol=1e-12)
    assert np.linalg.norm(move[:3]) == pytest.approx(
        np.arctan2(np.linalg.norm(np.cross(u, other)), u @ other), abs=1e-9
    )


@pytest.mark.parametrize("slides", [(True, True), (True, False), (False, True)])
def test_of_a_slide_the_direction_alone_is_moved(slides):
    lean = np.array([np.cos(0.2), np.sin(0.2), 0.0])
    rows = []
    for way, point, slide in (([1.0, 0, 0], [0, 0, 0], slides[0]), (lean, [0, 0, 3.0], slides[1])):
        rows.append(pk.screw.prismatic(way) if slide else pk.screw.revolute(way, point))
    point = np.array([1.0, 2.0, 3.0])
    move = module._motion(np.array(rows), np.array(slides), point)
    np.testing.assert_allclose(move[:3], [0, 0, 0.2], atol=1e-12)
    np.testing.assert_allclose(pk.se3.exp(move) @ [*point, 1.0], [*point, 1.0], atol=1e-12)


@pytest.mark.parametrize("noise", [module.NOISE, 0.5 * module.NOISE])
def test_what_is_rounding_is_no_motion(noise):
    _, size = module._unit(np.array([0, 0, noise, 0, 0, 0]))
    assert size == 0.0
    _, size = module._unit(np.array([0, 0, 0, 0, noise, 0]))
    assert size == 0.0
    screw, size = module._unit(np.array([0, 0, noise, 0.25, 0, 0]))
    assert (screw.tolist(), size) == ([0, 0, 0, 1, 0, 0], 0.25)


def test_what_is_more_than_rounding_has_its_screw_and_size():
    screw, size = module._unit(np.array([0, 0, 0.5, 0, -1.0, 0]))
    np.testing.assert_allclose(screw, [0, 0, 1, 0, -2, 0])
    assert size == 0.5
    assert module._unit(np.array([0, 0, 2 * module.NOISE, 0, 0, 0]))[1] == 2 * module.NOISE


@pytest.mark.parametrize(
    ("unmatched", "rows"),
    [(None, [0, 1, 2]), (("b", "a"), [0, 1, 2]), (("a", "x"), [0, 2]), (("a", "x", "b"), [0])],
)
def test_a_joint_that_is_called_as_the_model_is_compared_unless_it_is_left_out(unmatched, rows):
    found: Any = SimpleNamespace(
        unmatched_joints=unmatched, a=SimpleNamespace(joint_names=("a", "x", "b"))
    )
    assert module.compared_rows(found) == rows
