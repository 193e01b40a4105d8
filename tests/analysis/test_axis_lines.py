"""Arms at rest: every joint its own coordinate, zero where q = 0."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.axis_lines import uncoupled_at_zero
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

Z = np.array([0, 0, 1])
TOOL = se3.exp(np.array([0, 0, 0, 0.3, 0.4, 9.0]))


def chain_of(*rows, **data):
    return Chain.from_space(rows, TOOL, **data)


def test_at_rest_every_joint_is_a_coordinate_whose_limits_are_those_that_what_moves_it_leaves():
    rows = [screw.revolute(Z, [k, 0, 0]) for k in range(3)]
    C, c = [[-2.0, 0], [0, 1], [1, 1]], np.array([0.5, 0, -0.25])
    chain = chain_of(*rows, coupling=C, offset=c, q_names=["u", "v"], limits=[[-1, 3], [-1, 2]],
                     joint_names=["one", "two", "three"])  # fmt: skip
    rest = uncoupled_at_zero(chain)
    assert rest.limits.tolist() == [[-6, 2], [-1, 2], [-2, 5]]
    assert (rest.joint_names, rest.base, rest.tip) == (chain.joint_names, chain.base, chain.tip)
    q = np.array([0.3, -0.7])
    assert rest.fk(np.array(C) @ q) == pytest.approx(chain.fk(q), abs=1e-14)
    plain = chain_of(*rows)
    assert uncoupled_at_zero(plain) is plain
    offset = chain_of(*rows, offset=c)
    assert uncoupled_at_zero(offset).fk(np.zeros(3)) == pytest.approx(
        offset.fk(np.zeros(3)), abs=1e-14
    )


def test_at_rest_joints_that_follow_sums_of_readings_have_their_own_limits():
    arm = pk.load("puma560").chain()
    rest = uncoupled_at_zero(arm.coupled("J3 = J2 + J3"))
    np.testing.assert_allclose(rest.limits, arm.limits, rtol=0, atol=1e-14)
    shifted = arm.replace(offset=np.full(6, 0.5)).coupled("J3 = J2 + J3")
    np.testing.assert_allclose(uncoupled_at_zero(shifted).limits, arm.limits, rtol=0, atol=1e-14)
