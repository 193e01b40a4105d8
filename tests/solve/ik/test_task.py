"""What a task constrains, and what is said of one that is none."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, PoseError
from poekin.solve.ik.task import TASKS, make_task, targets


@pytest.mark.parametrize("name, weights, expected", [
    ("pose", None, [1] * 6), ("pose", [2, 4, 1, 1, 1, 1], [0.5, 1, 0.25, 0.25, 0.25, 0.25]),
    ("position", [9, 9, 9, 1, 2, 1], [0, 0, 0, 0.5, 1, 0.5]), ("rotation", [1, 2, 4, 9, 9, 9], [0.25, 0.5, 1, 0, 0, 0]),
    ("direction", [1, 1, 1, 2, 2, 2], [0.5, 0.5, 0.5, 1, 1, 1]),
    ("planar", [1, 1, 1, 2, 2, 2], [0.5, 0.5, 0.5, 1, 1, 1]),
])  # fmt: skip
def test_weights_are_scaled_to_1_and_0_where_a_task_takes_no_hold(name, weights, expected):
    task = make_task(name, None, weights)
    assert (task.name, task.weights.tolist(), task.axis.tolist()) == (name, expected, [0, 0, 1])
    assert (task.code, task.constrained_dof, task.part) == TASKS[name]
    assert (
        task.constrained_dof
        == {"pose": 6, "position": 3, "rotation": 3, "direction": 5, "planar": 3}[name]
    )


def test_the_axis_of_a_direction_is_a_unit_vector_however_long_it_is_given():
    for size in (1e-300, 3.0, 1e300):
        np.testing.assert_allclose(
            make_task("direction", [0, 3 * size, -4 * size], None).axis, [0, 0.6, -0.8]
        )


def test_the_jacobian_of_a_direction_has_no_turn_about_it():
    rng = np.random.default_rng(0)
    T, J = pk.se3.exp(rng.normal(size=(3, 6))), rng.normal(size=(3, 6, 4))
    task = make_task("direction", [1, 2, 2], None)
    found = task.jacobian(T, J)
    a = T[:, :3, :3] @ np.array([1, 2, 2]) / 3
    np.testing.assert_allclose(np.einsum("ni,nij->nj", a, found[:, :3]), 0, atol=1e-14)
    across = pk.so3.hat(a)
    np.testing.assert_allclose(across @ found[:, :3], across @ J[:, :3], atol=1e-14)
    np.testing.assert_array_equal(found[:, 3:], J[:, 3:])
    np.testing.assert_array_equal(task.jacobian(T[:, None], J[:, None]), found[:, None])
    np.testing.assert_array_equal(task.jacobian(T[0], J[0]), found[0])
    assert make_task("pose", None, None).jacobian(T, J) is J


def test_the_jacobian_of_the_planar_task_has_the_turn_about_the_normal_and_what_is_across_it():
    rng = np.random.default_rng(0)
    T, J = pk.se3.exp(rng.normal(size=(3, 6))), rng.normal(size=(3, 6, 4))
    n = np.array([2, 3, -6]) / 7
    found = replace(make_task("planar", None, None), axis=n).jacobian(T, J)
    np.testing.assert_allclose(found[:, :3], np.outer(n, n) @ J[:, :3], atol=1e-14)
    np.testing.assert_allclose(found[:, 3:], (np.eye(3) - np.outer(n, n)) @ J[:, 3:], atol=1e-14)


Z = [0, 0, 1.0]
PLANAR = [pk.screw.revolute(Z, [x, 0, 0]) for x in (0.0, 0.5, 0.9, 1.0)]
HOME = pk.se3.exp([0, 0, 0, 1.2, 0, 0])
ARMS = {
    "UR5e": pk.load("ur5e").chain(tip="tool0"),
    "4R": pk.Chain.from_space(PLANAR, HOME),
    "SCARA": pk.Chain.from_space([*PLANAR[:3], pk.screw.prismatic(Z)], HOME),
    "gantry": pk.Chain.from_space([pk.screw.prismatic(way) for way in np.eye(3)], HOME),
}


@pytest.mark.parametrize("arm, ranks", [
    ("UR5e", {"pose": 6, "position": 3, "rotation": 3, "direction": 5}),
    ("4R", {"pose": 3, "position": 2, "rotation": 1, "direction": 2, "planar": 3}),
    ("SCARA", {"pose": 4, "position": 3, "rotation": 1, "direction": 3, "planar": 3}),
    ("gantry", {"pose": 3, "position": 3, "rotation": 0, "direction": 3, "planar": 2}),
])  # fmt: skip
def test_an_arm_serves_as_many_degrees_of_freedom_of_a_task_as_it_has_motions(arm, ranks):
    found = {name: make_task(name, None, None).generic_rank(ARMS[arm]) for name in ranks}
    assert found == ranks


def test_a_locked_coordinate_is_no_motion_and_keeps_its_value():
    task = make_task("position", None, None)
    nan = np.nan
    arm = pk.Chain.from_space(PLANAR[:3], HOME)
    assert task.generic_rank(arm, np.array([nan, 0.0, nan])) == 2
    assert task.generic_rank(arm, np.array([nan, nan, 0.0])) == 2
    assert task.generic_rank(arm, np.array([nan, 0.0, 0.0])) == 1
    # two axes are one where the joint between them is straight
    rotating = make_task("rotation", None, None)
    ball = pk.Chain.from_space(
        [pk.screw.revolute(axis, [0, 0, 0]) for axis in np.eye(3)[[0, 1, 0]]], np.eye(4)
    )
    assert rotating.generic_rank(ball) == 3
    assert rotating.generic_rank(ball, np.array([nan, 0.4, nan])) == 2
    assert rotating.generic_rank(ball, np.array([nan, 0.0, nan])) == 1


@pytest.mark.parametrize("given, words", [
    (("dance", None, None), "task: expected 'pose', 'position', 'rotation', 'direction' or 'planar', got 'dance'"),
    ((3, None, None), "task: expected 'pose', 'position', 'rotation', 'direction' or 'planar', got 3"),
    (("pose", [1, 0, 0], None), "axis: only the task 'direction' has one, the task is 'pose'"),
    (("direction", [0, 0, 0], None), "axis: expected a direction (3,) that is not zero, got [0, 0, 0]"),
    (("direction", [[0, 0, 1]], None), "axis: expected a direction (3,) that is not zero, got [[0, 0, 1]]"),
    (("pose", None, [[1, 1, 1, 1, 1, 1]]),
     "weights: expected six positive numbers (rotation; position), got [[1, 1, 1, 1, 1, 1]]"),
    (("direction", [0, np.nan, 1], None), "axis: expected a direction (3,) that is not zero, got [0, nan, 1]"),
    (("pose", None, [1, 1, 1, 1, 1, 0]),
     "weights: expected six positive numbers (rotation; position), got [1, 1, 1, 1, 1, 0]"),
    (("pose", None, [1, 1, 1, 1, 1, -0.5]),
     "weights: expected six positive numbers (rotation; position), got [1, 1, 1, 1, 1, -0.5]"),
    (("pose", None, [1, 1, 1, 1, 1, np.inf]),
     "weights: expected six positive numbers (rotation; position), got [1, 1, 1, 1, 1, inf]"),
])  # fmt: skip
def test_what_is_no_task_is_told(given, words):
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        make_task(*given)


def test_a_target_that_is_not_finite_is_nan_and_one_that_is_no_pose_is_named():
    T = np.tile(np.eye(4), (3, 1, 1))
    T[1, 0, 0] = np.inf
    found = targets(T, "T")
    np.testing.assert_array_equal(np.isnan(found).all((1, 2)), [False, True, False])
    np.testing.assert_array_equal(found[2], np.eye(4))
    assert np.isinf(T[1, 0, 0])
    T[2] *= 2
    with pytest.raises(PoseError, match=r"T\[2\] is no pose"):
        targets(T, "T")
