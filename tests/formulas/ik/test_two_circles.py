"""Two equations linear in two circles' points against roots of a polynomial in 120 digits: equations
that are nearly dependent, whole or in one angle, folds, angles that stand in one equation alone.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik import two_circles
from tests.formulas.ik.circle_roots import UNIT, angle, apart, laurent, on_circle, product
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(two_circles.roots)
UNDETERMINED = 1e-2  # rad: rounding may turn such a root into any other, or take it


def small(rng):
    return 10.0 ** rng.uniform(-17, 0)


def through(A, B, theta, phi):
    """Equations with these halves that two angles solve."""
    point = np.array([math.cos(theta), math.sin(theta)])
    d = A @ point + B @ [math.cos(phi), math.sin(phi)]
    return tuple(tuple(map(float, (*A[i], *B[i], d[i]))) for i in (0, 1))


def halves(rng):
    return rng.normal(size=(2, 2)), rng.normal(size=(2, 2)), *rng.uniform(-np.pi, np.pi, 2)


def any_coefficients(rng):
    """Of all scales, each equation by itself."""
    scales = 10.0 ** rng.uniform(-140, 140, 2)
    return tuple(
        tuple(k * x for x in row) for k, row in zip(scales, through(*halves(rng)), strict=True)
    )


def one_half_nearly_dependent(rng):
    A, B, theta, phi = halves(rng)
    A[1] = A[0] * rng.normal() + small(rng) * rng.normal(size=2)
    first, second = through(A, B, theta, phi)
    if rng.random() < 0.5:
        first, second = (row[2:4] + row[:2] + row[4:] for row in (first, second))
    return first, second


def both_halves_nearly_dependent(rng):
    """Determinants from 1e-17 to 1, each by itself."""
    A, B, theta, phi = halves(rng)
    A[1] = A[0] * rng.normal() + small(rng) * rng.normal(size=2)
    B[1] = B[0] * rng.normal() + small(rng) * rng.normal(size=2)
    return through(A, B, theta, phi)


def folds(rng):
    """The slopes of both equations are parallel, or nearly so: a double root."""
    A, B, theta, _ = halves(rng)
    if rng.random() < 0.5:
        A[1] = A[0] * rng.normal() + small(rng) * rng.normal(size=2)
        B[1] = B[0] * rng.normal() + small(rng) * rng.normal(size=2)
    slope = A @ [-math.sin(theta), math.cos(theta)]
    across = slope[0] * B[1] - slope[1] * B[0]
    phi = math.atan2(across[1], across[0])
    if rng.random() < 0.5:
        phi += small(rng) * rng.normal()
    return through(A, B, theta, phi)


def one_half_small(rng):
    A, B, theta, phi = halves(rng)
    first, second = through(A * small(rng), B, theta, phi)
    if rng.random() < 0.5:
        first, second = (row[2:4] + row[:2] + row[4:] for row in (first, second))
    return first, second


def each_angle_nearly_by_itself(rng):
    A, B, theta, phi = halves(rng)
    A[1] *= small(rng)
    B[0] *= small(rng)
    return through(A, B, theta, phi)


def nearly_dependent(rng):
    A, B, theta, phi = halves(rng)
    A[1] = A[0] + 1e-3 * small(rng) * rng.normal(size=2)
    B[1] = B[0] + 1e-3 * small(rng) * rng.normal(size=2)
    return through(A, B, theta, phi)


DRAWS = (
    any_coefficients,
    one_half_nearly_dependent,
    both_halves_nearly_dependent,
    folds,
    one_half_small,
    each_angle_nearly_by_itself,
    nearly_dependent,
)


def points(first, second):
    """Both angles of all roots; None where each half's rows are exactly dependent."""
    f = list(map(mpmath.mpf, first))
    g = list(map(mpmath.mpf, second))
    det = f[2] * g[3] - f[3] * g[2]
    if abs(det) < abs(f[0] * g[1] - f[1] * g[0]):
        exchanged = points(f[2:4] + f[:2] + f[4:], g[2:4] + g[:2] + g[4:])
        return None if exchanged is None else [(b, a) for a, b in exchanged]
    if det == 0:
        return None
    # Cramer's rule: det x and det y by (c, s)
    x = [f[3] * g[k] - g[3] * f[k] for k in (0, 1)] + [g[3] * f[4] - f[3] * g[4]]
    y = [g[2] * f[k] - f[2] * g[k] for k in (0, 1)] + [f[2] * g[4] - g[2] * f[4]]
    squares = zip(product(laurent(*x), laurent(*x)), product(laurent(*y), laurent(*y)), strict=True)
    polynomial = [a + b for a, b in squares]
    polynomial[2] -= det**2
    found = []
    for theta in on_circle(polynomial):
        row = (mpmath.cos(theta), mpmath.sin(theta), 1)
        phi = mpmath.atan2(*(sum(a * b for a, b in zip(z, row, strict=True)) / det for z in (y, x)))
        found.append((theta, phi))
    return found


def unit(row):
    size = mpmath.sqrt(sum(mpmath.mpf(x) ** 2 for x in row[:4]))
    return [mpmath.mpf(x) / size for x in row]


