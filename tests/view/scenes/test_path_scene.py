"""The scene of a path: the way of the tip, what is marked on it, and the rows that the page plays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.path.joint_path import joint_path
from poekin.view.nodes import Label, Polyline, Triangles
from poekin.view.scenes.path import FRAMES, ROWS, SECONDS, path_scene
from tests.view.narrowed import motion_of

ROBOT = pk.load("panda")
ARM = ROBOT.chain(tip="panda_hand")
LOW, HIGH = ARM.limits.T
START = 0.5 * (LOW + HIGH)
Q = START + np.linspace(0, 0.4, 50)[:, None] * np.ones(7)


def marked(scene):
    return [
        n for n in scene.nodes if n.attachment.role == "marked" and n.attachment.layer == "path"
    ]


def test_the_way_is_that_of_the_tip_and_the_page_plays_the_joints():
    path = joint_path(ARM, Q, 0.1 * np.arange(50.0))
    scene = path_scene(path)
    (way,) = [n for n in scene.nodes if isinstance(n, Polyline) and n.attachment.role == "path"]
    np.testing.assert_allclose(way.points, ARM.fk(Q)[:, :3, 3], atol=1e-15)
    np.testing.assert_array_equal(motion_of(scene).q, Q)
    np.testing.assert_array_equal(motion_of(scene).times, 0.1 * np.arange(50.0))
    np.testing.assert_array_equal(scene.q, Q[0])
    arrows = [
        n for n in scene.nodes if isinstance(n, Triangles) and n.attachment.name.startswith("pose")
    ]
    assert len(arrows) == 3 * FRAMES
    assert "path" in scene.shown


def test_in_its_robot_the_way_hangs_on_the_base_and_other_coordinates_rest():
    scene = path_scene(joint_path(ARM, Q), ROBOT)
    assert scene.arms[0].name == ROBOT.name
    base = ROBOT.links.index(ARM.base)
    assert {n.attachment.link for n in scene.nodes if n.attachment.layer == "path"} == {base}
    assert [s.name for s in scene.arms[0].coordinates] == list(ROBOT.q_names)
    index = [ROBOT.q_names.index(name) for name in ARM.q_names]
    np.testing.assert_array_equal(motion_of(scene).q[:, index], Q)
    rest = np.delete(motion_of(scene).q, index, axis=1)
    assert rest.shape[1] == 1
    assert not rest.any()
    assert (motion_of(scene).times[0], motion_of(scene).times[-1]) == (0.0, SECONDS)


def test_limits_and_singular_stretches_are_marked_where_they_are_with_their_sentences():
    q = Q.copy()
    q[10:21, 0] = HIGH[0]
    q[30:33] = 0.0  # the Panda's elbow is stretched there, which its limits exclude
    path = joint_path(ARM, q)
    scene = path_scene(path)
    assert motion_of(scene).marks == path.events
    assert {"limit", "singular"} <= {m.kind for m in motion_of(scene).marks}
    assert scene.words[0] == path.summary().splitlines()[0]
    assert not {m.text for m in motion_of(scene).marks} & {*scene.words}  # the marks say them
    (limit,) = [n for n in marked(scene) if n.attachment.name.startswith("poses 10 to 20")]
    assert isinstance(limit, Polyline)
    np.testing.assert_allclose(limit.points, ARM.fk(q[10:21])[:, :3, 3], atol=1e-15)


def test_a_change_of_branch_is_a_ball_and_a_label_where_the_tip_is():
    path = replace(joint_path(ARM, Q), branch_switches=(7,))
    scene = path_scene(path)
    ball, label = marked(scene)
    assert isinstance(ball, Triangles)
    assert isinstance(label, Label)
    assert label.text == "branch changes before pose 7"
    place = ARM.fk(Q[7])[:3, 3]
    np.testing.assert_allclose(ball.vertices.mean(axis=0), place, atol=0.002)
    assert [m.kind for m in motion_of(scene).marks] == ["switch"]


def test_a_long_path_is_thinned_and_its_marks_stay_where_they_were():
    count = 5 * ROWS
    q = START + np.linspace(0, 0.4, count)[:, None] * np.ones(7)
    q[6000:6100, 0] = HIGH[0]
    path = replace(joint_path(ARM, q), branch_switches=(4321,))
    motion = motion_of(path_scene(path))
    assert len(motion.q) <= ROWS + 2
    np.testing.assert_array_equal(motion.q[[0, -1]], q[[0, -1]])
    marks = {m.kind: m for m in motion.marks}
    switch = marks["switch"].first
    np.testing.assert_array_equal(motion.q[[switch - 1, switch]], q[[4320, 4321]])
    at_limit = motion.q[marks["limit"].first : marks["limit"].last + 1, 0]
    assert (at_limit == HIGH[0]).all()
    assert len(at_limit) >= 19


def test_poses_of_nan_are_passed_over():
    T = ARM.fk(Q[:20])
    T[5] = np.nan
    path = pk.follow(ARM, T, q0=Q[0])
    scene = path_scene(path)
    assert len(motion_of(scene).q) == 19
    assert np.isfinite(motion_of(scene).q).all()
    assert np.isfinite(motion_of(scene).times).all()
    assert [m.kind for m in motion_of(scene).marks] == ["missed"]
    assert motion_of(scene).times[5] == 6 * SECONDS / 19
    with pytest.raises(InputError, match="at least one finite pose"):
        path_scene(pk.follow(ARM, T[5:6]))


def test_the_way_of_a_part_of_a_robot_hangs_on_the_link_where_the_part_begins():
    part = ROBOT.chain(base="panda_link2", tip="panda_hand")
    scene = path_scene(joint_path(part, Q[:, 2:]), ROBOT)
    links = {n.attachment.link for n in scene.nodes if n.attachment.layer == "path"}
    assert links == {ROBOT.links.index("panda_link2")}


def test_what_is_played_beyond_the_limits_is_reached_by_the_sliders_and_said():
    end = HIGH.copy()
    end[0] += 0.5
    q = np.linspace(START, end, 5)
    scene = path_scene(joint_path(ARM, q))
    assert [x.upper for x in scene.arms[0].coordinates] == end.tolist()
    assert scene.words[-1] == f"What is shown goes beyond the limits of '{ARM.q_names[0]}'."
    assert "beyond" not in " ".join(path_scene(joint_path(ARM, Q)).words)


def test_the_way_is_that_of_the_tip_where_a_target_is_missed_and_frames_are_finite_targets():
    T = ARM.fk(Q[:20])
    T[5] = np.nan
    T[12, 2, 3] += 3.0
    path = pk.follow(ARM, T, q0=Q[0])
    scene = path_scene(path)
    known = np.delete(np.arange(20), 5)
    (way,) = [n for n in scene.nodes if isinstance(n, Polyline) and n.attachment.role == "path"]
    np.testing.assert_allclose(way.points, ARM.fk(path.q[known])[:, :3, 3], atol=1e-15)
    frames = [n for n in scene.nodes if n.attachment.layer == "path" and n.attachment.role == "x"]
    starts = [n.vertices[-2] for n in frames if isinstance(n, Triangles)]
    np.testing.assert_allclose(starts, T[known, :3, 3], atol=1e-12)
