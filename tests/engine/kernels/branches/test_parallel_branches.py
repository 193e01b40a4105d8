"""Branches of three parallel axes, uncompiled: the configuration is among them, and where it is lost."""

from __future__ import annotations

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from scipy.optimize import brentq

import poekin as pk
from poekin.engine.kernels.branches import closed_arm, closed_kernels, wrist_branches
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
    with pytest.MonkeyPatch.context() as patch:
        # compiled code adds truths as numbers, which NumPy's are not
        patch.setattr(module, "slides", lambda arm, i: bool(closed_arm.slides(arm, i)))
        count = closed_kernels.fill(table_of(chain), chain.fk(q), rows)
    return rows[:count, :6], rows[:count, -1]


@pytest.mark.parametrize("first", [0, 1, 2, 3])
@pytest.mark.parametrize("kinds", ["RRR", "RRP", "PRR", "RPR", "RPP", "PRP", "PPR"])
def test_the_configuration_of_a_pose_is_among_its_branches(first, kinds):
    chain = (
        arms.arm(7, "parallel", first, "RRR")
        if kinds == "RRR"
        else arms.planar_arm(3, first, kinds)
    )
    q = np.where(arms.sliding(chain), 0.2 * Q, Q)
    rows, margins = filled(chain, q)
    assert len(rows) == (4 if kinds.count("P") == 2 else 8)
    # some 100 roundings of numbers up to 1, over how far from singular the arm is
    limit = 100 * np.finfo(float).eps / arms.clearance(chain, q)
    assert arms.apart(chain, rows[None][:, margins > 0], q[None])[0] <= limit
    reached = chain.fk(rows[margins > 0])
    np.testing.assert_allclose(reached, np.broadcast_to(chain.fk(q), reached.shape), atol=1e-8)


CHAIN = arms.arm(7, "parallel", 1, "RRR")


def lost(q: np.ndarray, shift=(0.0, 0.0, 0.0), tilt=(0.0, 0.0, 0.0), unit=1.0) -> bool:
    """What is said of q and its pose, or of another pose, of an arm `unit` times as large."""
    h, P, R, place = equations(q)
    R = (pk.so3.exp(tilt) @ np.reshape(R, (3, 3))).ravel()
    x = np.stack([np.cos(q), np.sin(q)], axis=1).ravel()
    return bool(module._lost(h, [unit * np.array(a) for a in P], x, R, unit * np.add(place, shift)))


def equations(q: np.ndarray) -> tuple[list, tuple, tuple, tuple]:
    """Axes, steps, rotation and place of the equations."""
    table = table_of(CHAIN)
    T = CHAIN.fk(q)
    R, p = closed_arm.displacement(table, (*T[:3, :3].ravel(), *T[:3, 3]))
    P, place = module._steps(table, R, p)
    return [closed_arm.direction(table, i, R) for i in range(6)], P, R, place


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    return pk.so3.exp(angle * np.asarray(axis))


def size_of(q: np.ndarray) -> float:
    """Length of the place before the first joint and of the step after the fifth one, together."""
    *_, P, _, place = equations(q)
    return math.hypot(np.linalg.norm(place), np.linalg.norm(P[5]))


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


@pytest.mark.parametrize("seed", range(4))
def test_what_is_lost_is_the_determinant_by_the_lengths_and_the_square_of_a_sine(seed, monkeypatch):
    q = np.random.default_rng(seed).uniform(-2, 2, 6)
    h, P, *_ = equations(q)
    last = np.cross(h[1], turn(h[4], q[4]) @ h[5])
    lengths = np.linalg.norm(P[2]) * np.linalg.norm(P[3])
    share = abs(determinant(q)) * (last @ last) / (size_of(q) * lengths)
    for unit in (1.0, 3.0):
        for limit, expected in ((share * (1 + 1e-9), True), (share * (1 - 1e-9), False)):
            monkeypatch.setattr(module, "LOST", limit)
            assert lost(q, unit=unit) is expected


