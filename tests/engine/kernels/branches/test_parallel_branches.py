"""Branches of three parallel axes, uncompiled: the configuration is among them, and where it is lost."""

from __future__ import annotations

from itertools import pairwise
from typing import cast

import numpy as np
import pytest
from scipy.optimize import brentq

import poekin as pk
from poekin.engine.kernels.branches import closed_arm, closed_kernels
from poekin.engine.kernels.branches import parallel_branches as module
from poekin.model.geometry.decomposition.arm_array import arm_array
from poekin.model.geometry.decomposition.completions import completions
from poekin.model.geometry.decomposition.joints import Tolerance, joints_of
from tests.solve.ik_all import closed_form_arms as arms

Q = np.array([0.4, -1.2, 1.5, -0.3, 0.8, 0.2])


def table_of(chain: pk.Chain) -> np.ndarray:
    return arm_array(
        next(completions(joints_of(chain), chain.reach, Tolerance(1e-12, 1e-12))), chain.home
    )


def filled(chain: pk.Chain, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Configurations and margins of the pose of q."""
    rows = np.full((8, 19), np.nan)
    count = closed_kernels.fill(table_of(chain), chain.fk(q), rows)
    return rows[:count, :6], rows[:count, -1]


@pytest.mark.parametrize("first", [0, 1, 2, 3])
@pytest.mark.parametrize("kinds", ["RRR", "RRP", "PRR", "RPR"])
def test_the_configuration_of_a_pose_is_among_its_branches(first, kinds):
    chain = (
        arms.arm(7, "parallel", first, "RRR")
        if kinds == "RRR"
        else arms.planar_arm(3, first, kinds)
    )
    q = np.where(arms.sliding(chain), 0.2 * Q, Q)
    rows, margins = filled(chain, q)
    # some 100 roundings of numbers up to 1, over how far from singular the arm is
    limit = 100 * np.finfo(float).eps / arms.clearance(chain, q)
    assert arms.apart(chain, rows[None][:, margins > 0], q[None])[0] <= limit
    reached = chain.fk(rows[margins > 0])
    np.testing.assert_allclose(reached, np.broadcast_to(chain.fk(q), reached.shape), atol=1e-8)


CHAIN = arms.arm(7, "parallel", 1, "RRR")


def lost(q: np.ndarray, shift=(0.0, 0.0, 0.0), tilt=(0.0, 0.0, 0.0)) -> bool:
    """What is said of q and its pose, or of another pose."""
    table = table_of(CHAIN)
    T = CHAIN.fk(q)
    R, p = closed_arm.displacement(table, (*T[:3, :3].ravel(), *T[:3, 3]))
    P, place = module._steps(table, R, p)
    R = (pk.so3.exp(tilt) @ np.reshape(R, (3, 3))).ravel()
    h = [closed_arm.direction(table, i, R) for i in range(6)]
    x = np.stack([np.cos(q), np.sin(q)], axis=1).ravel()
    return bool(module._lost(h, P, x, R, np.add(place, shift)))


def determinant(q: np.ndarray) -> float:
    return float(np.linalg.det(CHAIN.jacobian(q, "space")))


@pytest.mark.parametrize("joint", [2, 4])
def test_joints_are_lost_where_the_determinant_is_zero_and_nowhere_else(joint):
    angles = np.linspace(-np.pi, np.pi, 25)
    of = {angle: determinant(np.where(np.arange(6) == joint, angle, Q)) for angle in angles}
    pairs = [(a, b) for a, b in pairwise(angles) if of[a] * of[b] < 0]
    assert pairs
    for pair in pairs:
        found = brentq(
            lambda x: determinant(np.where(np.arange(6) == joint, x, Q)), *pair, xtol=1e-13
        )
        root = cast(float, found)  # scipy's text has no types
        for off, expected in ((0.0, True), (1e-3, False), (-1e-3, False)):
            assert lost(np.where(np.arange(6) == joint, root + off, Q)) is expected


def test_joints_that_do_not_bring_the_tool_there_are_not_lost(monkeypatch):
    assert not lost(Q)
    monkeypatch.setattr(module, "LOST", np.inf)
    assert lost(Q)
    h = CHAIN.screws[1, :3]
    side = np.cross(h, [0.0, 0.0, 1.0])
    for way in (h, side / np.linalg.norm(side)):
        assert lost(Q, shift=0.1 * module.NEAR * way)
        assert not lost(Q, shift=5 * module.NEAR * way)
    assert lost(Q, tilt=0.5 * module.NEAR * side)
    assert not lost(Q, tilt=5 * module.NEAR * side)
