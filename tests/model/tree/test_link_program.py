"""Program of a robot's links: the definition of their poses, with every kind of joint and readings."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.engine.straight_line.interpret import evaluate
from poekin.model.joint import FREE
from tests.model.test_robot import (
    MOVING,
    PLANTED,
    naive_poses,
    random_q,
    robots,
    rounding,
    size,
    two_arms,
)


def errors(robot: pk.Robot, subject: pk.Robot, seed: int) -> float:
    """How far the subject's program is from the definition for the robot, in what rounding and
    constants taken for 0 and ±1 leave, lengths in `size`.
    """
    q = random_q(robot, seed, 3)
    columns = [q.get(name, np.zeros(3)) for name in subject.q_names]
    found = evaluate(subject.program(), np.reshape(columns, (subject.dof, 3)).T)
    poses = naive_poses(robot, q)
    wanted = [np.broadcast_to(poses[link], (3, 4, 4))[:, :3] for link in robot.links]
    rows = found.reshape(3, -1, 12)
    apart = np.concatenate(
        [
            np.abs(rows[..., :9].reshape(3, -1, 3, 3) - np.stack(wanted, 1)[..., :3]),
            np.abs(rows[..., 9:, None] - np.stack(wanted, 1)[..., 3:]),
        ],
        axis=-1,
    )
    folds = 32 * 2.0**-53 * (len(robot.joints) + 1)
    return float((apart.max(axis=(1, 2, 3)) / size(robot) / (rounding(robot, q) + folds)).max())


@given(robot=robots((*MOVING, *FREE, "fixed")), seed=st.integers(0, 2**32 - 1))
def test_poses_are_those_of_the_definition(robot, seed):
    assert errors(robot, robot, seed) <= 1


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_error_is_seen(name):
    assert errors(two_arms(), PLANTED[name], 0) > 1e5


def test_readings_move_all_joints_that_follow_them():
    robot = two_arms()
    coupled = robot.coupled("r = 2 r - 0.5 h")
    r = np.random.default_rng(0).uniform(-2, 2, (4, robot.dof))
    q = r.copy()
    at = robot.q_names.index
    q[:, at("r")] = 2 * r[:, at("r")] - 0.5 * r[:, at("h")]
    np.testing.assert_allclose(
        evaluate(coupled.program(), r), evaluate(robot.program(), q), rtol=0, atol=1e-14
    )
