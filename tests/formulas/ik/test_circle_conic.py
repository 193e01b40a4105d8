"""Points of the circle on a conic against roots of a polynomial in 120 digits: clusters of two to four
roots, pairs of lines, tangents, conics of lower rank, scales.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik import circle_conic
from tests.formulas.ik.circle_roots import UNIT, angle, apart, attainable, on_circle, product
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(circle_conic.roots)


def of_angles(angles, scale, rng):
    """A conic with points at these angles, rounded to floats; its part A = C = -F is arbitrary."""
    coefficients = [mpmath.mpc(1)]
    for theta in angles:
        coefficients = product(coefficients, [-mpmath.expj(theta), 1])
    coefficients = [x / mpmath.sqrt(coefficients[0]) for x in coefficients]
    if abs(coefficients[2].imag) > abs(coefficients[2].real):
        coefficients = [1j * x for x in coefficients]
    a0, a1, a2 = coefficients[2].real, coefficients[3], coefficients[4]
    C = mpmath.mpf(rng.normal())
    A = C + 4 * a2.real
    conic = (A, -4 * a2.imag, C, 2 * a1.real, -2 * a1.imag, a0 - (A + C) / 2)
    return tuple(float(scale * x) for x in conic)


def of_lines(g, h, k):
    """The conic of the lines g and h, k c^2 + k s^2 - k added."""
    M = np.outer(g, h) + np.outer(h, g)
    return (M[0, 0] + k, 2 * M[0, 1], M[1, 1] + k, 2 * M[0, 2], 2 * M[1, 2], M[2, 2] - k)


def small(rng):
    return 10.0 ** rng.uniform(-17, -1)


def any_coefficients(rng):
    return tuple(rng.normal(size=6) * 10.0 ** rng.uniform(-12, 0, size=6))


def four_points(rng):
    return of_angles(
        rng.uniform(-np.pi, np.pi, 4), 10.0 ** rng.choice([-150, -90, 0, 90, 150]), rng
    )


def double_point(rng):
    a, b, c = rng.uniform(-np.pi, np.pi, 3)
    return of_angles((a, a + small(rng), b, c), 1.0, rng)


def two_double_points(rng):
    a, b = rng.uniform(-np.pi, np.pi, 2)
    return of_angles((a, a + small(rng), b, b + small(rng)), 1.0, rng)


def triple_point(rng):
    a, b = rng.uniform(-np.pi, np.pi, 2)
    size = small(rng)
    return of_angles((a, a + size, a - size * rng.normal(), b), 1.0, rng)


def fourfold_point(rng):
    return of_angles(rng.uniform(-np.pi, np.pi) + small(rng) * rng.normal(size=4), 1.0, rng)


def lines_that_touch(rng):
    """Lines near tangents, near each other, or at infinity."""
    g, h = rng.normal(size=(2, 3))
    if rng.random() < 0.5:
        g[2] = math.hypot(g[0], g[1]) * (1 + rng.choice([-1, 0, 1]) * small(rng))
    if rng.random() < 0.5:
        h = g + small(rng) * rng.normal(size=3)
    if rng.random() < 0.2:
        h[:2] = 0.0
    return of_lines(g, h, rng.normal())


def low_rank(rng):
    """A double line, a double tangent, a constant, or coefficients with zeros."""
    g = rng.normal(size=3)
    kind = rng.integers(4)
    if kind == 0:
        return of_lines(g, g, 0.0)
    if kind == 1:
        g = np.array([0.6, 0.8, 1.0])
        return of_lines(g, g, 0.0)
    if kind == 2:
        return (*[0.0] * 5, rng.normal())
    return tuple(rng.normal(size=6) * rng.integers(0, 2, size=6))


DRAWS = (
    any_coefficients,
    four_points,
    double_point,
    two_double_points,
    triple_point,
    fourfold_point,
    lines_that_touch,
    low_rank,
)


def derivatives(conic, theta):
    """The left side and its derivatives, by frequencies 0, 1 and 2."""
    A, B, C, D, E, F = map(mpmath.mpf, conic)
    found = []
    for k in range(5):
        quarter = k * mpmath.pi / 2
        one = D * mpmath.cos(theta + quarter) + E * mpmath.sin(theta + quarter)
        two = (A - C) / 2 * mpmath.cos(2 * theta + quarter)
        two = (two + B / 2 * mpmath.sin(2 * theta + quarter)) * 2**k
        found.append(one + two + (F + (A + C) / 2 if k == 0 else 0))
    return found


def points(conic):
    A, B, C, D, E, F = map(mpmath.mpf, conic)
    one = mpmath.mpc(D, -E) / 2
    two = mpmath.mpc(A - C, -B) / 4
    both_ways = [mpmath.conj(two), mpmath.conj(one), F + (A + C) / 2, one, two]
    return on_circle(both_ways)


def rows(found):
    """Angle and margin of the four points."""
    return [(angle(found[k], found[k + 1]), found[k // 5 * 5 + 4]) for k in (0, 2, 5, 7)]


def cases(draw):
    """Conics, each with the sum of its coefficients and its points, with what rounding costs them."""
    rng = np.random.default_rng(11)
    found = []
    for _ in range(50):
        conic = tuple(map(float, draw(rng)))
        size = sum(abs(mpmath.mpf(x)) for x in conic)
        expected = [
            (theta, attainable(derivatives(conic, theta)[1:], size)) for theta in points(conic)
        ]
        found.append((conic, size, expected))
    return found


@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_no_point_is_lost_and_each_right_to_4_times_what_rounding_costs(draw):
    with mpmath.workdps(120):
        for conic, size, expected in cases(draw):
            for roots in (FLOATS, COMPILED):
                found = rows(roots(*conic))
                for theta, cost in expected:
                    errors = [apart(x, theta) for x, margin in found if margin >= 0.0]
                    assert min(errors) <= 4 * cost, (roots, conic)
                for theta, margin in found:
                    if margin >= 0.0:
                        # accepted up to 4 u, of a left side that is right to 2 u
                        left = abs(derivatives(conic, theta)[0])
                        assert left <= 6 * UNIT * size, (roots, conic)


def test_a_double_point_has_a_margin_of_0_or_parts_by_the_root_of_rounding():
    rng = np.random.default_rng(12)
    with mpmath.workdps(120):
        for _ in range(60):
            a = rng.uniform(-np.pi, np.pi)
            conic = of_angles((a, a, a + 1.0, a + 2.5), 1.0, rng)
            near = [
                (x, margin) for x, margin in rows(circle_conic.roots(*conic)) if apart(x, a) < 0.1
            ]
            assert near
            assert all(margin >= 0.0 for _, margin in near)
            assert all(apart(x, a) < 1e-6 for x, _ in near)


def test_without_a_point_every_margin_is_below_0():
    rng = np.random.default_rng(13)
    for _ in range(200):
        A, B, C, D, E = rng.normal(size=5)
        F = 1.1 * (abs(A) + abs(B) + abs(C) + abs(D) + abs(E))
        found = circle_conic.roots(A, B, C, D, E, F)
        assert max(found[4], found[9]) < 0.0


def test_a_line_that_cuts_the_circle_by_less_than_rounding_tells_no_point():
    # the line's margin is 5e-7, but between its points the left side stays above rounding
    conic = (
        0.6658473075519447, -0.6473115266993945, -0.3585621626251655,
        -2.3280048739297996, 0.6738873887054428, 1.664042204358425,
    )  # fmt: skip
    with mpmath.workdps(120):
        assert not points(conic)
    found = circle_conic.roots(*conic)
    assert max(found[4], found[9]) < 0.0


def test_every_angle_is_a_root_of_the_circle_itself():
    for conic in ((0.0,) * 6, (2.0, 0.0, 2.0, 0.0, 0.0, -2.0)):
        found = circle_conic.roots(*conic)
        assert found[4] == found[9] == 0.0
        assert all(math.hypot(found[k], found[k + 1]) == 1.0 for k in (0, 2, 5, 7))


@pytest.mark.parametrize("place", range(6))
@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_nan_has_no_root(roots, place):
    conic = [1.0, 0.3, -0.8, 0.1, -0.2, 0.05]
    conic[place] = math.nan
    found = roots(*conic)
    assert not found[4] >= 0.0
    assert not found[9] >= 0.0


def test_the_derivatives_are_those_of_the_left_side():
    rng = np.random.default_rng(14)
    for _ in range(50):
        A, B, C, D, E, F = rng.normal(size=6)
        theta = rng.uniform(-np.pi, np.pi)
        Q = (A, B / 2, C, D / 2, E / 2, F)
        got = circle_conic.derivatives(Q, math.cos(theta), math.sin(theta))
        expected = [float(x) for x in derivatives((A, B, C, D, E, F), mpmath.mpf(theta))[:3]]
        np.testing.assert_allclose(got, expected, atol=1e-14)


def test_a_step_to_the_roots_is_that_of_laguerre_and_its_real_part_where_they_are_complex():
    rng = np.random.default_rng(17)
    for value, slope, bend in rng.normal(size=(100, 3)).tolist():
        # of q(t) = value + 2 slope t + ... of degree 4 in t, by its first two derivatives
        first = 2.0 * slope
        root = np.emath.sqrt(9.0 * first**2 - 48.0 * value * (value + bend))
        below = first + math.copysign(1.0, first) * root
        expected = (-4.0 * value / below).real
        got = circle_conic._laguerre_step(value, slope, bend)
        assert got == pytest.approx(expected, rel=1e-13)


def halved(conic):
    """A, B/2, C, D/2, E/2, F, of a sum of 1/2."""
    Q = np.array(conic) / [1, 2, 1, 2, 2, 1]
    return tuple(Q / (2 * np.abs(Q).sum()))


@pytest.mark.parametrize("scale", (1.0, -1.0))
@pytest.mark.parametrize("gap", (1e-2, 1e-4, 1e-6))
def test_points_that_nearly_meet_are_parted_whichever_sign_the_equation_has(scale, gap):
    rng = np.random.default_rng(18)
    for a in rng.uniform(-np.pi, np.pi, 10):
        with mpmath.workdps(60):
            Q = halved(of_angles((a, a + gap, a + 1.3, a + 2.5), scale, rng))
        middle = a + gap / 2
        parted = circle_conic._touching(Q, math.cos(middle), math.sin(middle), 1e-9)
        assert parted[4] == 1e-9
        found = sorted(apart(angle(*pair), a) for pair in (parted[:2], parted[2:4]))
        # what rounding costs: the left side is right to some u, its slope is about the gap
        assert found == pytest.approx([0.0, gap], abs=100 * UNIT / gap)


def test_laguerre_s_steps_end_before_the_left_side_would_become_larger():
    """Where there is no point it never is 0: it becomes smaller, and in the end is kept."""
    rng = np.random.default_rng(19)
    for _ in range(100):
        A, B, C, D, E = rng.normal(size=5)
        F = 1.1 * (abs(A) + abs(B) + abs(C) + abs(D) + abs(E))
        Q = halved((A, B, C, D, E, F))
        theta = rng.uniform(-np.pi, np.pi)
        c, s = math.cos(theta), math.sin(theta)
        values = [circle_conic.derivatives(Q, c, s)[0]]
        while len(values) < 3 or values[-1] != values[-2]:
            assert len(values) < 200
            c, s, left = circle_conic._laguerre(Q, c, s, 16.0)
            assert left == circle_conic.derivatives(Q, c, s)[0]
            assert 0.0 < left <= values[-1]
            values.append(left)


def test_points_less_sharp_are_right_to_rounding_of_the_pencil():
    """100 u where no points meet: what is left to the rule that sharpens both angles of `two_circles`."""
    rng = np.random.default_rng(15)
    with mpmath.workdps(120):
        for _ in range(100):
            a = rng.uniform(-np.pi, np.pi)
            conic = of_angles((a, a + 0.8, a + 2.0, a - 1.5), 1.0, rng)
            A, B, C, D, E, F = conic
            found = rows(circle_conic.points((A, B / 2, C, D / 2, E / 2, F), 2.0**-6))
            size = sum(map(abs, conic))
            for theta, margin in found:
                assert margin > 0.0
                assert abs(derivatives(conic, theta)[0]) <= 100 * UNIT * size


@pytest.mark.parametrize(
    "draw, seed", [(fourfold_point, 74), (fourfold_point, 2665), (lines_that_touch, 1985)]
)
def test_less_sharp_points_that_nearly_meet_are_taken_to_that_sharpness(draw, seed):
    A, B, C, D, E, F = conic = tuple(map(float, draw(np.random.default_rng([seed, 5]))))
    with mpmath.workdps(120):
        assert len(points(conic)) == 4
        for theta, margin in rows(circle_conic.points((A, B / 2, C, D / 2, E / 2, F), 2.0**-6)):
            assert margin > 0.0
            # 64 u of the largest of coefficients whose sum is 1 / 2, twice for what is taken
            left = abs(derivatives(conic, theta)[0])
            assert left <= 128 * UNIT * sum(map(abs, conic))


@pytest.mark.parametrize("draw", (any_coefficients, four_points, lines_that_touch))
def test_in_60_digits_it_gives_60_digits(draw):
    rng = np.random.default_rng(16)
    for _ in range(10):
        conic = tuple(map(float, draw(rng)))
        with mpmath.workdps(60):
            found = circle_conic.roots(*map(mpmath.mpf, conic))
        with mpmath.workdps(120):
            size = sum(abs(mpmath.mpf(x)) for x in conic)
            for theta in points(conic):
                tail = derivatives(conic, theta)[1:]
                cost = attainable(tail, size * mpmath.mpf(10) ** -60 / UNIT) - UNIT
                error = min(apart(x, theta) for x, margin in rows(found) if margin >= 0)
                assert error <= 4 * cost + mpmath.mpf(10) ** -60
