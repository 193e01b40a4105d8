"""An angle and a length against those that the equations were made of, the residuals, and the
number of roots of a polynomial.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.slides import circle_and_line
from poekin.formulas.ik.slides.two_lines import NO_ROW

U = 2.0**-53
SEEDS = st.integers(0, 2**32 - 1)


def equations(seed, square, along=1.0):
    """Two equations of a known angle and length; `along` scales the first one's share of t."""
    rng = np.random.default_rng(seed)
    angle, t = rng.uniform(-np.pi, np.pi), rng.uniform(-2, 2)
    first, second = rng.uniform(-1, 1, (2, 5))
    first[2] *= along
    first[3] = 0.0
    second[3] = square
    x = np.array([np.cos(angle), np.sin(angle), t, t * t])
    first[4], second[4] = first[:4] @ x, second[:4] @ x
    return tuple(first.tolist()), tuple(second.tolist()), angle, t


def found(first, second):
    """Rows with a margin above 0."""
    rows = np.array(circle_and_line.roots(first, second))
    return rows[rows[:, 4] > 0]


def smallest_slope(first, second, row):
    """The smallest singular value of the equations' derivatives by angle and length."""
    c, s, t = row[:3]
    J = [[e[1] * c - e[0] * s, e[2] + 2 * e[3] * t] for e in (first, second)]
    return np.linalg.svd(np.array(J))[1][-1]


@given(
    SEEDS, st.sampled_from([0.0, 0.5, -0.5]), st.sampled_from([1.0, 1e-3, 1e-5, 1e-7, 1e-9, 0.0])
)
def test_the_root_that_equations_were_made_of_is_found(seed, square, along):
    if square == along == 0.0:
        along = 1.0  # t would stand in one equation alone, which is `along` = 1 turned round
    first, second, angle, t = equations(seed, square, along)
    row = [np.cos(angle), np.sin(angle), t]
    slope = smallest_slope(first, second, row)
    if slope < 1e-2:
        return  # nearly a double root: the square root of rounding, or its neighbour's own margin
    rows = found(first, second)
    away = np.abs(rows[:, :3] - row).max(axis=1, initial=0)
    # residuals of 16 u of numbers up to 5 at both ends, over the slope
    assert len(away)
    assert away.min() <= 200 * U / slope


@given(SEEDS, st.sampled_from([0.0, 0.5, -0.5]), st.sampled_from([1.0, 1e-3, 1e-7, 0.0]))
def test_every_row_with_a_margin_solves_the_equations(seed, square, along):
    first, second, _, _ = equations(seed, square, along or (1.0 if square == 0 else 0.0))
    for c, s, t, none, _ in found(first, second):
        assert none == 0
        assert abs(np.hypot(c, s) - 1) <= 4 * U
        slope = smallest_slope(first, second, (c, s, t))
        if slope < 1e-2:
            continue
        size = 1 + t * t
        for e in (first, second):
            assert (
                abs(e[0] * c + e[1] * s + e[2] * t + e[3] * t * t - e[4]) <= 64 * U * size / slope
            )


@given(SEEDS)
def test_there_are_as_many_roots_as_a_polynomial_has(seed):
    first, second, _, _ = equations(seed, 0.5)
    a, b, k, _, d = first
    A, B, K, L, D = second
    # t = (d - a c - b s) / k in the second, times (1 + x^2)^2 with x = tan(theta / 2)
    one = np.polynomial.Polynomial([1.0, 0.0, 1.0])
    c = np.polynomial.Polynomial([1.0, 0.0, -1.0])
    s = np.polynomial.Polynomial([0.0, 2.0])
    t = (d * one - a * c - b * s) / k
    roots = (L * t * t + K * t * one + (A * c + B * s) * one - D * one * one).roots()
    away = np.abs(roots.imag) / (1 + np.abs(roots) ** 2)
    if ((away > 0) & (away < 1e-3)).any() or np.abs(np.diff(np.sort(roots.real))).min() < 1e-3:
        return  # nearly double
    assert len(found(first, second)) == (roots.imag == 0).sum()


def test_a_step_that_makes_the_residual_larger_is_not_taken():
    # sin = 0 and t^2 = -1/10, to which no length is nearer than 0
    first, second = (0.0, 1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0, -0.1)
    root = (1.0, 0.0, 0.01, 0.0, 1.0)
    assert circle_and_line._sharpened(first, second, root) == root


def test_two_linear_equations_have_two_rows_and_two_that_are_none():
    first, second, _, _ = equations(3, 0.0)
    rows = circle_and_line.roots(first, second)
    assert [row[4] == -NO_ROW for row in rows] == [False, False, True, True]


def test_equations_without_the_length_say_that_nothing_tells_it():
    first, second = (1.0, 0.0, 0.0, 0.0, 0.5), (0.0, 1.0, 0.0, 0.0, 0.5)
    assert all(row[4] <= -1.0 for row in circle_and_line.roots(first, second))


@given(SEEDS)
def test_both_roots_of_linear_equations_are_near_before_they_are_sharpened(seed):
    """t is a quotient: what rounding leaves, some u, is over the larger of the factors of t."""
    first, second, _, _ = equations(seed, 0.0)
    for row in circle_and_line._of_line(first, second)[:2]:
        c, s, t, _, margin = row
        if margin >= 0.0:
            x = np.array([c, s, t, 0.0])
            limit = 16 * U * max(1.0, abs(t)) / max(abs(first[2]), abs(second[2]))
            for equation in (first, second):
                assert abs(equation[:4] @ x - equation[4]) <= limit
