"""Angles typed by hand that look like degrees are warned of, once for each line; nothing else is."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.model.kinematics import degrees
from poekin.model.sampling import radians_per_unit

TURN, SLIDE = [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]
LIMITS = [[-1.0, 2.0], [-1.0, 1.0], [-np.inf, np.inf]]
ARM = pk.Chain.from_space(
    [TURN, SLIDE, TURN], np.eye(4), limits=LIMITS, joint_names=["a", "b", "c"]
)
CURE = "; if these are degrees, np.radians makes radians of them"


def warned(call):
    """Texts of the warnings of a call."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    return [str(w.message) for w in caught if w.category is PoekinWarning]


CALLS = {
    "fk": lambda q: ARM.fk(q),
    "jacobian": lambda q: ARM.jacobian(q, "body"),
    "fk_jacobian": lambda q: ARM.fk_jacobian(q, "body"),
    "joint_poses": lambda q: ARM.joint_poses(q),
    "hessian": lambda q: ARM.hessian(q, "body"),
    "compiled": lambda q: ARM.compile().fk(q),
    "a dict": lambda q: ARM.fk(dict(zip("abc", q, strict=True))),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_degrees_typed_by_hand_are_warned_of(call):
    beyond = f"q: 'a' is more than a turn, and beyond its limits{CURE}"
    assert warned(lambda: call([45, 0, 0])) == [beyond]
    assert warned(lambda: call([0, 0, -90.0])) == [f"q: 'c' is more than two turns{CURE}"]
    assert warned(lambda: call([1.0, 90.0, 12.0])) == []


def test_an_array_is_taken_as_it_is():
    assert warned(lambda: ARM.fk(np.array([45.0, 0, 0]))) == []


@given(st.floats(-6.28, 6.28), st.floats(-1e6, 1e6), st.floats(-12.5, 12.5))
def test_angles_of_less_than_a_turn_and_lengths_are_not(a, b, c):
    assert warned(lambda: ARM.fk([[a, b, c], [np.nan, np.inf, -np.inf]])) == []


def test_wide_limits_and_other_units_are_respected():
    wide = ARM.replace(limits=[[-50.0, 50.0], [-1, 1], [-1, 1]])
    assert warned(lambda: wide.fk([45.0, 0, 0])) == []
    assert warned(lambda: wide.fk([50.0, 0, 0])) == []
    assert warned(lambda: wide.fk([51.0, 0, 0])) != []
    geared = pk.Chain.from_space(
        [TURN], np.eye(4), coupling=[[np.pi / 180]], limits=[[-180, 180]], q_names=["deg"]
    )
    assert warned(lambda: geared.fk([90.0])) == []
    assert warned(lambda: geared.fk([361.0])) != []


def test_a_robots_arrays_are_looked_at_too():
    robot = pk.load("ur5e")
    [said] = warned(lambda: robot.fk(np.full(6, 45.0)))
    assert said.startswith("robot 'ur5e': 'shoulder_pan_joint' is more than a turn, and beyond its")
    slide = pk.Robot("r", ["a", "b"], [pk.Joint("j", "prismatic", "a", "b")])
    assert warned(lambda: slide.fk([45.0])) == []


def test_a_line_is_warned_of_once():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        for angle in (45, 90, 135):
            ARM.fk([angle, 0, 0])
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_what_is_no_angle_is_never_looked_at_closer():
    def never():
        raise AssertionError

    q = np.array([[degrees.TURN, -degrees.TURN]])
    degrees.warn_of_degrees(q, ("a", "b"), np.zeros((2, 2)), never, "q")


@pytest.mark.parametrize("unit", [1.0, np.pi / 180], ids=["rad", "deg"])
def test_a_coordinate_without_limits_may_be_two_turns_in_any_unit(unit):
    arm = pk.Chain.from_space([TURN], np.eye(4), coupling=[[unit]], q_names=["a"])
    two_turns = 4 * np.pi / unit
    assert warned(lambda: arm.fk([(1 - 1e-9) * two_turns])) == []
    assert len(warned(lambda: arm.fk([(1 + 1e-9) * two_turns]))) == 1


def test_of_a_coordinate_radians_are_those_of_the_joint_that_it_moves_most_and_of_a_slide_none():
    geared = ARM.replace(coupling=np.diag([1.0, 1.0, 3.0]))
    np.testing.assert_allclose(radians_per_unit(geared), [1.0, 0.0, 3.0], rtol=1e-15)
