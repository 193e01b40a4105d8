"""What joints to spare are for: only coordinates with both limits have a middle, and steps too long are shortened."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.solve.ik import ik


def test_only_a_coordinate_with_two_limits_has_a_middle():
    # two slides along one line: what the first gives up the second takes over, which has no middle to be drawn to
    limits, q0 = [[-1, 1], [0, np.inf], [-1, 1], [-1, 1]], [1.0, 1.0, 0.5, 0.5]
    arm = pk.Chain([screw.prismatic(way) for way in np.eye(3)[[0, 0, 1, 2]]], np.eye(4), limits=limits)
    found = ik(arm, arm.fk(q0), task="position", q0=q0, aim="middle")
    # the slides share each step, of half of the way: of 25 of them 0.75^25 = 7.5e-4 is left
    np.testing.assert_allclose(found.q, [0, 2, 0.5, 0.5], rtol=0, atol=1e-3)


@pytest.mark.parametrize("length", [1.0, 2.0])
def test_a_step_that_is_too_long_is_made_shorter(length):
    # a table that slides far to the side: what brings the slides back turns the tip about a circle
    axes = [*map(screw.prismatic, np.eye(3)), screw.revolute([0, 0, 1.0], [0, 0, 0])]
    arm = pk.Chain(axes, pk.se3.exp([0, 0, 0, length, 0, 0]))
    found = ik(arm, arm.fk([0, 10.0, 0, 0]), task="position", q0=np.zeros(4), aim="nearest")
    assert found.success
    spare = np.linalg.svd(arm.jacobian(found.q, "hybrid")[3:])[2][-1]  # the one motion that leaves the tip
    assert abs(spare @ found.q) <= 1e-3  # the distance to 0 does not change along it: no solution nearby is nearer
