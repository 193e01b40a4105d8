"""Axes of an arm for a target: the last ones are where the target has brought them; what a row says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.engine.kernels.branches import closed_arm

TURNED = st.integers(0, 5)
SEEDS = st.integers(0, 2**32 - 1)
WITHIN = 16 * 2.0**-53  # a rotation and a difference of numbers up to 1: some ten roundings


def drawn(seed: int, turned: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An arm's array, a target, and the displacement of its tool."""
    rng = np.random.default_rng(seed)
    table = rng.uniform(-0.3, 0.3, closed_arm.SHAPE)
    table[closed_arm.RULE, closed_arm.TURNED] = turned
    table[closed_arm.RULE, closed_arm.ADDED] = 0
    D, M = (pk.se3.exp(rng.uniform(-1, 1, 6)) for _ in range(2))
    table[closed_arm.HOME : closed_arm.HOME + 3, :4] = np.linalg.inv(M)[:3]
    return table, D @ M, D


def flat(T: np.ndarray) -> tuple[float, ...]:
    """A pose as formulas take it."""
    return (*T[:3, :3].ravel(), *T[:3, 3])


def test_numbers_of_an_arm_have_places_of_their_own():
    named = closed_arm.DIRECTION, closed_arm.POINT, closed_arm.SLIDES, closed_arm.COLUMN
    assert named == (0, 3, 6, 7)
    named = closed_arm.FAMILY, closed_arm.TURNED, closed_arm.ACROSS, closed_arm.ADDED
    assert named == (0, 1, 2, 5)
    assert (closed_arm.HOME, closed_arm.RULE) == (6, 9)
    assert closed_arm.SHAPE == (10, 8)
    assert closed_arm.BRANCHES == 8


@given(SEEDS, TURNED)
def test_the_tool_s_displacement_brings_its_home_to_the_target(seed, turned):
    table, T, D = drawn(seed, turned)
    R, p = closed_arm.displacement(table, flat(T))
    np.testing.assert_allclose((*R, *p), flat(D), rtol=0, atol=WITHIN)
    np.testing.assert_allclose(
        closed_arm.brought(R, p, (0.1, 0.2, 0.3)), (D @ [0.1, 0.2, 0.3, 1])[:3], atol=WITHIN
    )


@given(SEEDS, TURNED)
def test_axes_of_the_last_joints_are_fixed_to_the_tool_and_the_others_stay(seed, turned):
    table, _, D = drawn(seed, turned)
    R, p = flat(D)[:9], flat(D)[9:]
    back = np.linalg.inv(D)
    for i in range(6):
        by = back if i >= 6 - turned else np.eye(4)
        named = table[closed_arm.RULE, closed_arm.ACROSS : closed_arm.ACROSS + 3]
        for found, expected in (
            (closed_arm.direction(table, i, R), by[:3, :3] @ table[i, :3]),
            (closed_arm.point(table, i, R, p), by[:3, :3] @ table[i, 3:6] + by[:3, 3]),
            (closed_arm.across(table, i, R), by[:3, :3] @ named),
        ):
            np.testing.assert_allclose(found, expected, rtol=0, atol=WITHIN)


X = tuple(
    value for angle in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6) for value in (np.cos(angle), np.sin(angle))
)


def six(columns: tuple[int, ...], slides: tuple[int, ...] = ()) -> np.ndarray:
    """An arm's array of which the columns and the slides matter."""
    table = np.zeros(closed_arm.SHAPE)
    table[:6, closed_arm.COLUMN] = columns
    table[list(slides), closed_arm.SLIDES] = 1.0
    table[closed_arm.RULE, closed_arm.ADDED] = columns.count(-1)
    return table


@pytest.mark.parametrize("slides", [(), (1,), (0, 4)], ids=str)
def test_coordinates_are_written_in_the_chain_s_order_at_once_or_as_points_first(slides):
    table = six((2, 0, 1, 5, 3, 4), slides)
    values = np.array([X[2 * i] if i in slides else 0.1 * (i + 1) for i in range(6)])
    expected = values[[1, 2, 0, 4, 5, 3]]
    row = np.full(7, np.nan)
    assert closed_arm.store(table, X, 0.7, row)
    np.testing.assert_allclose(row, [*expected, 0.7], rtol=0, atol=1e-15)
    points = np.full(19, np.nan)
    assert closed_arm.store(table, X, 0.7, points)
    closed_arm.finish(table, points)
    np.testing.assert_allclose(points[:6], expected, rtol=0, atol=1e-15)
    assert points[-1] == 0.7


@pytest.mark.parametrize(
    ("off", "margin", "found", "kept"),
    [
        (0.0, 0.7, 0.7, True),
        (5e-10, 0.7, 0.7, True),
        (-5e-10, 0.7, 0.7, True),
        (1e-5, 0.7, -1e-5, True),
        (-1e-5, 0.7, -1e-5, True),
        (1e-5, -0.2, -0.2, True),
        (2e-3, 0.7, -2e-3, False),
        (5e-10, -1e-12, -5e-10, True),
        (5e-10, 0.0, -5e-10, True),
        (1e-10, -1e-12, -1e-10, True),
    ],
)
def test_a_joint_that_the_arm_does_not_have_makes_a_row_none_by_as_far_as_it_is_from_zero(
    off, margin, found, kept
):
    for joint, slides in ((1, False), (4, True)):
        columns = [0, -1, 1, 2, -1, 3]
        point = list(X)
        point[2:4] = 1.0, 0.0
        point[8:10] = 0.0, 0.0
        point[2 * joint : 2 * joint + 2] = (off, 0.0) if slides else (np.cos(off), np.sin(off))
        table = six(tuple(columns), (4,))
        row = np.full(5, np.nan)
        assert closed_arm.store(table, point, margin, row) is kept
        assert row[-1] == pytest.approx(found, rel=1e-12)
        np.testing.assert_allclose(row[:4], [0.1, 0.3, 0.4, 0.6], rtol=0, atol=1e-15)
        row = np.full(13, np.nan)
        assert closed_arm.store(table, point, margin, row) is kept
        closed_arm.finish(table, row)
        assert row[-1] == pytest.approx(found, rel=1e-12)
        np.testing.assert_allclose(row[:4], [0.1, 0.3, 0.4, 0.6], rtol=0, atol=1e-15)


def test_a_slide_at_the_borders_of_zero_is_within_them():
    table = six((0, 1, 2, 3, 4, -1), (5,))
    for off, margin, kept in ((1e-9, 0.7, True), (1e-3, -1e-3, True), (1.1e-3, -1.1e-3, False)):
        row = np.full(6, np.nan)
        assert closed_arm.store(table, (*X[:10], off, 0.0), 0.7, row) is kept
        assert row[-1] == margin
        np.testing.assert_allclose(row[:5], 0.1 * np.arange(1, 6), rtol=0, atol=1e-15)


def test_the_last_joint_may_slide():
    table = six((0, 1, 2, 3, 4, 5), (5,))
    row = np.full(19, np.nan)
    assert closed_arm.store(table, (*X[:10], 7.0, 0.0), 0.7, row)
    closed_arm.finish(table, row)
    assert row[5] == 7.0
