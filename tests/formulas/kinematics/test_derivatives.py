"""Derivatives of Jacobians against central differences; their operation counts."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.engine.count import Count, counted
from poekin.formulas.kinematics import derivatives
from tests.formulas.matrices import Ad, ad, brackets
from tests.formulas.moving_screws import (
    COUNTS,
    FRAMES,
    HOME,
    RATES,
    SCREWS,
    SECOND,
    X,
    close,
    jacobian,
    slope,
)

# multiplications and additions for n joints
COSTS = {
    derivatives.cumulative_twists: lambda n: (6 * n, 6 * n - 6),
    derivatives.space_rate: lambda n: (24 * n - 18, 18 * n - 18),
    derivatives.body_rate: lambda n: (24 * n - 18, 18 * n - 18),
    derivatives.hybrid_rate: lambda n: (24 * n - 12, 18 * n - 12),
    derivatives.acceleration: lambda n: (12 * n, 12 * n - 6),
    derivatives.space_hessian: lambda n: (9 * n * (n - 1), 6 * n * (n - 1)),
    derivatives.body_hessian: lambda n: (9 * n * (n - 1), 6 * n * (n - 1)),
    derivatives.hybrid_hessian: lambda n: (6 * n * n, 3 * n * n),
}


@COUNTS
@FRAMES
def test_a_rate_is_the_difference_of_jacobians_along_a_motion(frame, count):
    A, x, dx = SCREWS[:count], X[:count], RATES[:count]
    J, dJ = jacobian(A, HOME, x, frame), np.full((6, count), np.nan)
    getattr(derivatives, f"{frame}_rate")(J, dx, count, dJ)
    close(dJ, slope(lambda h: jacobian(A, HOME, x + h * dx, frame)))
    ddx = SECOND[:count]
    expected = slope(
        lambda h: jacobian(A, HOME, x + h * dx + h * h / 2 * ddx, frame) @ (dx + h * ddx)
    )
    close(derivatives.acceleration(J, dJ, dx, ddx, count), expected)


@COUNTS
@FRAMES
def test_a_hessian_is_the_difference_of_jacobians_along_each_joint(frame, count):
    A, x = SCREWS[:count], X[:count]
    H = np.full((6, count, count), np.nan)
    if frame == "hybrid":
        H[:3] = 0.0  # it writes the entries that may differ from zero, into rows of zeros
    getattr(derivatives, f"{frame}_hessian")(jacobian(A, HOME, x, frame), count, H)
    for j, e in enumerate(np.eye(count)):
        close(H[:, :, j], slope(lambda h, e=e: jacobian(A, HOME, x + h * e, frame)))


@COUNTS
def test_velocities_run_along_the_chain(count):
    J = jacobian(SCREWS[:count], HOME, X[:count], "space")
    V = np.full((6, count), np.nan)
    derivatives.cumulative_twists(J, RATES[:count], count, V)
    np.testing.assert_allclose(V, np.cumsum(J * RATES[:count], axis=1), rtol=0, atol=1e-13)


@pytest.mark.parametrize("n", [2, 6, 7])
@pytest.mark.parametrize("formula", COSTS, ids=lambda f: f.__name__)
def test_a_derivative_costs_what_it_says(formula, n):
    count = Count()

    def of(*sizes):
        return [of(*sizes[1:]) for _ in range(sizes[0])] if sizes else counted(0.5, count)

    J, rates = of(6, n), of(n)
    if formula is derivatives.acceleration:
        formula(J, of(6, n), rates, of(n), n)
    elif formula.__name__.endswith("hessian"):
        formula(J, n, of(6, n, n))
    else:
        formula(J, rates, n, of(6, n))
    assert (count.multiplications, count.additions) == COSTS[formula](n)


def test_the_bracket_is_that_of_matrices():
    for V, W in np.random.default_rng(2).normal(size=(20, 2, 6)):
        X, Y = brackets(V), brackets(W)
        product = X @ Y - Y @ X
        np.testing.assert_allclose(brackets(derivatives.bracket(V, W)), product, rtol=0, atol=1e-13)
        np.testing.assert_allclose(derivatives.bracket(V, W), ad(V) @ W, rtol=0, atol=1e-13)


def test_the_velocity_of_a_point_is_the_twist_seen_from_there():
    for V, p in zip(
        *np.split(np.random.default_rng(3).normal(size=(20, 9)), [6], axis=1), strict=True
    ):
        at = np.eye(4)
        at[:3, 3] = -p
        np.testing.assert_allclose(derivatives.at_point(V, p), Ad(at) @ V, rtol=0, atol=1e-14)
