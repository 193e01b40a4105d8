"""The matrix of the resultant: its vector of products and its determinant."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import resultant
from tests.formulas.ik.elimination.loops import arm, equations, halves, line, products


def matrix(A):
    """The equations times C_4 and times S_4."""
    M = np.zeros((12, 12))
    M[:6, :9] = np.reshape(A, (6, 9))
    M[6:, 3:] = np.reshape(A, (6, 9))
    return M


def factored(A):
    A = list(map(float, np.ravel(A)))
    M = [math.nan] * resultant.STACKED
    return resultant.factor(A, M), A, M


def at_root(seed):
    """A at the angle of a known configuration, the size of its coefficients, and the products."""
    h, P, x, E = arm(seed)
    p, d = line(P, E, h)
    coefficients, sigma = equations(h, P, p, d)
    A = [math.nan] * resultant.EQUATIONS
    resultant.equations(sigma, tuple(halves(x[2])), A)
    size = max(np.abs(coefficients).max(), (1 + np.linalg.norm(p)) ** 2)
    return A, size, np.array(products(x[3], x[4]))


@given(st.integers(0, 2**32 - 1))
def test_the_matrix_takes_the_products_of_the_angles_to_zero(seed):
    A, size, expected = at_root(seed)
    assert np.abs(matrix(A) @ expected).max() <= 400 * 2.3e-16 * size


@pytest.mark.parametrize("seed", range(20))
def test_a_singular_matrix_tells_the_products_of_the_angles(seed):
    A, size, expected = at_root(seed)
    v = [math.nan] * resultant.SIZE
    _, A_factors, M = factored(A)
    resultant.null_vector(A_factors, M, v)
    v = np.array(v) / np.linalg.norm(v)
    expected /= np.linalg.norm(expected)
    expected *= np.sign(v @ expected)
    gap = np.linalg.svd(matrix(A), compute_uv=False)[-2]
    # backward error of an elimination of twelve rows, and of A itself, over the gap
    assert np.abs(v - expected).max() <= 1000 * 2.3e-16 * size / gap


@pytest.mark.parametrize("seed", range(20))
def test_the_determinant_is_that_of_the_whole_matrix(seed):
    A = np.random.default_rng(seed).normal(size=(6, 9))
    M = matrix(A)
    # of a change of M by some tens of roundings
    rounding = 30 * 2.3e-16 * np.linalg.norm(M) * np.abs(np.linalg.inv(M)).sum()
    assert factored(A)[0] == pytest.approx(np.linalg.det(M), rel=rounding)


@pytest.mark.parametrize("columns", [slice(0, 3), slice(3, 6), slice(6, 9)])
def test_a_block_of_zeros_is_a_determinant_of_zero_and_no_error(columns):
    A = np.random.default_rng(0).normal(size=(6, 9))
    A[:, columns] = 0
    det, A_factors, M = factored(A)
    v = [math.nan] * resultant.SIZE
    resultant.null_vector(A_factors, M, v)
    assert np.isfinite(v).all()
    singular = columns != slice(3, 6)
    assert (abs(det) <= 1e-12) == singular


def test_rows_are_exchanged_where_a_pivot_is_zero():
    A = np.random.default_rng(1).normal(size=(6, 9))
    A[0, 0] = 0
    A[3:, 3] = 0
    assert factored(A)[0] == pytest.approx(np.linalg.det(matrix(A)), rel=1e-10)


def test_what_is_written_fills_its_place():
    A, _, _ = at_root(0)
    assert np.isfinite(A).all()
    v = [math.nan] * resultant.SIZE
    _, A_factors, M = factored(A)
    assert np.isfinite(M[-1])
    resultant.null_vector(A_factors, M, v)
    assert np.isfinite(v).all()
