"""Six joints that an arm is part of."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches.closed_arm import PARALLEL, WRIST
from poekin.model.geometry.decomposition.completions import completions
from poekin.model.geometry.decomposition.joints import (
    ADDED,
    Tolerance,
    joints_of,
    meeting_point,
    parallel,
)

NEAR = Tolerance(1e-13, 1e-13)


@pytest.mark.parametrize("name", ["puma560", "ur5", "stanford", "cobra600"])
@pytest.mark.parametrize("first", [0, 1, 2])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6])
def test_every_completion_has_six_joints_and_three_axes_of_its_family(name, first, count):
    joints = joints_of(pk.load(name).chain())[first : first + count]
    for one in completions(joints, 2.0, NEAR):
        assert len(one.joints) == 6
        own = [joint.column for joint in one.joints if joint.column != ADDED]
        assert own == [joint.column for joint in joints]
        lengths = [np.linalg.norm(joint.direction) for joint in one.joints]
        np.testing.assert_allclose(lengths, 1.0, rtol=4 * 2.0**-53)
        three = one.joints[one.first : one.first + 3]
        loose = Tolerance(1e-12, 1e-12)
        if one.family == WRIST:
            assert meeting_point(three, loose) is not None
        else:
            assert one.family == PARALLEL
            assert parallel(three, loose)


def test_words_count_joints_from_one():
    joints = joints_of(pk.load("ur5").chain())
    assert [one.words for one in completions(joints, 2.0, NEAR)] == ["axes 2, 3 and 4 are parallel"]
    words = [one.words for one in completions(joints[:5], 2.0, NEAR)]
    assert words[0] == "axes 2, 3 and 4 are parallel"
    assert "axes 4 and 5 meet" in words
    assert "axes 2 and 3 are parallel" in words


@pytest.mark.parametrize(("first", "ways"), [(3, 1), (2, 6), (1, 4)])
def test_a_wrist_is_completed_by_slides_of_any_directions_and_by_three_in_one_way(first, ways):
    joints = joints_of(pk.load("puma560").chain())[first:]
    found = [one for one in completions(joints, 2.0, NEAR) if "spherical" in one.words]
    assert len(found) == ways
    for one in found:
        added = [joint for joint in one.joints if joint.column == ADDED]
        assert all(joint.slides for joint in added)
        assert np.linalg.matrix_rank([joint.direction for joint in added]) == len(added) == first


@pytest.mark.parametrize("name", ["puma560", "stanford"])
def test_of_one_axis_the_added_ones_meet_on_it_and_it_stays_the_arm_s(name):
    joints = joints_of(pk.load(name).chain())
    for i, joint in enumerate(joints):
        found = [one for one in completions([joint], 2.0, NEAR) if one.words == "a point of axis 1"]
        assert bool(found) == (not joint.slides)
        for one in found:
            own = one.joints[0]
            assert (own.column, own.direction.tolist()) == (i, joint.direction.tolist())
            along = own.point - joint.point
            np.testing.assert_allclose(np.cross(along, joint.direction), 0, atol=1e-15)
            assert 0.2 < np.linalg.norm(along) / 2.0 < 0.8
        assert len({tuple(one.joints[0].point) for one in found}) == len(found)


def test_axes_added_at_the_tip_meet_at_right_angles():
    joints = joints_of(pk.load("ur5").chain())[:2]
    at_tip = [one for one in completions(joints, 2.0, NEAR) if one.words == "a point of the tip"]
    for one in at_tip:
        H = np.array([joint.direction for joint in one.joints[2:5]])
        np.testing.assert_allclose(H @ H.T, np.eye(3), rtol=0, atol=4 * 2.0**-53)
    assert at_tip


@pytest.mark.parametrize("reach", [0.02, 2.0])
def test_an_axis_anywhere_is_half_a_reach_to_a_reach_from_the_arm_s_last(reach):
    joints = joints_of(pk.load("ur5").chain())[1:4]
    distances = [
        np.linalg.norm(joint.point - joints[-1].point) / reach
        for one in completions(joints, reach, NEAR)
        if one.words in ("axes 1, 2 and 3 are parallel", "a point of the tip")
        for joint in one.joints[3:]
        if not joint.slides
    ]
    assert len(distances) > 3
    assert 0.5 < min(distances) <= max(distances) < 1


def test_a_joint_added_between_parallel_axes_is_clear_of_their_plane():
    joints = joints_of(pk.load("ur5").chain())[1:3]
    two = [one for one in completions([*joints], 2.0, NEAR) if one.family == PARALLEL]
    a, b, c = (joint.point for joint in two[0].joints[:3])
    h = joints[0].direction
    sides = [np.cross(h, np.cross(side, h)) for side in (b - a, c - b)]
    assert np.dot(*sides) == pytest.approx(0, abs=1e-15)  # a right angle
