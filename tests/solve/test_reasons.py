"""Why there is no solution: which limits are in the way."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.model import screw
from poekin.solve.ik import ik


def test_limits_between_which_nothing_stops_the_arm_are_named_by_the_solution_beyond_them():
    # the tip is right opposite to the target, from where each way is as good: it stays, at no limit
    z, x, origin = np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), np.zeros(3)
    axes = [screw.revolute(z, origin), screw.prismatic(z), screw.revolute(x, origin)]
    names, limits = ["turn", "lift", "roll"], [[-1.5, 1.5], [-1, 1], [-np.inf, np.inf]]
    arm = pk.Chain(axes, pk.se3.exp([*origin, *x]), limits=limits, joint_names=names)
    q0 = [0.0, 0.5, 0.2]
    found = ik(arm, arm.fk([np.pi, 0.5, 0.2]), task="position", q0=q0, restarts=0)
    assert found.reason == "limits"
    np.testing.assert_allclose(found.q, q0, rtol=0, atol=1e-9)
    assert found.blocked == (("turn",),)
