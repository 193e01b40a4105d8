"""Ranks of parts of Jacobians: of rows, in units of the arm's own size, at configurations everywhere."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.dexterity.jacobian_part import (
    Part,
    largest_rank,
    random_configurations,
    scaled,
    svd,
)

J = np.arange(1.0, 25.0).reshape(2, 6, 2)
H = np.arange(1.0, 25.0).reshape(6, 2, 2)


def test_lengths_of_a_pose_are_divided_and_those_of_a_part_alone_are_not():
    for axis, X, rows in ((-2, J, J.swapaxes(0, 1)), (-3, H, H)):
        turning, sliding = rows[:3], rows[3:]
        whole = np.concatenate([turning, sliding / 8.0])
        cases: list[tuple[Part, np.ndarray]] = [
            ("pose", whole),
            ("translation", sliding),
            ("rotation", turning),
        ]
        for part, expected in cases:
            found = scaled(X, axis, part, 8.0)
            np.testing.assert_array_equal(np.moveaxis(found, axis, 0), expected)


def test_of_a_jacobian_with_a_number_that_is_none_no_singular_value_is_known():
    bad = J.copy()
    bad[1, 4, 0] = np.nan
    U, s, V = svd(bad)
    assert np.isnan(s).tolist() == [[False, False], [True, True]]
    # rounding of numbers up to 12, in products of three factors of order one and s below 28
    np.testing.assert_allclose((U[0] * s[0]) @ V[0], J[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize("ratio, rank", [(1.1e-3, 2), (0.9e-3, 1)])
def test_a_motion_counts_from_a_thousandth_of_the_largest_whatever_the_size(size, ratio, rank):
    slides = np.zeros((1, 6, 3))
    slides[0, 3:, :2] = [[size, 0], [0, ratio * size], [0, 0]]
    for part in ("translation", "pose"):
        assert largest_rank(slides, size, part) == rank
    assert largest_rank(slides, size, "translation", 0.5e-3) == 2


@pytest.mark.parametrize("turn, rank", [(1.1e-9, 1), (0.9e-9, 0)])
def test_motions_of_a_thousand_millionth_are_rounding(turn, rank):
    turns = np.zeros((2, 6, 1))
    turns[1, 2] = turn
    assert largest_rank(turns, 1.0, "rotation") == rank
    # of slides, in units of what they move at most or a millionth of the reach
    slides = np.roll(turns, 3, axis=1)
    assert largest_rank(slides, 1.0, "translation") == 1
    assert largest_rank(1e-6 * slides, 1.0, "translation") == rank


def test_the_configurations_tried_are_all_over_a_turn_and_a_metre_each_way_whatever_the_limits():
    limits = [[-1.0, 1.0], [-0.5, 0.5], [-3.0, 3.0]]
    arm = pk.Chain.from_space(np.eye(6)[[0, 1, 5]], np.eye(4), limits=limits)
    share = random_configurations(arm) / [np.pi, np.pi, 1.0]
    assert (np.abs(share) <= 1.0).all()
    # some sixty numbers leave out a tenth of the range with a chance of 0.9^60 = 0.2 %
    assert share.min(axis=0).max() < -0.8
    assert share.max(axis=0).min() > 0.8
    assert len(np.unique(share)) == share.size
