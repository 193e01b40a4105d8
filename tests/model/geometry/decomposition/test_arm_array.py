"""The array of an arm: which joint is where, and what is turned with the target."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import closed_arm
from poekin.groups import se3
from poekin.model.geometry.decomposition.arm_array import arm_array
from poekin.model.geometry.decomposition.completions import completions
from poekin.model.geometry.decomposition.joints import Tolerance, joints_of
from tests.solve.ik_all import closed_form_arms as arms


@pytest.mark.parametrize("first", [0, 1, 2, 3])
@pytest.mark.parametrize(("group", "place"), [("wrist", 3), ("parallel", 1)])
def test_the_three_axes_stand_where_their_family_has_them(group, place, first):
    chain = arms.arm(7, group, first, "RRR")
    (one,) = completions(joints_of(chain), chain.reach, Tolerance(1e-12, 1e-12))
    arm = arm_array(one, chain.home)
    assert arm.shape == closed_arm.SHAPE
    columns = arm[:6, closed_arm.COLUMN]
    assert columns[place : place + 3].tolist() == [first, first + 1, first + 2]
    turned = int(arm[closed_arm.RULE, closed_arm.TURNED])
    # the last ones are the first of the arm, in order
    assert columns.tolist() == [*range(turned, 6), *range(turned)]
    across = arm[closed_arm.RULE, closed_arm.ACROSS : closed_arm.ACROSS + 3]
    named = arm[5 if group == "wrist" else 1, :3]
    assert abs(across @ named) < 1e-15
    home = np.vstack([arm[closed_arm.HOME : closed_arm.HOME + 3, :4], [0, 0, 0, 1]])
    np.testing.assert_allclose(home @ chain.home, np.eye(4), atol=1e-15)
    assert arm[closed_arm.RULE, closed_arm.ADDED] == 0


def test_what_is_across_parallel_axes_is_across_the_first_to_the_last_digit():
    chain = arms.arm(7, "parallel", 0, "RRR")
    screws = chain.screws.copy()
    # the second of the three leans by a hundredth of what still counts as parallel
    screws[1] = se3.adjoint(se3.exp([1e-10, 2e-10, 3e-10, 0, 0, 0])) @ screws[1]
    leaning = chain.replace(screws=screws)
    (one,) = completions(joints_of(leaning), chain.reach, Tolerance(1e-8, 1e-8))
    arm = arm_array(one, chain.home)
    across = arm[closed_arm.RULE, closed_arm.ACROSS : closed_arm.ACROSS + 3]
    assert arm[closed_arm.RULE, closed_arm.FAMILY] == closed_arm.PARALLEL
    assert abs(across @ arm[1, :3]) < 1e-15 < abs(across @ arm[2, :3])


def test_joints_that_are_added_have_no_column():
    chain = pk.Chain.from_space(pk.load("ur5").chain().screws[:2], np.eye(4))
    one = next(completions(joints_of(chain), 1.0, Tolerance(1e-12, 1e-12)))
    arm = arm_array(one, chain.home)
    assert sorted(arm[:6, closed_arm.COLUMN]) == [-1, -1, -1, -1, 0, 1]
    assert arm[closed_arm.RULE, closed_arm.ADDED] == 4
