"""A path of given configurations says what is hard on it, as one that was followed."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve.path.joint_path import joint_path

ARM = pk.load("panda").chain(tip="panda_hand")


def test_a_path_that_was_followed_has_the_same_events_again():
    T_s0 = ARM.fk([0, -0.5, 0, -2.0, 0, 1.6, 0.8])
    T = pk.motion.line(T_s0, T_s0 @ pk.se3.exp([0, 0, 0.5, 0.1, 0, 0.1]), np.linspace(0, 1, 30))
    times = np.linspace(0, 0.05, 30)
    followed = pk.follow(ARM, T, times=times, speed=ARM.velocity_limits)
    again = joint_path(ARM, followed.q, times)
    assert followed.events
    assert again.events == followed.events
    assert again.summary().splitlines()[1:] == followed.summary().splitlines()[1:]
    np.testing.assert_array_equal(again.solution.target, ARM.fk(followed.q))


def test_without_times_there_are_no_rates():
    path = joint_path(ARM, np.zeros((3, 7)))
    assert path.rates is None
    assert not path.speed_violations
    assert path.ok
    assert not path.branch_switches


@pytest.mark.parametrize(("q", "words"), [
    (np.zeros(7), "q: expected configurations (N, 7), got shape (7,)"),
    (np.zeros((0, 7)), "q: expected configurations (N, 7), got shape (0, 7)"),
    (np.zeros((1, 2, 7)), "q: expected configurations (N, 7), got shape (1, 2, 7)"),
    (np.zeros((2, 5)), "q: expected 7 coordinates"),
])  # fmt: skip
def test_what_is_no_list_of_configurations_is_refused(q, words):
    with pytest.raises(ShapeError, match=re.escape(words)):
        joint_path(ARM, q)


def test_joints_at_limits_of_their_own_are_said():
    arm = pk.load("ur5").chain()
    coupling = np.eye(6) - np.eye(6, k=-1)
    own = np.tile([-1.0, 1.0], (6, 1))
    coupled = arm.replace(coupling=coupling, q_names=list("abcdef"), limits=None, joint_limits=own)
    path = joint_path(coupled, np.array([np.zeros(6), [0.0, 1.0, 1.0, 1.0, 1.0, 1.0]]))
    (found,) = path.joints_at_limits
    assert (found.name, found.first, found.bound) == (arm.joint_names[1], 1, 1.0)


def test_a_row_that_is_no_configuration_is_a_pose_that_is_not_reached():
    q = np.zeros((3, 7))
    q[1, 2] = np.nan
    path = joint_path(ARM, q)
    assert path.solution.success.tolist() == [True, False, True]
    assert path.summary().startswith("2 of 3 poses reached")
    assert "bad target" in path.summary()


@pytest.mark.parametrize("times", [[0, 2, 1], [0, np.nan, 1], [0, 1, np.inf]])
def test_times_that_run_backwards_or_are_not_finite_are_refused(times):
    with pytest.raises(
        InputError, match=r"^times: expected finite seconds, none before the one above it$"
    ):
        joint_path(ARM, np.zeros((3, 7)), np.array(times))
    assert len(joint_path(ARM, np.zeros((3, 7)), np.array([0.0, 1.0, 1.0])).q) == 3


@pytest.mark.filterwarnings("error")
def test_two_configurations_at_one_time_are_no_cause_of_a_warning_of_numpy():
    q = np.array([0.0, 0.1, 0.1, 0.3])[:, None] * np.ones(7)
    path = joint_path(ARM, q, np.array([0.0, 1.0, 1.0, 1.0]))
    assert path.rates is not None
    np.testing.assert_allclose(path.rates[:, 0], [0.1, np.nan, np.inf])
    assert path.summary()