def left(row, theta, phi):
    """Left side less right, its slopes by both angles, and their own slopes."""
    c, s, x, y = mpmath.cos(theta), mpmath.sin(theta), mpmath.cos(phi), mpmath.sin(phi)
    one = (row[0] * c + row[1] * s, row[1] * c - row[0] * s)
    two = (row[2] * x + row[3] * y, row[3] * x - row[2] * y)
    return one[0] + two[0] - row[4], (one[1], two[1]), (-one[0], -two[0])


def cost(first, second, theta, phi):
    """Change of the angles in the direction that rounding of the equations turns most."""
    _, f, f_bend = left(first, theta, phi)
    _, g, g_bend = left(second, theta, phi)
    U, S, V = mpmath.svd_r(mpmath.matrix([f, g]))
    size = UNIT * (2 + abs(first[4]) + abs(second[4]))
    bend = sum(U[0, 1] * f_bend[k] * V[1, k] ** 2 for k in (0, 1))
    bend += sum(U[1, 1] * g_bend[k] * V[1, k] ** 2 for k in (0, 1))
    costs = [mpmath.mpf(4)]
    if S[1] != 0:
        costs.append(size / S[1])
    if bend != 0:
        costs.append(mpmath.sqrt(2 * size / abs(bend)))
    return min(costs) + UNIT


def cases(draw):
    rng = np.random.default_rng(21)
    found = []
    for _ in range(50):
        equations = draw(rng)
        roots = points(*equations)
        if roots is None:
            continue
        rows = [unit(row) for row in equations]
        found.append((equations, rows, [(*root, cost(*rows, *root)) for root in roots]))
    return found


def check(got, rows, expected):
    """No root is lost or further than 4 times its cost, and no other said to be one."""
    found = [(angle(*row[:2]), angle(*row[2:4]), row[4]) for row in got]
    for theta, phi, change in expected:
        if change < UNDETERMINED:
            errors = [apart(x, theta) + apart(y, phi) for x, y, margin in found if margin >= 0.0]
            assert min(errors) <= 4 * change
    for theta, phi, margin in found:
        if margin >= 0.0:
            # accepted up to 12 u in both together, right to 3 u
            assert all(
                abs(left(row, theta, phi)[0]) <= 8 * UNIT * (2 + abs(row[4])) for row in rows
            )


@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_no_root_is_lost_and_each_right_to_4_times_what_rounding_costs(draw):
    with mpmath.workdps(120):
        found = cases(draw)
        assert sum(bool(expected) for _, _, expected in found) > 30
        for equations, rows, expected in found:
            for roots in (FLOATS, COMPILED):
                check(roots(*equations), rows, expected)


@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_no_row_of_a_margin_of_0_is_far_from_a_root(draw):
    # some 500 equations: of one in a hundred that are nearly dependent it was once
    rng = np.random.default_rng(21)
    with mpmath.workdps(60):
        for _ in range(500):
            equations = draw(rng)
            check(COMPILED(*equations), [unit(row) for row in equations], [])


@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_each_angle_in_an_equation_of_its_own_is_four_roots(roots):
    got = roots((0.3, -0.4, 0.0, 0.0, 0.1), (0.0, 0.0, -0.5, 1.2, 0.65))
    thetas = [math.atan2(-0.4, 0.3) + k * math.acos(0.2) for k in (1, -1)]
    phis = [math.atan2(1.2, -0.5) + k * math.acos(0.5) for k in (1, -1)]
    rows = [unit((0.3, -0.4, 0.0, 0.0, 0.1)), unit((0.0, 0.0, -0.5, 1.2, 0.65))]
    with mpmath.workdps(120):
        check(got, rows, [(a, b, cost(rows[0], rows[1], a, b)) for a in thetas for b in phis])


def continua(rng):
    """Equations that hold one angle, or are one equation, or where one is of zeros."""
    A, B, theta, phi = halves(rng)
    kind = rng.integers(6)
    if kind == 0:
        A *= 0.0
    if kind == 1:
        B *= 0.0
    if kind == 2:
        A[1] = A[0]
        B[1] = B[0]
    if kind == 3:
        A[1] = -A[0]
        B[1] = -B[0]
    if kind >= 4:
        A[1] *= 0.0
        B[1] *= 0.0
    if kind == 5:
        A[0, 0] = 0.0
        B[0, 0] = 0.0
    return through(A, B, theta, phi)


@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_of_a_continuum_a_root_is_given_with_margin_0(roots):
    rng = np.random.default_rng(22)
    for _ in range(400):
        first, second = continua(rng)
        found = [row for row in roots(first, second) if row[4] >= 0.0]
        assert found
        for c, s, x, y, _ in found:
            for row in (first, second):
                size = np.linalg.norm(row[:4])
                assert abs(np.dot(row[:4], (c, s, x, y)) - row[4]) <= 16 * UNIT * (
                    2 * size + abs(row[4])
                )


