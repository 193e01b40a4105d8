"""A joint is turned for an axis beside its own line only where that has a lever to be turned by."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.analysis.compare.alignment.alignment_seeds import turns
from poekin.model import screw

JOINT = screw.revolute([0, 0, 1], [0.3, 0.1, 0])


@pytest.mark.parametrize("lever, turn", [(1.1e-4, np.pi / 2), (0.9e-4, 0.0), (1e-6, 0.0)])
@pytest.mark.parametrize("far", ["axis", "target"])
def test_parallel_axes_within_a_tenth_of_a_millimetre_of_the_joint_s_line_are_on_it(
    lever, turn, far
):
    # of the two the nearer one counts
    levers = {"axis": lever, "target": lever, far: 0.5}
    axis = screw.revolute([0, 0, 1], [0.3 + levers["axis"], 0.1, 0])
    target = screw.revolute([0, 0, 1], [0.3, 0.1 + levers["target"], 0])
    first, second = turns(JOINT, axis, target)
    assert first == pytest.approx(turn)
    assert np.isnan(second)


@pytest.mark.parametrize("tilt, turned", [(0.021, True), (0.019, False)])
def test_an_axis_within_about_a_degree_of_the_joint_s_direction_is_brought_to_its_place(
    tilt, turned
):
    axis = screw.revolute([np.sin(tilt), 0, np.cos(tilt)], [0.8, 0.1, 0])
    target = screw.revolute([np.sin(tilt), 0, np.cos(tilt)], [0.3, 0.6, 0])
    first, second = turns(JOINT, axis, target)
    # its direction is right as it is, and half a turn reverses that; its place is a quarter turn off
    expected = (0.0, np.pi) if turned else (np.pi / 2, np.nan)
    assert (first, abs(second)) == pytest.approx(expected, abs=0.02, nan_ok=True)
