"""Frames of single joints that are put on a new axis: where a pitch is locked, and which way an axis points."""

from __future__ import annotations

import math

import numpy as np
import pytest

import poekin as pk
from poekin.formats.relink import branch
from poekin.formats.relink.branch import JointAxis
from poekin.groups import se3
from poekin.model.joint import Joint

TILT = se3.exp([0.01, 0.02, 0, 0, 0, 0])


def pitched(cosine):
    """A joint whose origin has a pitch of this cosine."""
    s = math.sqrt(1 - cosine**2)
    R = [[cosine, 0, s], [0, 1, 0], [-s, 0, cosine]]
    return Joint("j", "revolute", "a", "b", se3.pose(np.array(R, float), [1, 2, 3]), (0, 0, 1))


@pytest.mark.parametrize(
    ("cosine", "alike"), [(0.0, "axes"), (0.0499, "axes"), (0.05, "frames"), (0.0501, "frames")]
)
def test_the_axis_turns_in_place_of_the_frame_below_a_cosine_of_a_twentieth(cosine, alike):
    joint = pitched(cosine)
    axis = JointAxis(TILT[:3, :3] @ joint.origin[:3, 2], np.array([1.0, 2.0, 2.5]), 0.0)
    found = {
        turn: branch._moved(joint, axis, joint.origin, np.eye(4), turn)
        for turn in ("auto", "frames", "axes")
    }
    assert np.abs(found["frames"][1] - found["axes"][1]).max() > 1e-3
    np.testing.assert_array_equal(found["auto"][1], found[alike][1])
    assert found["auto"][0].axis == found[alike][0].axis


@pytest.mark.parametrize("sign", [1, -1])
def test_an_axis_points_as_the_new_one_and_the_origin_is_its_nearest_point(sign):
    joint = pitched(0.6)
    w = sign * (TILT[:3, :3] @ joint.origin[:3, 2])
    foot = np.array([1.0, 2.0, 2.5])
    moved, G = branch._moved(joint, JointAxis(w, foot, 0.0), joint.origin, np.eye(4), "frames")
    assert moved.axis == (0, 0, sign)
    # some ten roundings of numbers up to 3
    np.testing.assert_allclose(G[:3, :3] @ moved.axis, w, rtol=0, atol=4e-15)
    offset = joint.origin[:3, 3] - G[:3, 3]
    assert abs(offset @ w) <= 4e-15
    np.testing.assert_allclose(np.cross(G[:3, 3] - foot, w), 0, atol=4e-15)


def test_axes_are_directions_feet_and_pitches():
    chain = pk.Chain.from_space(
        [
            pk.screw.revolute([0, 0, 1], [2, 3, 7]),
            pk.screw.helical([1, 0, 0], [5, 0.5, 4], 0.25),
            pk.screw.prismatic([0, 0.6, 0.8]),
        ],
        np.eye(4),
    )
    turn, wind, slide = branch._axes(chain)
    np.testing.assert_allclose(turn.direction, [0, 0, 1])
    feet = np.array([turn.foot, wind.foot])
    np.testing.assert_allclose(feet, [[2, 3, 0], [0, 0.5, 4]])
    assert (turn.pitch, slide.foot, slide.pitch) == (0.0, None, 0.0)
    assert wind.pitch == pytest.approx(0.25, abs=1e-15)
    np.testing.assert_allclose(slide.direction, [0, 0.6, 0.8])


def test_a_tip_is_off_its_axis_by_an_angle_or_by_a_share_of_the_reach():
    screws = [pk.screw.revolute([0, 1, 0], [0, 0, 0]), pk.screw.revolute([0, 0, 1], [2, 0, 0])]
    aside = pk.Chain.from_space(screws, se3.exp([0, 0, 0, 2, 0.5, 3]))
    assert branch.tip_off_axis(aside, (0, 0, 1)) == pytest.approx(0.5 / aside.reach, rel=1e-15)
    turned = pk.Chain.from_space(screws, se3.pose(pk.so3.exp([0.1, 0, 0]), [2, 0, 3]))
    assert branch.tip_off_axis(turned, (0, 0, 1)) == pytest.approx(math.sin(0.1), rel=1e-14)
    slide = pk.Chain.from_space([screws[0], pk.screw.prismatic([0, 0, 1])], aside.home)
    assert branch.tip_off_axis(slide, (0, 0, 1)) == 0


def test_an_axis_at_a_right_angle_to_the_new_one_keeps_its_sign():
    axis = JointAxis(np.array([1.0, 0.0, 0.0]), None, 0.0)
    joint = branch._pointing(pitched(1.0), axis, np.eye(4))
    assert joint.axis == (0, 0, 1)


def test_all_fixed_joints_behind_the_last_moving_one_lead_to_the_chain_s_tip_together():
    chain = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], TILT)
    joints = [Joint("j", "revolute", "a", "l0", np.eye(4), (0, 0, 1))]
    for k in range(3):
        step = se3.exp(np.roll([0.5, 0, 0, 0.25, 0, 0], k))
        joints.append(Joint(f"f{k}", "fixed", f"l{k}", f"l{k + 1}", step))
    found = branch.branch_of(joints, chain, "auto").joints
    np.testing.assert_array_equal([j.origin for j in found[2:]], [j.origin for j in joints[2:]])
    tip = np.linalg.multi_dot([joint.origin for joint in found])
    np.testing.assert_allclose(tip, TILT, rtol=0, atol=2e-15)
