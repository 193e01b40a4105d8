"""Lines along the axes of an arm, by how many there are and whether bodies cover them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.view.nodes import Label, Polyline, Triangles
from poekin.view.scenes.arm_parts.axes import axis_nodes, frame_nodes, label_nodes
from poekin.view.scenes.arm_parts.of_chain import chain_geometry

ARM = chain_geometry(pk.load("stanford").chain())
JOINT = ARM.joints[1]


@pytest.mark.parametrize("covered", [False, True])
@pytest.mark.parametrize(("joints", "share"), [(1, 1), (19, 1), (20, 1), (45, 2 / 3), (80, 0.5)])
def test_a_line_is_four_radii_either_way_and_shorter_by_the_root_of_a_crowd(joints, share, covered):
    """Up to twenty joints; 1.6 times as long where bodies cover it."""
    arm = replace(ARM, joints=(JOINT,) * joints)
    half = 4.0 * 0.25 * share * (1.6 if covered else 1.0)
    line, head, label = axis_nodes(arm, np.full(joints, 0.25), 2.0, covered)[-3:]
    assert isinstance(line, Polyline)
    assert isinstance(head, Triangles)
    assert isinstance(label, Label)
    ends = JOINT.point + half * np.array([[-1.0], [1.0]]) * JOINT.direction
    np.testing.assert_allclose(line.points, ends, atol=1e-15)
    assert line.width == 0.0025 * 2.0
    along = (head.vertices - ends[1]) @ JOINT.direction
    across = np.cross(head.vertices - ends[1], JOINT.direction)
    np.testing.assert_allclose([along.min(), along.max()], [0, 0.5 * 0.25], atol=1e-15)
    assert np.linalg.norm(across, axis=1).max() == pytest.approx(0.15 * 0.25, rel=1e-12)
    np.testing.assert_allclose(label.point, ends[1] + 0.25 * JOINT.direction, atol=1e-15)
    assert (label.text, label.attachment.name) == (f"A{joints}", f"A{joints} {JOINT.name}")


def test_an_arm_without_joints_has_no_lines_and_frames_by_its_size():
    none = replace(ARM, joints=(), frames=ARM.frames[:1])
    assert axis_nodes(none, np.zeros(0), 2.0) == label_nodes(none, np.zeros(0)) == []
    *arrows, label = frame_nodes(none, np.zeros(0), 2.0)
    for axis, arrow in zip(np.eye(3), arrows, strict=True):
        assert isinstance(arrow, Triangles)
        assert (arrow.vertices @ axis).max() == pytest.approx(3.0 * 0.04 * 2.0, rel=1e-12)
    assert isinstance(label, Label)
    np.testing.assert_allclose(label.point, [0.144, 0.144, 0], rtol=1e-12)


def test_the_name_of_a_joint_stands_behind_it():
    (label,) = label_nodes(replace(ARM, joints=(JOINT,)), np.array([0.25]))
    assert isinstance(label, Label)
    np.testing.assert_allclose(label.point, JOINT.point - 0.375 * JOINT.direction, atol=1e-15)
    assert (label.text, label.attachment.link) == (JOINT.name, 1)