@pytest.mark.parametrize("unit", [0.2, 1.0, 3.0])
def test_joints_that_do_not_bring_the_tool_there_are_not_lost(unit, monkeypatch):
    assert not lost(Q)
    monkeypatch.setattr(module, "LOST", np.inf)
    assert lost(Q, unit=unit)
    h, _, R, _ = equations(Q)
    side = np.cross(h[1], [0.0, 0.0, 1.0])
    for way in (np.array(h[1]), side / np.linalg.norm(side)):
        # the size grows with the shift, by a thousandth at most
        assert lost(Q, shift=0.99 * module.NEAR * size_of(Q) * way, unit=unit)
        assert not lost(Q, shift=1.01 * module.NEAR * size_of(Q) * way, unit=unit)
    # what a small turn about `side` adds to the component of the sixth axis along the parallel ones
    rate = (turn(h[0], Q[0]) @ h[1]) @ np.cross(side, np.reshape(R, (3, 3)) @ h[5])
    # and a turn of a thousandth, some of its square
    tilt = module.NEAR / rate * side
    assert lost(Q, tilt=0.9 * tilt, unit=unit)
    assert not lost(Q, tilt=1.1 * tilt, unit=unit)


@pytest.mark.parametrize(
    ("outer", "margin", "stored"),
    [
        (0.9e-9, -0.5, 0.0), (-0.9e-9, -0.5, 0.0), (1e-9, -0.5, -0.5), (-1.1e-9, -0.5, -0.5),
        (0.0, 0.25, 0.25), (5.0, 0.25, 0.25),
    ],
)  # fmt: skip
def test_where_any_last_joint_reaches_so_may_another_one(outer, margin, stored, monkeypatch):
    seen = []
    other = 0.0 if abs(outer) >= module.DOUBLE else 5.0  # the sine of the fifth joint
    x = (*[0.5] * 12, margin)
    three = SimpleNamespace(
        outer=lambda *rest: [(1.0, 0.0, 1.0, other, outer)] * 2,
        with_outer=lambda *rest: (x, x),
    )
    monkeypatch.setattr(module, "three_parallel", three)
    monkeypatch.setattr(module, "store", lambda arm, x, margin, row: not seen.append(margin))
    assert closed_kernels.fill(table_of(CHAIN), CHAIN.fk(Q), np.zeros((8, 19))) == 4
    assert seen == [stored] * 4


@pytest.mark.parametrize("group", ["parallel", "wrist"])
def test_a_row_that_is_far_from_a_joint_at_zero_is_unsure_where_the_joints_are_lost(
    group, monkeypatch
):
    chain = CHAIN if group == "parallel" else arms.arm(5, "wrist", 1, "RRR")
    table, T = table_of(chain), chain.fk(Q)
    branches = module if group == "parallel" else wrist_branches
    monkeypatch.setattr(closed_kernels, "finish", lambda arm, row: None)
    monkeypatch.setattr(branches, "store", lambda *rest: False)
    for added, is_lost, expected in ((1, True, 8), (1, False, 0), (0, True, 0)):
        table[closed_arm.RULE, closed_arm.ADDED] = added
        monkeypatch.setattr(branches, "_lost", lambda *rest, said=is_lost: said)
        rows = np.full((8, 19), np.nan)
        assert closed_kernels.fill(table, T, rows) == expected
        assert rows[:, -1].tolist() == [-2.0] * expected or expected == 0
        assert np.isnan(rows[:, :-1]).all()


@pytest.mark.parametrize(("group", "first", "axis"), [("parallel", 0, 1), ("wrist", 3, 5)])
def test_a_target_may_turn_the_named_vector_onto_its_axis(group, first, axis):
    chain = arms.arm(7, group, first, "RRR")
    table = table_of(chain)
    h = table[axis, :3]
    named = table[closed_arm.RULE, closed_arm.ACROSS : closed_arm.ACROSS + 3]
    onto = (named, h) if group == "parallel" else (h, named)
    quarter = turn(np.cross(*onto), np.pi / 2)
    D = chain.fk(Q) @ np.linalg.inv(chain.home)
    found = 0
    for spin in np.linspace(0, 2 * np.pi, 9)[:-1]:
        E = D.copy()
        E[:3, :3] = quarter @ turn(onto[0], spin)
        np.testing.assert_allclose(E[:3, :3] @ onto[0], onto[1], atol=1e-15)
        if group == "wrist":  # its point stays where it was
            E[:3, 3] += (D[:3, :3] - E[:3, :3]) @ table[5, 3:6]
        rows = np.full((8, 19), np.nan)
        T = E @ chain.home
        count = closed_kernels.fill(table, T, rows)
        good = rows[:count, -1] > 1e-3
        reached = chain.fk(rows[:count, :6][good])
        np.testing.assert_allclose(reached, np.broadcast_to(T, reached.shape), atol=1e-8)
        found += int(good.sum())
    assert found > 4
