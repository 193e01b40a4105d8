"""Descent to the least error: downhill, within bounds, and exact where rotation is traded too."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.model import screw
from poekin.solve.ik.ik_problem import Settings, make_problem
from poekin.solve.ik.least_error import least_error, slope_at

SETTINGS = Settings("pose", None, True, 1e-9, 1e-9, None, None, 100, 30, 0, False)
ARM = pk.Chain.from_space(
    [screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1)], se3.exp([0, 0, 0, 1.7, 0, 0])
).compile()
WRIST = pk.Chain.from_space(
    [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute([0.6, 0.8, 0], [0, 0, 0.3])],
    se3.exp([0.3, -0.4, 0.2, 0.7, 0.1, 0.2]),
).compile()
FREE = np.full(2, -np.inf), np.full(2, np.inf)


def bowl(q):
    """|q - (1, 2)|^2."""
    off = np.array([1.0, 2.0]) - q
    return float(off @ off), np.eye(2), off


def test_the_bottom_is_found_and_bounds_hold():
    np.testing.assert_allclose(least_error(bowl, np.zeros(2), *FREE), [1, 2], atol=1e-9)
    q = least_error(bowl, np.zeros(2), FREE[0], np.array([0.25, 9.0]))
    np.testing.assert_allclose(q, [0.25, 2], atol=1e-9)


def test_no_step_is_taken_uphill():
    asked = []

    def wrong(q):
        asked.append(q)
        size, H, g = bowl(q)
        return size, H, -g

    assert least_error(wrong, np.zeros(2), *FREE).tolist() == [0, 0]
    assert len(asked) == 31


UNEQUAL = (0.2, 1.0, 3.0, 0.5, 1.0, 2.0)


@pytest.mark.parametrize("weights", [None, UNEQUAL])
@pytest.mark.parametrize("task", ["pose", "position", "rotation", "direction", "planar"])
def test_half_the_slope_of_the_error_is_that_of_differences_far_from_the_target_too(task, weights):
    arm = ARM if task == "planar" else WRIST
    problem = make_problem(arm, SETTINGS._replace(task=task, weights=weights))
    target = se3.exp([0.9, -0.8, 1.1, 0.5, 0.7, 0.3])
    q = np.array([0.4, 0.9])
    size, H, g = slope_at(problem, target, q)
    h = 1e-5  # where rounding and the third derivative are both below 1e-9 of the slope
    differences = [
        slope_at(problem, target, q + h * e)[0] - slope_at(problem, target, q - h * e)[0]
        for e in np.eye(2)
    ]
    np.testing.assert_allclose(g, np.array(differences) / (-4 * h), rtol=1e-8)
    np.testing.assert_allclose(H, H.T)
    assert size > 0


def test_damping_is_a_fifth_after_a_step_downhill_and_five_times_after_another():
    down, up = [], []

    def asked_downhill(q):
        down.append(q)
        return bowl(q)

    def asked_uphill(q):
        up.append(q)
        size, H, g = bowl(q)
        return size, H, -g

    least_error(asked_downhill, np.zeros(2), *FREE)
    # what is left of the way after each step, by hand: d / (1 + d) of it
    left = [1.0, 1e-3 / 1.001, 1e-3 / 1.001 * 2e-4 / 1.0002]
    for q, share in zip(down, left, strict=False):
        np.testing.assert_allclose(q, (1 - share) * np.array([1.0, 2.0]), rtol=1e-12)
    least_error(asked_uphill, np.zeros(2), *FREE)
    for q, damping in zip(up[1:], [1e-3, 5e-3, 25e-3, 0.125, 0.625], strict=False):
        np.testing.assert_allclose(q, -np.array([1.0, 2.0]) / (1 + damping), rtol=1e-12)


def test_the_descent_ends_with_the_step_that_gains_next_to_nothing():
    asked = []

    def above_one(q):
        asked.append(q)
        size, H, g = bowl(q)
        return 1.0 + size, H, g

    least_error(above_one, np.zeros(2), *FREE)
    # gains of 5, then of 5e-6, then of 2e-13
    assert len(asked) == 1 + 3


def test_a_slope_of_two_joints_that_do_the_same_is_gone_down_by_both_alike():
    """The matrix is singular, and steps are so small that the damping comes to its least."""

    def trough(q):
        off = 1.0 - q.sum()
        return float(off**2), np.ones((2, 2)), np.full(2, 0.1 * off)

    q = least_error(trough, np.zeros(2), *FREE)
    np.testing.assert_allclose(q, 0.5 * (1 - 0.9**30), rtol=1e-4)


@pytest.mark.parametrize("idle", [0, 1])
def test_a_joint_that_moves_nothing_is_damped_as_much_as_the_joint_that_does(idle):
    """A descent of rounding, 1e-20, does not turn it: 30 steps of at most 1e-20 / 1e-13."""
    moving = 1 - idle

    def level(q):
        off = 1.0 - q[moving]
        H, g = np.zeros((2, 2)), np.full(2, 1e-20)
        H[moving, moving], g[moving] = 1.0, 0.1 * off
        return float(off**2), H, g

    q = least_error(level, np.zeros(2), *FREE)
    np.testing.assert_allclose(q[moving], 1 - 0.9**30, rtol=1e-4)
    assert 0 <= q[idle] <= 30 * 1e-7
