"""The step of inverse kinematics against linear algebra, and what its damping is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.inverse import damped_step

WEIGHTS = np.array([1.0, 0.5, 2.0, 3.0, 0.25, 1.5])


@given(st.integers(0, 2**32 - 1), st.integers(1, 9), st.floats(-3, 1).map(lambda k: 10.0**k))
def test_a_step_is_that_of_damped_least_squares(seed, m, size):
    rng = np.random.default_rng(seed)
    J, e, w = rng.normal(size=(6, m)), size * rng.normal(size=6), rng.uniform(0.1, 2, 6)
    free = (rng.random(m) < 0.7).astype(float)
    E = damped_step.half_square(e, w)
    assert pytest.approx(e @ np.diag(w) @ e / 2, rel=1e-14) == E
    damping = 0.1 * E
    H, dq = np.empty((m, m)), np.empty(m)
    damped_step.step(J, e, w, E, free, m, H, dq)
    A = J * free
    expected = np.linalg.solve(A.T @ np.diag(w) @ A + damping * np.eye(m), A.T @ (w * e))
    condition = 1 + w.max() * np.linalg.norm(J, 2) ** 2 / damping
    # the diagonal's gain of 1e-14 of its largest, and rounding, times the condition
    assert np.abs(dq - expected).max() <= 3e-14 * m * condition * (1e-9 + np.abs(expected).max())
    assert (dq[free == 0] == 0).all()


@given(st.integers(0, 2**32 - 1))
def test_the_descent_is_minus_the_slope_of_half_the_square(seed):
    rng = np.random.default_rng(seed)
    J, e = rng.normal(size=(6, 4)), rng.normal(size=6)
    for i in range(4):
        # e changes by -J_i dq_i; of a quadratic a central difference has no error but rounding
        ahead, back = (damped_step.half_square(e - h * J[:, i], WEIGHTS) for h in (1e-3, -1e-3))
        slope = (ahead - back) / 2e-3
        assert damped_step.descent(J, e, WEIGHTS, i) == pytest.approx(-slope, abs=1e-11)


@pytest.mark.parametrize(
    ("q", "direction", "blocked"),
    [
        (-1.0, -0.1, True), (-1.0, 0.1, False), (-1.5, -0.1, True), (-1.0, 0.0, False),
        (2.0, 0.1, True), (2.0, -0.1, False), (2.5, 0.1, True), (2.0, 0.0, False),
        (0.0, 9.0, False), (0.0, -9.0, False),
    ],
)  # fmt: skip
def test_a_coordinate_is_blocked_at_a_limit_that_the_descent_leads_out_of(q, direction, blocked):
    assert damped_step.is_blocked(q, -1.0, 2.0, direction) is blocked


def test_slides_lose_the_damping_beyond_their_own_size():
    J = np.zeros((6, 5))
    J[:3, 0] = [0, 0, 1e-9]  # turns, if little
    J[3:, 1] = [1.0, 2.0, -2.0]  # own: 3 * 1 + 0.25 * 4 + 1.5 * 4 = 10
    J[3:, 2] = [0.1, 0, 0]  # own less than 1: 1 stays
    J[3:, 3] = [1.0, 2.0, -2.0]  # not free
    J[3:, 4] = [10.0, 0, 0]  # own 300: all stays
    J[3:, 0] = [1.0, 2.0, -2.0]
    free = np.array([1.0, 1, 1, 0, 1])
    for damping, taken in (
        (25.0, [0, 15.0, 24.0, 0, 0]),
        (1.5, [0, 0, 0.5, 0, 0]),
        (1.0, [0] * 5),
        (0.5, [0] * 5),
        (5.0, [0, 0, 4.0, 0, 0]),
    ):
        H = np.full((5, 5), 50.0)
        damped_step.ease_slides(J, WEIGHTS, damping, free, 5, H)
        assert np.full((5, 5), 50.0) - H == pytest.approx(np.diag(taken), abs=1e-12)
    for turns in 1e-9 * np.vstack([np.eye(3), -np.eye(3)]):
        J[:3, 1] = turns
        H = np.zeros((5, 5))
        damped_step.ease_slides(J, WEIGHTS, 25.0, free, 5, H)
        assert H[1, 1] == 0


def test_the_diagonal_gains_some_rounding_of_the_largest_that_is_free():
    H = np.diag([2.0, 8.0, 0.0])
    H[1, 0] = 3.0
    damped_step.keep_regular(np.array([1.0, 0, 1]), 3, H)
    assert H.tolist() == [[2 + 2e-14, 0, 0], [3, 8 + 2e-14, 0], [0, 0, 2e-14]]
    H = np.array([[0.25, 0.0], [0.0, 0.0]])
    damped_step.keep_regular(np.ones(2), 2, H)
    assert H[1, 1] == pytest.approx(0.25e-14)
