"""Poses of six numbers, and what is kept of their solutions, uncompiled."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.engine.kernels.sweep import measures, pose_kernel
from poekin.engine.kernels.sweep.tiles import OUTSIDE

UNIT = st.floats(0.0, 1.0, exclude_max=True)
NO_PAIRS = (np.empty(0, np.int64), np.empty(0))
posed = pose_kernel.posed.function
rated = pose_kernel.rated.function
kept = pose_kernel.kept.function


def turned(Q, p):
    """A vector turned by a unit quaternion (w, v): p + 2 w v × p + 2 v × (v × p)."""
    w, v = Q[0], Q[1:]
    return p + 2 * w * np.cross(v, p) + 2 * np.cross(v, np.cross(v, p))


@given(UNIT, UNIT, UNIT)
def test_three_numbers_from_0_to_1_are_those_of_shoemake_s_quaternion(a, b, c):
    T = np.empty((1, 4, 4))
    posed(np.array([[3.0, -2.0, 0.5, a, b, c]]), T)
    b, c = 2 * np.pi * b, 2 * np.pi * c
    r, s = math.sqrt(1 - a), math.sqrt(a)
    Q = np.array([s * math.cos(c), r * math.sin(b), r * math.cos(b), s * math.sin(c)])
    # Q is a unit vector to 3 u, products of two of its numbers to 8 u, sums of three of them
    expected = np.array([turned(Q, e) for e in np.eye(3)]).T
    np.testing.assert_allclose(T[0, :3, :3], expected, atol=64 * 2.0**-53)
    assert T[0, :3, 3].tolist() == [3.0, -2.0, 0.5]
    assert T[0, 3].tolist() == [0, 0, 0, 1]


@given(st.lists(st.integers(0, 3), max_size=9), st.integers(0, 99), st.sampled_from([1, -1]))
def test_of_each_pose_the_first_solution_with_the_best_measure_is_chosen(counts, seed, better):
    rng = np.random.default_rng(seed)
    q = rng.integers(-4, 5, (sum(counts), 1)) / 2.0
    values = np.empty(len(counts))
    chosen = np.empty(len(counts), np.int64)
    measure = np.array([measures.TRAVEL, 1, 0, 1, 6])
    rated(0, q, counts, better, measure, np.array([0.0, 2.0]), *NO_PAIRS, values, chosen)  # 2 |q|
    row = 0
    for k, count in enumerate(counts):
        own = [(-better * 2 * abs(q[i, 0]), i) for i in range(row, row + count)]
        row += count
        worst_first, number = min(own, default=(math.nan, -1))
        assert chosen[k] == number
        np.testing.assert_array_equal(values[k], -better * worst_first)


def test_the_number_of_solutions_is_a_measure_and_poses_without_any_have_none():
    values = np.empty(3)
    chosen = np.empty(3, np.int64)
    measure = np.array([measures.SOLUTIONS, 1, 0, 1, 6])
    rated(0, np.zeros((6, 1)), [2, 0, 4], 1, measure, np.empty(0), *NO_PAIRS, values, chosen)
    np.testing.assert_array_equal(values, [2.0, math.nan, 4.0])
    assert chosen.tolist() == [0, -1, 2]


@pytest.mark.parametrize("spheres", [0, 1, 3])
@pytest.mark.parametrize("outputs", [1, 2])
def test_code_of_an_arm_has_room_for_its_outputs_and_the_centres_of_its_spheres(
    outputs, spheres, monkeypatch
):
    rooms = []

    def run_columns(arm, sines, cosines, k, q, R_p, every):
        rooms.append(every.shape)
        every[:] = 4.0

    monkeypatch.setattr(pose_kernel, "run_columns", run_columns)
    monkeypatch.setattr(pose_kernel, "sines_of_block", lambda *words: None)
    monkeypatch.setattr(pose_kernel, "sines_room", lambda arm: 1)
    values = np.empty(5)
    measure = np.array([measures.ROOT, 1, outputs, 1, 6])
    masked = np.zeros(5, np.bool_)
    no_pairs = np.empty(0, np.int64)
    pose_kernel._measure_outputs(
        0, np.zeros((5, 1)), measure, np.empty(0), no_pairs, np.ones(spheres), values, masked
    )
    assert rooms == [(outputs + 3 * spheres, measures.LANES)] * 2
    assert values.tolist() == [2.0 * outputs] * 5
    assert not masked.any()


def places(*x):
    T = np.tile(np.eye(4), (len(x), 1, 1))
    T[:, 0, 3] = x
    return T


def test_reached_poses_of_the_range_count_in_their_cells_and_no_others_anywhere():
    cells, place = np.array([0, 2, 1, 1]), np.array([0.0, -0.5, -0.5, 1.0])
    T = places(0.5, 1.5, 0.5, 7.0, 7.0, 0.5, 0.5)
    chosen = np.array([0, 1, -1, 2, -1, 3, 4])
    values = np.array([1.0, 2.0, math.nan, 9.0, math.nan, 3.0, 9.0])
    counts = np.zeros(2, np.int64)
    best = np.full(2, -math.inf)
    attained = np.full(2, -1)
    measure = np.array([measures.TRAVEL, 1, 0, 1, 6])
    sums = np.empty(0, np.int64)
    found = (counts, best, attained, sums)
    outside = kept(100, 1, 6, T, chosen, cells, place, measure, values, *found)
    assert (outside, counts.tolist()) == (1, [1, 1])
    assert (best.tolist(), attained.tolist()) == ([3.0, 2.0], [105, 101])
    outside = kept(200, 0, 2, T, chosen, cells, place, -measure, values, *found)
    assert (outside, best.tolist(), attained.tolist()) == (0, [3.0, 2.0], [105, 101])


def test_bins_are_of_the_measures_of_reached_poses():
    cells, place = np.array([-1, 2, 0, 0]), np.array([0.5, 0.0, 0.0, 1.0])
    counts = np.zeros(2, np.int64)
    nothing = (np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64))
    values = np.array([1.0, 2.0, 2.0, 3.0, 1.0])
    chosen = np.array([0, 1, 2, 3, OUTSIDE])
    measure = np.array([measures.SOLUTIONS, 1, 0, 1, 6])
    T = places(*[9.0] * 5)
    outside = kept(0, 0, 5, T, chosen, cells, place, measure, values, counts, *nothing)
    assert (outside, counts.tolist()) == (1, [1, 2])