@pytest.mark.parametrize(
    "second",
    [(0.6, -0.2, 0.5, 0.1, 0.9), (-0.6, 0.2, -0.5, -0.1, 0.3), (0.0, 0.0, 0.0, 0.0, 0.1)],
)
def test_equations_that_contradict_each_other_have_no_root(second):
    first = (0.6, -0.2, 0.5, 0.1, 0.3)
    for got in (two_circles.roots(first, second), two_circles.roots(second, first)):
        assert all(row[4] == -1.0 for row in got)


def test_one_equation_that_is_out_of_reach_has_no_root():
    for first in ((0.6, 0.0, 0.8, 0.0, 1.5), (0.8, 0.0, 0.6, 0.0, -1.5)):
        got = two_circles.roots(first, (0.0,) * 5)
        assert all(row[4] < -1e-3 for row in got)


def test_out_of_reach_an_angle_that_no_equation_holds_is_one():
    for got in two_circles.roots((0.0, 0.0, 1.0, 0.0, 3.0), (0.0, 0.0, 0.0, 1.0, 0.0)):
        c, s, x, y, margin = got
        assert margin < 0.0
        assert (x, y) == pytest.approx((1.0, 0.0), abs=4 * UNIT)
        assert math.hypot(c, s) == 1.0


def test_just_out_of_reach_the_nearest_angles_are_given():
    for got in two_circles.roots((1.0, 0.0, 0.0, 0.0, 1.00001), (0.0, 0.0, 1.0, 0.0, 1.0)):
        # the margin is of the size of what is out of reach, 1e-5
        assert got == pytest.approx((1.0, 0.0, 1.0, 0.0, -1e-5), abs=2e-5)
        assert got[4] < 0.0


def test_equations_that_both_just_reach_have_one_root():
    for got in two_circles.roots((1.0, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.0, 1.0)):
        assert got[4] == 0.0
        # a double root: the square root of rounding
        assert got[:4] == pytest.approx((1.0, 0.0, 1.0, 0.0), abs=4 * math.sqrt(2 * UNIT))


@pytest.mark.parametrize("place", range(10))
@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_nan_has_no_root(roots, place):
    numbers = [0.5, -0.25, 0.75, 0.375, 0.25, 0.125, 0.625, -0.25, 0.5, 0.375]
    numbers[place] = math.nan
    got = roots(tuple(numbers[:5]), tuple(numbers[5:]))
    assert not any(row[4] >= 0.0 for row in got)


@pytest.mark.parametrize("draw", (one_half_nearly_dependent, both_halves_nearly_dependent))
def test_in_60_digits_it_gives_60_digits(draw):
    rng = np.random.default_rng(23)
    for _ in range(5):
        equations = draw(rng)
        with mpmath.workdps(60):
            got = two_circles.roots(*(tuple(map(mpmath.mpf, row)) for row in equations))
        with mpmath.workdps(120):
            rows = [unit(row) for row in equations]
            found = [(angle(*row[:2]), angle(*row[2:4]), row[4]) for row in got]
            for root in points(*equations):
                errors = [
                    apart(x, root[0]) + apart(y, root[1]) for x, y, margin in found if margin >= 0
                ]
                fine = (cost(*rows, *root) - UNIT) * mpmath.mpf(10) ** -60 / UNIT
                assert min(errors) <= 10 * fine + mpmath.mpf(10) ** -59


def test_newton_s_step_solves_the_linear_equations_and_is_none_where_they_are_dependent():
    rng = np.random.default_rng(18)
    for _ in range(50):
        J = rng.normal(size=(2, 2))
        left = rng.normal(size=2)
        step = two_circles._newton(*left, *J.T.ravel())
        # a step of a 2 x 2 system is right to its condition times some roundings
        limit = 1e-15 * np.linalg.cond(J) * np.linalg.norm(step)
        np.testing.assert_allclose(step, np.linalg.solve(J, -left), atol=4 * limit, rtol=0)
    assert two_circles._newton(0.1, 0.2, 1.0, 2.0, 3.0, 6.0) == (0.0, 0.0)


def test_the_steepest_step_goes_along_the_gradient_to_the_least_residual():
    rng = np.random.default_rng(19)
    for _ in range(50):
        J = rng.normal(size=(2, 2))
        left = rng.normal(size=2)
        gradient = J.T @ left
        along = J @ gradient
        expected = -gradient * (left @ along) / (along @ along)
        step = two_circles._steepest(*left, *J.T.ravel())
        np.testing.assert_allclose(step, expected, rtol=1e-12)
    assert two_circles._steepest(0.1, 0.2, 0.0, 0.0, 0.0, 0.0) == (0.0, 0.0)


@pytest.mark.parametrize(("margin", "moves"), [(-0.01, False), (-1e-4, True), (0.5, True)])
def test_a_root_is_sharpened_but_where_it_is_far_from_real(margin, moves):
    rng = np.random.default_rng(20)
    for _ in range(10):
        A, B, theta, phi = halves(rng)
        first, second = through(A, B, theta, phi)
        away = (math.cos(theta + 0.01), math.sin(theta + 0.01), math.cos(phi), math.sin(phi))
        root = (*away, margin)
        found = two_circles._sharpened(first, second, root)
        assert (found != root) == moves
