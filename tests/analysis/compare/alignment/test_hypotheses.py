"""Which of two readings of the differences between two models is the likelier one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from benchmarks.planted_changes import planted, random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.hypotheses import Hypothesis, as_they_stand, turn_about
from poekin.groups import se3
from poekin.model import screw


def reading(
    axes: int = 0,
    zeros: int = 0,
    reversed_: int = 0,
    frames: int = 0,
    link: int = 0,
    miss: Any = 16.0,
    joints: int = 12,
) -> Hypothesis:
    """A reading in which joints 1, 2 ... have another axis, those after them other zeros, the
    last ones reversed.
    """
    n = joints
    at = np.arange(n)
    moved, offset = at < axes, (at >= axes) & (at < axes + zeros)
    directions = np.where(at >= n - reversed_, -1.0, 1.0)
    deviations = np.where(moved, miss, 0.5)
    pose = np.eye(4)
    return Hypothesis(
        pose,
        pose,
        np.zeros(n),
        directions,
        moved,
        offset,
        np.zeros((n, 6)),
        deviations,
        frames,
        link,
    )


def cost(**differs: Any) -> float:
    """Of a reading in which so much differs."""
    return reading(**differs).cost[0]


def test_one_change_comes_first_whatever_it_is():
    ones = [cost(axes=1), cost(zeros=1), cost(reversed_=1)]
    assert max(ones) < min(
        cost(zeros=2),
        cost(zeros=1, reversed_=1),
        cost(axes=1, zeros=1),
        cost(axes=2),
        cost(axes=3, link=3),
    )


def test_where_base_and_tool_moved_other_zeros_alone_come_before_a_moved_axis():
    for count in range(2, 7):
        assert cost(axes=1) < cost(zeros=count) < cost(axes=1, frames=2)
        assert cost(zeros=count) == cost(reversed_=count) == cost(zeros=count, frames=2)
        assert cost(zeros=count) < cost(zeros=count + 1) - 0.2
    assert cost(axes=1, frames=2) < cost(zeros=7)
    # what differs in one joint by zero and direction is one convention of it
    assert cost(zeros=12, reversed_=12) == cost(zeros=12)


def test_one_joint_that_differs_in_zero_and_direction_costs_as_much_as_one_change():
    # So no other conventions are looked for beside it, and base and tool that stay decide.
    assert cost(zeros=1, reversed_=1, joints=1) == cost(zeros=1) == cost(axes=1)


@pytest.mark.parametrize("zeros", [1, 2, 3])
def test_another_link_is_likelier_than_an_axis_that_zeros_help_and_less_so_than_an_axis_alone(
    zeros,
):
    link = cost(zeros=2, link=2) - (1.0 + 2.5)
    assert cost(axes=1, frames=2) < link < cost(axes=1, zeros=zeros)


def test_beside_another_link_each_difference_counts_and_axes_behind_it_do_not():
    alone = cost(axes=2, link=1) - (3 + 2)
    assert cost(axes=3, link=1) == cost(axes=12, link=1) == cost(axes=2, link=1)
    assert cost(axes=2, zeros=1, link=1) - cost(axes=2, link=1) == 1.0
    assert cost(axes=2, zeros=3, link=1) - cost(axes=2, zeros=1, link=1) == 5.0
    # An axis in front counts as one of several: 3, and the fourth root of 16 tolerances
    assert cost(axes=3, link=2) - cost(axes=3, link=1) == 5.0
    # Three zeros and an axis are dearer than a zero and a link of parallel axes
    assert alone + 1.0 < cost(axes=1, zeros=3)


def test_of_several_moved_axes_it_counts_how_far_they_are():
    # the fourth root of each in tolerances; of a single one a twentieth of it
    assert cost(axes=2, miss=81.0) - cost(axes=2, miss=16.0) == pytest.approx(2 * (3 - 2))
    assert cost(axes=1, zeros=1, miss=81.0) - cost(axes=1, zeros=1, miss=16.0) == pytest.approx(
        0.05
    )
    assert cost(axes=3) - cost(axes=2) == pytest.approx(3 + 2)
    assert cost(axes=2, zeros=1) - cost(axes=2) == pytest.approx(2.5)
    assert cost(axes=2, zeros=2) - cost(axes=2) == pytest.approx(3.5)


@pytest.mark.parametrize("tolerance, most", [(1e-5, 100.0), (1e-14, 1e9)])
def test_an_axis_is_no_more_than_a_thousand_million_tolerances_off(tolerance, most):
    chain = random_arm(3, ("revolute",) * 3)
    other = planted(chain, "shift", 1, np.random.default_rng(0))  # by 1 mm
    found = as_they_stand(chain, other, Tolerances(tolerance, tolerance))
    assert found.deviations[1] == pytest.approx(most, rel=1e-10)


def test_a_frame_that_moved_counts_beside_several_axes_or_a_link_and_no_other_reading():
    for frames in (1, 2):
        for differs in ({"axes": 2}, {"axes": 3, "zeros": 1}, {"axes": 4, "link": 2}):
            assert cost(**differs, frames=frames) - cost(**differs) == pytest.approx(1.4 * frames)
        for differs in ({}, {"axes": 1, "zeros": 1}, {"zeros": 3}, {"axes": 0, "reversed_": 2}):
            assert cost(**differs, frames=frames) == cost(**differs)


def test_several_changes_are_weighed_to_two_digits():
    two = cost(axes=2)
    # The fourth roots make 4.002, and so 4.00.
    assert cost(axes=2, miss=2.001**4) == two
    assert cost(axes=2, miss=2.004**4) - two == pytest.approx(0.01)
    assert cost(axes=1, zeros=1, miss=2.01**4) == cost(axes=1, zeros=1)


def test_nothing_that_differs_costs_nothing_and_one_joint_2_5_or_4_9_in_frames_that_moved():
    assert cost() == cost(frames=2) == 0
    for one in ({"axes": 1}, {"zeros": 1}, {"reversed_": 1}):
        assert [cost(**one, frames=frames) for frames in (0, 1)] == [2.5, 2.5]
    assert cost(axes=1, frames=2) == 4.9
    assert cost(zeros=1, frames=2) == 2.5


def test_joints_of_other_conventions_cost_three_and_a_quarter_and_a_quarter_each_beyond_two():
    found = [cost(zeros=k) for k in range(8)]
    assert found == [0, 2.5, 3.5, 4.0, 4.25, 4.5, 4.75, 5.0]


def test_of_readings_that_cost_the_same_frames_that_stay_then_few_changes_then_near_axes_decide():
    def order(**differs):
        return reading(**differs).cost

    assert order(zeros=2)[1:3] == (0, 2)
    assert order(zeros=2, frames=2)[1:3] == (2, 2)
    assert order(axes=1)[1:3] == (0, 1)
    assert order(zeros=1)[1:3] == (0, 0)
    # Half a tolerance of each of twelve axes, and of the two that moved no more than ten.
    for miss, near in ((4.0, 4.0), (16.0, 10.0), (1e9, 10.0)):
        assert order(axes=2, miss=miss)[3] == pytest.approx(10 * 0.5 + 2 * near)
        assert order(axes=1, miss=miss)[3] == pytest.approx(11 * 0.5 + near)
        assert order(axes=3, link=2, miss=miss)[2:] == (3, pytest.approx(9 * 0.5 + 3 * near))


@pytest.mark.parametrize(
    "S",
    [screw.revolute([1, 2, 2], [0.3, 0, 0.1]), screw.prismatic([2, 0.5, 1])],
    ids=["turn", "slide"],
)
@pytest.mark.parametrize("z", [0.3, -1.2, np.pi, 0.0])
def test_a_motion_of_one_joint_is_told_by_its_position_and_another_motion_by_none(S, z):
    tol = Tolerances(1e-9, 1e-9)
    T = se3.exp(S * z)
    found = turn_about(T, S, tol)
    assert found is not None
    # half a turn is one either way
    np.testing.assert_allclose(se3.exp(S * found), T, atol=1e-12)
    assert abs(found) == pytest.approx(abs(z), abs=1e-12)
    assert turn_about(T @ se3.exp([0, 0, 0, 0, 1e-8, 0]), S, tol) is None
