"""The normal equations and their solution against numpy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.inverse import least_squares


@given(st.integers(1, 9), st.integers(0, 2**32 - 1), st.floats(-8, 2).map(lambda e: 10.0**e))
def test_damped_steps_are_those_of_linear_algebra(m, seed, damping):
    rng = np.random.default_rng(seed)
    J, e, w = rng.normal(size=(6, m)), rng.normal(size=6), rng.uniform(0.1, 2, 6)
    free = (rng.random(m) < 0.7).astype(float)
    H, g = np.empty((m, m)), np.empty(m)
    least_squares.normal_equations(J, e, w, damping, free, m, H, g)
    least_squares.solve(H, g, m)
    A = J * free
    expected = np.linalg.solve(A.T @ np.diag(w) @ A + damping * np.eye(m), A.T @ (w * e))
    condition = 1 + (w.max() * np.linalg.norm(J, 2) ** 2) / damping
    # normal equations: rounding times their condition, a few digits a row
    assert np.abs(g - expected).max() <= 1e-14 * m * condition * (1 + np.abs(expected).max())
    assert (g[free == 0] == 0).all()


@pytest.mark.parametrize("m", [1, 3, 6])
def test_without_damping_a_square_system_is_solved(m):
    rng = np.random.default_rng(m)
    J, x = rng.normal(size=(6, m)), rng.normal(size=m)
    H, g = np.empty((m, m)), np.empty(m)
    least_squares.normal_equations(J, J @ x, np.ones(6), 0.0, np.ones(m), m, H, g)
    least_squares.solve(H, g, m)
    np.testing.assert_allclose(g, x, rtol=1e-10)


def test_an_error_of_zero_moves_nothing():
    H, g = np.empty((2, 2)), np.empty(2)
    least_squares.normal_equations(
        np.eye(6)[:, :2], np.zeros(6), np.ones(6), 0.0, np.ones(2), 2, H, g
    )
    least_squares.solve(H, g, 2)
    assert g.tolist() == [0.0, 0.0]
