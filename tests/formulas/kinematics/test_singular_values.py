"""Extreme singular values by rotations, against those of 60 digits and against matrices of known ones."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from poekin.formulas.kinematics import singular_values

U = 2.0**-53
MOST = 24  # sweeps; of 800 000 matrices one took 13, and each further one an eighth as many


def extremes(J):
    W = [list(map(float, row)) for row in J]
    rows, columns = len(W), len(W[0])
    sweeps = 1
    while singular_values.orthogonalise(W, rows, columns):
        sweeps += 1
        assert sweeps <= MOST
    return singular_values.extreme_lengths(W, rows, columns)


def orthogonal(rng, size):
    return np.linalg.qr(rng.normal(size=(size, size)))[0]


def exact(J):
    """Singular values by mpmath, the largest first."""
    with mpmath.workdps(60):
        return np.array(mpmath.svd_r(mpmath.matrix(J.tolist()), compute_uv=False), float).ravel()


def of_values(s, columns, seed):
    """A matrix of singular values s but for rounding, and its own: LAPACK's are off by 100 u where
    values nearly meet.
    """
    rng = np.random.default_rng(seed)
    J = orthogonal(rng, len(s)) @ (s[:, None] * orthogonal(rng, columns)[: len(s)])
    return J, exact(J)


@given(st.integers(1, 6), st.integers(0, 4), st.floats(0, 17), st.integers(0, 10**6))
@example(rows=3, more=0, graded=1.783380757747948e-13, seed=3)
def test_they_are_within_rounding_of_the_largest(rows, more, graded, seed):
    s = 10.0 ** -np.random.default_rng(seed).uniform(0, graded, rows)
    J, expected = of_values(s, rows + more, seed)
    largest, smallest = extremes(J)
    assert abs(largest - expected[0]) <= 64 * U * expected[0]
    assert abs(smallest - expected[-1]) <= 64 * U * expected[0]


@given(st.integers(3, 6), st.integers(0, 4), st.floats(5, 17), st.integers(0, 10**6))
def test_values_that_nearly_meet_are_as_exact(rows, more, near, seed):
    # near 1e-8 all angles between the rows are small from the start, and the rotations are large
    s = 1.0 - 10.0**-near * np.random.default_rng(seed).uniform(size=rows)
    J, expected = of_values(s, rows + more, seed)
    assert np.abs(np.subtract(extremes(J), expected[[0, -1]])).max() <= 64 * U


@pytest.mark.parametrize(
    "scales",
    [
        10.0 ** -np.arange(0, 18, 3),
        10.0 ** np.arange(-15, 1, 3),
        [1.0, 1e-9, 1e-18],
        [1e-18, 1e-9, 1.0],
    ],
)
def test_rows_that_are_scaled_keep_small_values_to_their_last_digits(scales):
    # which squares would lose
    J = np.array(scales)[:, None] * np.random.default_rng(4).normal(size=(len(scales), 7))
    condition = np.linalg.cond(J / np.linalg.norm(J, axis=1)[:, None])
    expected = exact(J)[-1]
    assert abs(extremes(J)[1] - expected) <= 64 * U * condition * expected


@pytest.mark.parametrize("J", [np.zeros((3, 4)), np.eye(3), np.ones((6, 6)), [[0.0, 2.0]]])
def test_rows_that_are_nothing_or_alike_are_no_exception(J):
    expected = np.linalg.svd(J, compute_uv=False)
    # of six equal rows, of length √6 each, rounding leaves some u
    np.testing.assert_allclose(extremes(J), expected[[0, -1]], atol=64 * U * 6)


@pytest.mark.parametrize(("a", "b", "g"), [(1.0, 1.0, 0.5), (1.0, 3.0, -0.5), (3.0, 1.0, 0.2)])
def test_a_turn_makes_two_rows_orthogonal_by_at_most_an_eighth_of_a_turn(a, b, g):
    cosine, sine = singular_values.turn(a, b, g)
    assert cosine * cosine + sine * sine == pytest.approx(1.0, abs=4 * U)
    assert abs(sine) <= cosine * (1 + 4 * U)
    mixed = cosine * sine * (a - b) + (cosine * cosine - sine * sine) * g
    assert abs(mixed) <= 8 * U * (a + b)
