"""The matrix of the resultant: its vector of products, its determinant and its factors."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import resultant
from tests.formulas.ik.elimination.loops import arm, equations, halves, line, products


@given(st.integers(0, 2**32 - 1))
def test_the_matrix_takes_the_products_of_the_angles_to_zero(seed):
    h, P, x, E = arm(seed)
    p, d = line(P, E, h)
    sigma = equations(h, P, p, d)
    M = [0.0] * 144
    resultant.matrix(list(sigma.ravel()), tuple(halves(x[2])), M)
    M = np.array(M).reshape(12, 12)
    size = max(np.abs(sigma).max(), (1 + np.linalg.norm(p)) ** 2)
    assert np.abs(M @ products(x[3], x[4])).max() <= 400 * 2.3e-16 * size


@pytest.mark.parametrize("seed", range(5))
def test_factors_solve_and_their_determinant_is_right(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(12, 12))
    b = rng.normal(size=12)
    M, order = list(A.ravel()), [0] * 12
    det = resultant.factor(M, order)
    assert det == pytest.approx(np.linalg.det(A), rel=1e-12)
    for solve, B in ((resultant.solve, A), (resultant.solve_transposed, A.T)):
        x = list(b)
        solve(M, order, x)
        expected = np.linalg.solve(B, b)
        assert (
            np.abs(x - expected / np.linalg.norm(expected)).max() <= 1e-16 * np.linalg.cond(A) * 100
        )
