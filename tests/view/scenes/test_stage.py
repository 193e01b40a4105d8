"""The stage of a result: configurations of a part of a robot, and which of many things are drawn."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.view.scenes.stage import evenly, make_stage, whole_q

ROBOT = pk.load("panda")
PART = ROBOT.chain(base="panda_link2", tip="panda_hand")
Q = PART.random(1)


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3,), (2, 3)])
def test_configurations_of_a_part_are_those_of_its_robot_the_others_as_they_open(shape):
    stage = make_stage(PART, Q, ROBOT)
    q = PART.random(2, size=shape)
    every = stage.configurations(q)
    assert every.shape == (*shape, ROBOT.dof)
    own = [ROBOT.q_names.index(name) for name in PART.q_names]
    np.testing.assert_array_equal(every[..., own], q)
    others = np.setdiff1d(np.arange(ROBOT.dof), own)
    assert len(others) == 3
    np.testing.assert_array_equal(
        every[..., others], np.broadcast_to(stage.scene.q[others], (*shape, 3))
    )


def test_joints_in_front_of_a_part_stay_where_their_limits_leave_them_and_not_at_zero():
    hand = ROBOT.chain(base="panda_link4", tip="panda_hand")
    stage = make_stage(hand, None, ROBOT)
    elbow = ROBOT.limits[3].mean()
    assert elbow < -1.0
    np.testing.assert_array_equal(stage.configurations(hand.random(2, size=3))[:, 3], [elbow] * 3)


def test_a_stage_opens_at_the_configuration_that_is_given_and_stands_on_the_base_of_the_part():
    stage = make_stage(PART, Q, ROBOT)
    assert stage.base == ROBOT.links.index("panda_link2")
    assert stage.sliders == tuple(ROBOT.q_names.index(name) for name in PART.q_names)
    np.testing.assert_array_equal(stage.scene.q[list(stage.sliders)], Q)
    np.testing.assert_array_equal(stage.scene.q, whole_q(ROBOT, PART, Q))
    assert stage.scene.arms[0].tips[0].name == "panda_hand"
    alone = make_stage(PART, Q, None)
    assert (alone.base, alone.sliders) == (0, tuple(range(5)))
    np.testing.assert_array_equal(alone.scene.q, Q)


def test_without_a_configuration_a_robot_is_where_its_limits_leave_it():
    """The fourth joint of the Panda cannot be at zero: its limits end below."""
    lower, upper = ROBOT.limits[3]
    assert upper < 0
    wanted = np.zeros(8)
    wanted[3] = 0.5 * (lower + upper)
    np.testing.assert_array_equal(whole_q(ROBOT, PART, None), wanted)


@pytest.mark.parametrize(
    ("count", "most", "chosen"),
    [
        (0, 5, []),
        (1, 5, [0]),
        (3, 5, [0, 1, 2]),
        (5, 5, [0, 1, 2, 3, 4]),
        (9, 5, [0, 2, 4, 6, 8]),
        (10, 4, [0, 3, 6, 9]),
        (8, 3, [0, 4, 7]),
        (7, 2, [0, 6]),
    ],
)
def test_of_many_things_some_are_chosen_evenly_the_first_and_the_last_among_them(
    count, most, chosen
):
    assert evenly(count, most).tolist() == chosen
    assert evenly(count, most).dtype.kind == "i"
