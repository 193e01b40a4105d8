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


def test_a_joint_added_between_parallel_axes_is_clear_of_their_plane():
    joints = joints_of(pk.load("ur5").chain())[1:3]
    two = [one for one in completions([*joints], 2.0, NEAR) if one.family == PARALLEL]
    a, b, c = (joint.point for joint in two[0].joints[:3])
    h = joints[0].direction
    sides = [np.cross(h, np.cross(side, h)) for side in (b - a, c - b)]
    assert np.dot(*sides) == pytest.approx(0, abs=1e-15)  # a right angle
