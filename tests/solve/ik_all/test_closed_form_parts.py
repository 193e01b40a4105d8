"""How much is to spare for an arm that a closed form is not quite of, and when it tells of none."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import closed_arm
from poekin.model.geometry.idealise import Idealised
from poekin.solve.ik_all.closed_form import ClosedForm, _of, closed_form

UR5 = pk.load("ur5").chain()


@pytest.mark.parametrize(("position", "rotation", "off"), [
    (0.0, 0.0, 0.0),
    (0.0, 3e-6, 1.2e-5),
    (1e-6, 3e-7, 4e-5 / UR5.reach),
    (1e-6, 5e-5, 2e-4),
])  # fmt: skip
def test_margins_are_off_by_four_times_the_angle_or_the_distance_by_a_tenth_of_the_reach(
    position, rotation, off
):
    found = _of(Idealised(UR5, position, rotation, ()))
    assert found is not None
    assert found.margin_bound == pytest.approx(off, rel=1e-12)
    assert (found.position_bound, found.rotation_bound) == (position, rotation)
    assert (found.dof, found.is_exact) == (6, not position and not rotation)


@pytest.mark.parametrize(("margin", "least"), [(0.0, -0.01), (0.009, -0.01), (0.02, -0.02)])
def test_a_margin_below_a_hundredth_or_what_it_is_off_tells_that_there_is_no_solution(
    margin, least
):
    closed = closed_form(UR5)
    assert closed is not None
    assert ClosedForm(closed.arm, 6, "X", 0.0, 0.0, margin).none_below == least


@pytest.mark.parametrize(("slides", "tilt", "told"), [
    (0, 0.0, True),
    (0, 1e-13, True),
    (0, 1e-11, False),
    (1, 0.0, False),
])  # fmt: skip
def test_of_slides_and_wrists_without_right_angles_a_margin_does_not_tell(slides, tilt, told):
    closed = closed_form(pk.load("puma560").chain())
    assert closed is not None
    arm = closed.arm.copy()
    assert arm[closed_arm.RULE, closed_arm.FAMILY] == closed_arm.WRIST
    arm[0, closed_arm.SLIDES] = slides
    axes = np.eye(3)[[2, 0, 2]]
    for end in (0, 2):
        tilted = axes.copy()
        tilted[end] += tilt * tilted[1]
        arm[3:6, closed_arm.DIRECTION : closed_arm.DIRECTION + 3] = tilted
        found = ClosedForm(arm, 6, "X", 0.0, 0.0).none_below
        assert found == (-0.01 if told else -np.inf)
