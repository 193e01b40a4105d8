"""Extreme singular values by rotations, against LAPACK's and against matrices of known ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.kinematics import singular_values

U = 2.0**-53
MOST = 12


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


@given(st.integers(1, 6), st.integers(0, 4), st.floats(0, 17), st.integers(0, 10**6))
def test_they_are_within_rounding_of_the_largest(rows, more, graded, seed):
    rng = np.random.default_rng(seed)
    s = np.sort(10.0 ** -rng.uniform(0, graded, rows))[::-1]
    J = orthogonal(rng, rows) @ (s[:, None] * orthogonal(rng, rows + more)[:rows])
    largest, smallest = extremes(J)
    expected = np.linalg.svd(J, compute_uv=False)
    # LAPACK's own error is of that size too
    assert abs(largest - expected[0]) <= 64 * U * expected[0]
    assert abs(smallest - expected[-1]) <= 64 * U * expected[0]


def test_a_matrix_of_known_values_keeps_its_small_ones_to_their_last_digits():
    # rows that are scaled keep their relative accuracy, which squares would lose
    rng = np.random.default_rng(4)
    scales = np.array([1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
    J = scales[:, None] * (np.eye(6, 7) + 0.1 * rng.normal(size=(6, 7)))
    _, smallest = extremes(J)
    # the smallest is the distance of the last row from the others' span, but for 1e-6 of it
    Q = np.linalg.qr(J[:5].T / np.abs(J[:5]).max(axis=1))[0]
    distance = np.linalg.norm(J[5] - Q @ (Q.T @ J[5]))
    assert smallest == pytest.approx(distance, rel=1e-5)


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
