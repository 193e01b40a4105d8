"""What the nearest arm is made of: its configurations, differences of poses, and changes in words."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.ik_all.nearest.nearest_arm import (
    JointChange,
    NearestArm,
    _changes,
    configurations,
    nearest_arm,
    pose_differences,
)
from poekin.solve.ik_all.structure import Family

# 1 / x, 1 / x^2, ... of the root of x^(m + 1) = x + 1: of the golden ratio and the plastic number
ADDENDS = [(0.6180339887498949,), (0.7548776662466927, 0.5698402909980532)]


@pytest.mark.parametrize("addends", ADDENDS, ids=len)
def test_configurations_are_ninety_six_of_the_sequence_of_the_golden_ratio(addends):
    m = len(addends)
    slides = [pk.screw.prismatic(axis) for axis in np.eye(3)[:m]]
    low, high = np.array([-1.0, 2.0])[:m], np.array([3.0, 2.5])[:m]
    chain = pk.Chain.from_space(slides, np.eye(4), limits=np.stack([low, high], axis=1))
    part = np.array([[(0.5 + k * a) % 1 for a in addends] for k in range(1, 97)])
    np.testing.assert_allclose(configurations(chain), low + (high - low) * part, atol=1e-12)
    turns = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in range(m)],
        np.eye(4),
        limits=np.tile([-0.1, 0.1], (m, 1)),
    )
    np.testing.assert_allclose(configurations(turns), np.pi * (2 * part - 1), atol=1e-12)


def test_angle_and_distance_of_an_axis_are_said_in_degrees_and_millimetres():
    change = JointChange("elbow", np.radians(0.25), 0.0012351)
    assert str(change) == "elbow: turned by 0.25°, moved by 1.24 mm"
    found = NearestArm(
        pk.load("ur5e").chain(),
        Family("parallel", 1, False),
        0.0012351,
        np.radians(0.12345),
        1e-4,
        (change, change),
    )
    assert str(found).split("\n") == ["within 1.24 mm and 0.123°", str(change), str(change)]


@pytest.mark.parametrize("first", [-1, 1, 4])
def test_three_joints_that_do_not_turn_or_are_not_there_are_refused_by_name(first):
    words = (
        f"family: expected three revolute joints from number {first} on, from 0; the chain has "
        "'joint1', 'joint2', 'joint3', 'joint4', 'joint5', 'joint6', which are revolute, revolute, "
        "prismatic, revolute, revolute, revolute"
    )
    stanford = pk.load("stanford").chain()
    chain = stanford.replace(joint_names=[f"joint{k}" for k in range(1, 7)])
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        nearest_arm(chain, Family("meeting", first, False))


def test_an_axis_that_was_turned_and_moved_is_told_by_how_much():
    chain = pk.load("puma560").chain()
    other = chain.replace(
        screws=[
            pk.screw.revolute([0, np.sin(0.3), np.cos(0.3)], [0, 0, 0]),
            *(pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0.3, 0, 0.4])) @ chain.screws[1:].T).T,
        ]
    )
    first, second, *_ = _changes(chain, other)
    assert first.joint == chain.joint_names[0]
    assert first.angle == pytest.approx(0.3)
    w = chain.screws[1, :3]
    moved = np.array([0.3, 0, 0.4])
    assert second.angle == pytest.approx(0.0, abs=1e-12)
    assert second.distance == pytest.approx(np.linalg.norm(moved - (moved @ w) * w))


def test_differences_of_poses_are_rotation_vectors_and_parts_of_the_reach():
    wanted = pk.se3.exp([[0.1, 0.2, -0.3, 1.0, 2.0, 3.0]])
    moved = np.array([[0.4, -0.2, 0.1]])
    T = wanted.copy()
    T[:, :3, :3] = pk.so3.exp([[0.0, 0.5, -0.2]]) @ wanted[:, :3, :3]
    T[:, :3, 3] += moved
    np.testing.assert_allclose(
        pose_differences(T, wanted, 2.0), [[0.0, 0.5, -0.2, 0.2, -0.1, 0.05]], atol=1e-12
    )
