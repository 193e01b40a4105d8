"""Spans of columns: rank by a share of the largest singular value, directions beside others."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.selection.spans import column_sizes, directions_beside, spanned

RNG = np.random.default_rng(31)
Q = np.linalg.qr(RNG.normal(size=(40, 3)))[0]


@pytest.mark.parametrize(("tilt", "rank"), [(4e-7, 2), (2e-8, 1)])
def test_a_direction_below_1e_8_of_the_largest_singular_value_is_rounding(tilt, rank):
    """Of 100 columns of length 1 that are nearly one, this is 10, and the next one the tilt."""
    columns = np.tile(Q[:, :1], 100)
    columns[:, 50:] += tilt / 5 * Q[:, 1:2]
    span = spanned(columns * RNG.uniform(1e-3, 1e3, 100))
    assert span.Q.shape == (40, rank)
    np.testing.assert_allclose(span.Q.T @ span.Q, np.eye(rank), rtol=0, atol=1e-8)
    np.testing.assert_allclose(span.Q @ span.R, columns / column_sizes(columns), atol=2e-7)


def test_beside_a_span_there_is_what_is_orthogonal_to_it():
    given = np.column_stack([Q[:, 0] + Q[:, 2], np.zeros(40), 1e3 * Q[:, 0]])
    (found,) = directions_beside(Q[:, :2], given).T
    assert abs(found @ Q[:, 2]) == pytest.approx(1.0)
    assert np.abs(found @ Q[:, :2]).max() < 1e-15
    assert directions_beside(Q[:, :2], given[:, 1:]).shape == (40, 0)


def test_a_column_of_zeros_has_length_1():
    assert column_sizes(np.array([[3.0, 0.0], [4.0, 0.0]])).tolist() == [5.0, 1.0]
