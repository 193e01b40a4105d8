"""The kernel of closed forms: what it fills, what it leaves out, and how it runs uncompiled."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import closed_arm, closed_kernels
from poekin.solve.ik_all.closed_form import closed_form


def arm(name: str, joints: int = 6) -> tuple[pk.Chain, np.ndarray]:
    chain = pk.load(name).chain()
    chain = pk.Chain.from_space(chain.screws[:joints], chain.home)
    found = closed_form(chain)
    assert found is not None
    return chain, found.arm


Q = np.array([0.4, -1.2, 1.5, -0.3, 0.8, 0.2])


@pytest.mark.parametrize(("name", "joints"), [("ur5", 6), ("puma560", 6), ("puma560", 3)])
def test_one_target_uncompiled_and_a_batch_compiled_have_the_same_rows(name, joints):
    chain, table = arm(name, joints)
    T = chain.fk(Q[:joints])
    one = np.full((8, 3 * joints + 1), np.nan)
    count = closed_kernels.fill(table, T, one)
    solutions = one[:count][one[:count, -1] > 0, :joints]
    assert len(solutions) == (8 if joints == 6 else len(solutions)) > 0
    reached = chain.fk(solutions)
    # 1e-8 m and rad: some thousand roundings, over how far from singular the pose is
    np.testing.assert_allclose(reached, np.broadcast_to(T, reached.shape), rtol=0, atol=1e-8)
    angles = one[:count, :joints]
    plain = np.full((2, 8, joints + 1), 7.0)
    closed_kernels.branches_of(table).function(table, np.stack([T, T]), plain)
    for rows in plain:
        np.testing.assert_allclose(rows[:count, :-1], angles, rtol=0, atol=1e-15)
        np.testing.assert_array_equal(rows[:count, -1], one[:count, -1])
        assert np.isnan(rows[count:]).all()
    many = np.empty((2, 8, joints + 1))
    closed_kernels.branches_of(table).call(table, np.stack([T, T]), many)
    np.testing.assert_array_equal(many[0], many[1])
    np.testing.assert_allclose(many[0, :count, :-1], angles, atol=1e-9)
    np.testing.assert_allclose(many[0, :count, -1], one[:count, -1], atol=1e-9)
    points = np.concatenate([np.cos(angles), np.sin(angles)], axis=1)
    np.testing.assert_allclose(one[:count, joints:-1], points, atol=1e-15)
    assert np.isnan(many[0, count:]).all()
    assert count == (8 if joints == 6 else count)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("at", [(0, 0), (1, 2), (2, 3)])
@pytest.mark.parametrize("name", ["ur5", "puma560"])
def test_a_target_that_is_not_finite_has_no_rows(name, bad, at):
    chain, table = arm(name)
    T = chain.fk(Q)
    T[at] = bad
    run = closed_kernels.branches_of(table)
    for each in (run.call, run.function):
        rows = np.full((1, 8, 7), 7.0)
        with np.errstate(invalid="ignore"):
            each(table, T[None].copy(), rows)
        assert np.isnan(rows).all()
    with np.errstate(invalid="ignore"):
        assert closed_kernels.fill(table, T, np.empty((8, 19))) == 0


def test_a_displacement_is_finite_where_its_diagonal_and_its_place_are():
    half_turn = (1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0)
    for R in (
        half_turn,
        (1e308, 0, 0, 0, -1e308, 0, 0, 0, 0),
        (1e200,) * 9,
        (0, 0, 0, 0, 1e308, 0, 0, 0, -1e308),
    ):
        for p in ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0)):
            assert closed_kernels.is_finite(R, p)
    # the square of the length is finite up to 1.34e154
    assert closed_kernels.is_finite((1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0), (1.3e154, 0.0, 0.0))
    for bad in (np.nan, np.inf, -np.inf):
        for i in (0, 4, 8):
            for p in ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0)):
                assert not closed_kernels.is_finite((*half_turn[:i], bad, *half_turn[i + 1 :]), p)
        for p in ((bad, 0.0, 0.0), (0.0, bad, 0.0), (0.0, 0.0, bad)):
            assert not closed_kernels.is_finite(half_turn, p)


def test_a_joint_that_the_arm_does_not_have_is_at_zero_in_every_solution():
    chain, table = arm("puma560", 3)
    assert table[closed_arm.RULE, closed_arm.ADDED] == 3
    assert sorted(table[:6, closed_arm.COLUMN]) == [-1, -1, -1, 0, 1, 2]
    rows = np.empty((8, 10))
    count = closed_kernels.fill(table, chain.fk(Q[:3]), rows)
    assert (rows[:count, -1] > 0).any()
    away = chain.fk(Q[:3])
    away[:3, :3] = pk.so3.exp([0.3, 0.2, 0.1]) @ away[:3, :3]
    count = closed_kernels.fill(table, away, rows)
    assert not (rows[:count, -1] > 0).any()


def test_where_an_added_joint_may_be_anywhere_the_rows_say_so():
    # the fourth to sixth axis are the added wrist through a point of the arm's last axis: where it
    # is on the first axis, the first angle is not told by the position
    z, x = [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]
    screws = [
        pk.screw.revolute(z, [0, 0, 0]),
        pk.screw.revolute(x, [0, 0, 0.5]),
        pk.screw.revolute([0.0, 1.0, 0.0], [0, 0, 1.0]),
        pk.screw.revolute(z, [0, 0, 0]),
    ]
    chain = pk.Chain.from_space(screws, np.eye(4))
    found = closed_form(chain)
    assert found is not None
    straight = chain.fk(np.zeros(4))
    rows, _ = found.rows(straight[None])
    near = np.nanmin(np.abs(rows[0]).max(axis=1), initial=np.inf)
    *_, unsure = found.starts(straight[None])
    assert near < 1e-6 or unsure[0]
