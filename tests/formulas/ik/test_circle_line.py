"""Points of the circle on a line against roots of a polynomial in 120 digits; tangents, scales."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas import elementary
from poekin.formulas.ik import circle_line
from tests.formulas.ik.circle_roots import UNIT, angle, apart, attainable, laurent, on_circle
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(circle_line.roots)
EXPONENT = st.floats(-150.0, 150.0)
DIRECTION = st.floats(-math.pi, math.pi)
# how far the line is from a tangent, as a power of ten and a side
TANGENT = st.tuples(st.floats(-18.0, 0.0), st.sampled_from((-1.0, 1.0, 0.0)))


@st.composite
def lines(draw):
    """Lines of all directions and scales, many of them nearly tangents."""
    size = 10.0 ** draw(EXPONENT)
    turn = draw(DIRECTION)
    power, side = draw(TANGENT)
    d = size * (1.0 - side * 10.0**power) * draw(st.sampled_from((-1.0, 1.0)))
    return size * math.cos(turn), size * math.sin(turn), d


def points(a, b, d):
    """Angles of the points, each with what rounding costs it."""
    found = []
    for theta in on_circle(laurent(a, b, -mpmath.mpf(d))):
        c, s = mpmath.cos(theta), mpmath.sin(theta)
        derivatives = [b * c - a * s, -a * c - b * s]
        found.append((theta, attainable(derivatives, abs(a) + abs(b) + abs(d))))
    return found


@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
@given(line=lines())
def test_every_point_is_found_to_4_times_what_rounding_costs(roots, line):
    c, s, cosine, sine, margin = roots(*line)
    with mpmath.workdps(120):
        for theta, cost in points(*line):
            error = min(apart(angle(c, s), theta), apart(angle(cosine, sine), theta))
            assert margin >= 0.0
            assert error <= 4 * cost


@given(line=lines())
def test_a_point_of_a_margin_of_0_and_above_solves_to_rounding_and_another_is_nearest(line):
    c, s, cosine, sine, margin = circle_line.roots(*line)
    a, b, d = map(mpmath.mpf, line)
    with mpmath.workdps(120):
        r = mpmath.hypot(a, b)
        for point in ((c, s), (cosine, sine)):
            left = a * point[0] + b * point[1] - d
            if margin >= 0.0:  # 16 u from the margin, and the point's own rounding
                assert abs(left) <= 24 * UNIT * r
            else:
                assert abs(abs(left) - (abs(d) - r)) <= 8 * UNIT * abs(d)
            assert abs(mpmath.hypot(*point) - 1) <= 4 * UNIT


def test_a_double_root_has_margin_0_and_one_point():
    for turn in np.linspace(-3.0, 3.0, 200):
        a, b = math.cos(turn), math.sin(turn)
        found = circle_line.roots(a, b, math.hypot(a, b))
        assert 0.0 <= found[4] <= 2 * UNIT
        assert math.dist(found[:2], found[2:4]) <= 4 * math.sqrt(UNIT)


@pytest.mark.parametrize("a, b, d", [(3.0, 4.0, 5.0), (3.0, 4.0, -5.0), (0.0, 2.0, 2.0)])
def test_of_an_exact_tangent_the_point_is_exact(a, b, d):
    r = math.hypot(a, b)
    point = (a * d / r**2, b * d / r**2)
    assert circle_line.roots(a, b, d) == (*point, *point, 0.0)


def test_without_a_direction_any_angle_serves_or_none():
    assert circle_line.roots(0.0, 0.0, 0.0)[4] == 0.0
    assert circle_line.roots(0.0, 0.0, 1e-300)[4] == -1.0


@pytest.mark.parametrize("place", range(3))
@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_nan_has_no_root(roots, place):
    line = [0.3, -0.4, 0.1]
    line[place] = math.nan
    assert math.isnan(roots(*line)[4])


@pytest.mark.parametrize("d", (0.1, 0.5, -0.5, 0.49999))
def test_in_60_digits_it_gives_60_digits(d):
    with mpmath.workdps(60):
        a, b, d = mpmath.mpf("0.3"), mpmath.mpf("-0.4"), mpmath.mpf(d)
        c, s, cosine, sine, margin = circle_line.roots(a, b, d)
        assert margin >= 0
        for x, y in ((c, s), (cosine, sine)):
            assert abs(a * x + b * y - d) < mpmath.mpf(10) ** -59
