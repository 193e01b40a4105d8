"""The condition of an arm of which a joint is locked, where that joint is."""

from __future__ import annotations

import numpy as np

import poekin as pk


def test_what_a_locked_joint_s_value_makes_singular_counts_at_that_value():
    # the wrist is straight where joint 5 is at 0, and bent at 1 rad
    arm = pk.load("puma560").chain()
    ends = [0.1, -0.7, 0.5, 0.3, 1.0, 0.2], [0.15, -0.65, 0.55, 0.35, 1.0, 0.25]
    q = np.linspace(*ends, 4)
    path = pk.follow(arm, arm.fk(q), q0=q[0], lock={"joint5": 1.0})
    J = arm.jacobian(path.q, frame="hybrid")[:, :, [0, 1, 2, 3, 5]]
    J[:, 3:] /= arm.reach
    sizes = np.linalg.svd(J, compute_uv=False)
    np.testing.assert_allclose(path.inverse_condition, sizes[:, 4] / sizes[:, 0], rtol=1e-6)
