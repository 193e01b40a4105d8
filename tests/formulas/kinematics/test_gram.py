"""det(J Jᵀ), against the product of singular values and 60 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.kinematics import gram

U = 2.0**-53


def determinant(J):
    rows, columns = len(J), len(J[0])
    G = [[0 * J[0][0]] * rows for _ in range(rows)]
    return gram.determinant(J, rows, columns, G)


@given(st.integers(1, 6), st.integers(0, 4), st.integers(0, 10**6))
def test_it_is_the_exact_one_within_rounding_of_the_rows_lengths(rows, more, seed):
    rng = np.random.default_rng(seed)
    scales = 10.0 ** rng.uniform(-2, 2, rows)
    J = rng.normal(size=(rows, rows + more)) * scales[:, None]
    with mpmath.workdps(60):
        exact = mpmath.matrix(J.tolist())
        true = float(mpmath.det(exact * exact.T))
    lengths = np.prod(np.square(J).sum(axis=1))
    assert abs(determinant(J.tolist()) - true) <= 4 * (2 * rows + more) * U * lengths


def test_its_root_is_the_product_of_singular_values():
    J = np.random.default_rng(1).normal(size=(6, 7))
    expected = np.prod(np.linalg.svd(J, compute_uv=False))
    assert np.sqrt(determinant(J.tolist())) == pytest.approx(expected, rel=1e-12)


def test_a_row_that_is_twice_another_makes_it_nothing():
    J = np.random.default_rng(2).normal(size=(3, 5))
    J[2] = 2 * J[0]
    # of which rounding leaves no more than it takes from the product of lengths
    assert abs(determinant(J.tolist())) <= 32 * U * np.prod(np.square(J).sum(axis=1))
