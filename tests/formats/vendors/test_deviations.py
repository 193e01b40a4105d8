"""Deviations of an arm from another: planted shifts and turns are found, joint by joint."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.formats.vendors.deviations import (
    FAR,
    FAR_ANGLE,
    Deviation,
    deviations,
    origins,
)
from poekin.model.joint import Joint
from poekin.model.robot import Robot

ROBOT = pk.load("ur5e")
NOMINAL = ROBOT.chain()
PLACES = origins(ROBOT, NOMINAL)


def moved(joint: str, T: np.ndarray) -> Robot:
    """The robot with one joint's origin, and all behind it, displaced by T in that joint's frame."""
    joints = [
        Joint(j.name, j.kind, j.parent, j.child, j.origin @ T, j.axis, j.limits)
        if j.name == joint
        else j
        for j in ROBOT.joints
    ]
    return Robot("moved", ROBOT.links, joints)


@settings(max_examples=25)
@given(
    i=st.integers(0, 5),
    across=st.floats(-0.1, 0.1),
    angle=st.floats(-3, 3),
)
def test_a_joint_that_is_planted_elsewhere_is_found_and_none_before_it(i, across, angle):
    name = NOMINAL.joint_names[i]
    c, s = math.cos(angle), math.sin(angle)
    tilt = np.array([[1, 0, 0, across], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
    found = deviations(NOMINAL, moved(name, tilt).chain(), PLACES)
    assert [d.name for d in found] == [*NOMINAL.joint_names, "tool0"]
    assert max(d.position for d in found[:i]) <= 1e-14 if i else True
    # the accuracy stated: rounding of two poses
    assert found[i].position == pytest.approx(abs(across), abs=1e-14)
    assert found[i].angle == pytest.approx(abs(angle), abs=1e-14)


def test_a_shift_along_the_axis_or_about_it_is_seen_in_what_comes_behind():
    along = pk.se3.exp([0, 0, 0, 0, 0, 0.05])
    about = pk.se3.exp([0, 0, 0.2, 0, 0, 0])
    for T, off, turn in ((along, 0.05, 0.0), (about, 0.0, 0.2)):
        *joints, tip = deviations(NOMINAL, moved("wrist_3_joint", T).chain(), PLACES)
        assert max(d.score for d in joints) <= 1e-12
        assert tip.position == pytest.approx(off, abs=1e-14)
        assert tip.angle == pytest.approx(turn, abs=1e-14)


def test_a_prismatic_joint_is_off_by_its_direction_alone():
    def robot(axis, x):
        T = np.eye(4)
        T[0, 3] = x
        slide = Joint("slide", "prismatic", "a", "b", T, axis)
        return Robot("r", ["a", "b"], [slide])

    nominal = robot((0, 0, 1), 0.0)
    chain = nominal.chain()
    tilted = robot((0, math.sin(0.3), math.cos(0.3)), 0.2).chain()
    slide, tip = deviations(chain, tilted, origins(nominal, chain))
    assert (slide.position, slide.name) == (0, "slide")
    assert slide.angle == pytest.approx(0.3, abs=1e-15)
    assert tip.position == pytest.approx(0.2, abs=1e-15)


def test_places_are_in_the_frame_of_the_base():
    chain = ROBOT.chain("upper_arm_link", "tool0")
    found = origins(ROBOT, chain)
    assert found.shape == (4, 3)
    # the forearm begins where the upper arm ends, 425 mm along it
    np.testing.assert_allclose(np.abs(found[0]), [0.425, 0, 0], atol=1e-15)


@pytest.mark.parametrize(
    ("position", "angle", "far"),
    [
        (0.99 * FAR, 0.99 * FAR_ANGLE, False),
        (1.01 * FAR, 0.0, True),
        (0.0, 1.01 * FAR_ANGLE, True),
        (math.nan, 0.0, True),
    ],
)
def test_far_is_more_than_two_centimetres_or_three_degrees(position, angle, far):
    assert Deviation("j", position, angle).far is far


def test_the_bounds_are_two_centimetres_and_three_degrees():
    assert pytest.approx(0.02) == FAR
    assert math.degrees(FAR_ANGLE) == pytest.approx(3)


def test_millimetres_and_degrees_are_said_without_rounding_s_dust():
    assert Deviation("j", 0.0123456, math.radians(1.23456)).summary() == "12.3 mm and 1.23°"
    assert Deviation("j", 1e-16, 1e-17).summary() == "0 mm and 0°"
    assert Deviation("j", 1.5, math.pi).summary() == "1500 mm and 180°"
    assert Deviation("j", 0.9994, 0.0).summary() == "999 mm and 0°"
    assert Deviation("j", 0.9996, 0.0).summary() == "1000 mm and 0°"
    assert Deviation("j", 4e-7, 6e-6).summary() == "0 mm and 0°"
    assert Deviation("j", 6e-7, 0.0).summary() == "0.0006 mm and 0°"
