"""Samples of poses by number: evenly in a box, all rotations alike, and on a grid."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.sweep import Cells, PoseGrid, PoseSamples
from poekin.sweep.pose_samples import NumberedPoses, read_samples
from tests.messages import says

LOWER, UPPER = np.array([-1.0, 0.0, 2.0]), np.array([1.0, 0.5, 2.1])
CELLS = Cells.box([-0.6, -0.3, 0.0], [0.6, 0.3, 0.3], 0.3, side=1)
PLANAR = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [k, 0, 0]) for k in (0, 1)],
    pk.se3.pose(np.eye(3), [2, 0, 0.5]),
    tip="paper",
)
KINDS = [PoseSamples.random, PoseSamples.sobol]


@pytest.mark.parametrize("make", KINDS)
def test_poses_fill_the_box_and_their_rotations_are_spread_evenly(make):
    N = 2**14
    T = make(LOWER, UPPER, N, seed=2).poses(np.arange(N))
    R = T[:, :3, :3]
    # products and sums of three numbers that are right to 6 u
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (N, 1, 1)), atol=1e-14)
    assert (np.linalg.det(R) > 0).all()
    units = (T[:, :3, 3] - LOWER) / (UPPER - LOWER)
    assert ((units >= 0) & (units < 1)).all()
    # of even rotations each entry has mean 0 and variance 1/3, and no two of them are correlated
    entries = np.column_stack([R.reshape(N, 9) * np.sqrt(3.0), (units - 0.5) * np.sqrt(12.0)])
    six = 6 / np.sqrt(N)
    assert np.abs(entries.mean(axis=0)).max() < six
    # products have a variance of at most 3^2 / 5
    assert np.abs(entries.T @ entries / N - np.eye(12)).max() < six * np.sqrt(9 / 5)
    # an angle t has the density (1 - cos t) / pi: cos t is -1/2 in the mean
    cosines = (np.trace(R, axis1=1, axis2=2) - 1) / 2
    assert abs(cosines.mean() + 0.5) < six


@given(st.integers(0, 2**50), st.integers(0, 2**40), st.sampled_from(KINDS))
def test_a_pose_is_a_function_of_seed_and_number_alone(number, seed, make):
    samples = make(LOWER, UPPER, 2**51, seed)
    among = samples.poses([number, 3, number])
    assert among[2].tolist() == samples.poses([number])[0].tolist() == among[0].tolist()
    assert among[1].tolist() == make(LOWER, UPPER, 7, seed).poses([3])[0].tolist()


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("turns", [1, 3])
def test_a_grid_has_the_middles_of_cells_in_their_order_the_turns_first(side, turns):
    cells = Cells(CELLS.corner, CELLS.resolution, CELLS.shape, side)
    samples = PoseGrid.of(cells, turns)
    assert samples.count == cells.count * turns
    T = samples.poses(np.arange(samples.count))
    np.testing.assert_array_equal(T, cells.poses(turns).reshape(-1, 4, 4))
    assert (cells.find(T) == np.arange(samples.count) // turns).all()


@pytest.mark.parametrize(
    "samples",
    [
        PoseSamples.random(LOWER, UPPER, 9, 5),
        PoseSamples.sobol(LOWER, UPPER, 9, 5),
        PoseSamples.sobol(LOWER, UPPER, 9, None),
        PoseGrid.of(CELLS, 3),
    ],
)
def test_samples_are_made_again_from_their_plain_data(samples):
    again = read_samples(json.loads(json.dumps(samples.describe())))
    assert type(again) is type(samples)
    assert isinstance(again, NumberedPoses)
    assert again.count == samples.count
    assert again.poses([8, 1]).tolist() == samples.poses([8, 1]).tolist()


def test_the_box_of_an_arm_holds_what_it_reaches_and_a_tenth_more_of_each_side():
    arm = pk.load("ur5e").chain(tip="tool0")
    samples = PoseSamples.of(arm, 5, seed=3)
    lower, upper = samples.drawn.lower[:3], samples.drawn.upper[:3]
    q = pk.sweep.Random.of(arm, 100_000).configurations(np.arange(100_000))
    p = arm.fk(q)[:, :3, 3]
    # the box is rounded to 1e-9 m
    np.testing.assert_allclose(upper - lower, 1.1 * np.ptp(p, axis=0), atol=3e-9)
    np.testing.assert_allclose(upper + lower, p.max(axis=0) + p.min(axis=0), atol=3e-9)
    assert (samples.count, samples.drawn.seed) == (5, 3)


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (
            lambda: PoseSamples.random([0, 0, 0], [1, 0, 1], 9),
            InputError,
            "box: expected lower below upper, got [0. 0. 0.] and [1. 0. 1.]",
        ),
        (
            lambda: PoseSamples.sobol([0, 0], [1, 1], 9),
            ShapeError,
            "lower: expected three finite numbers, m, got [0, 0]",
        ),
        (
            lambda: PoseSamples.random(LOWER, [np.inf] * 3, 9),
            ShapeError,
            "upper: expected three finite numbers, m, got [inf, inf, inf]",
        ),
        (
            lambda: PoseSamples.of(PLANAR, 9),
            InputError,
            "chain: expected an arm whose tool moves along x, y and z, got 'paper'"
            " within [3.99992, 3.99979, 0.0] m: PoseSamples.random takes a box",
        ),
        (
            lambda: PoseSamples.random(LOWER, UPPER, 0),
            InputError,
            "count: expected a whole number ...",
        ),
        (lambda: PoseSamples.sobol(LOWER, UPPER, 2**56), InputError, "count: expected a whole ..."),
        (
            lambda: PoseSamples.sobol(LOWER, UPPER, 9, -1),
            InputError,
            "seed: expected a whole number ...",
        ),
        (lambda: PoseSamples.random(LOWER, UPPER, 9, -1), InputError, "seed: expected a whole ..."),
        (lambda: PoseGrid.of(CELLS, 0), InputError, "turns: expected a whole number from 1 ..."),
        (lambda: PoseGrid.of(CELLS, 2**50), InputError, "cells times turns: expected a whole ..."),
        (
            lambda: PoseGrid.of(CELLS).poses([CELLS.count]),
            InputError,
            f"numbers: expected 0 ... {CELLS.count - 1}, got {CELLS.count} ... {CELLS.count}",
        ),
        (
            lambda: PoseSamples.random(LOWER, UPPER, 9).poses([9]),
            InputError,
            "numbers: expected 0 ... 8, got 9 ... 9",
        ),
    ],
)
def test_what_cannot_be_sampled_is_refused(make, error, words):
    with pytest.raises(error) as caught:
        make()
    assert says(caught.value, words)
