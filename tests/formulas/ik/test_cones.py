"""Two rotations that bring two vectors together against roots of a polynomial in 120 digits; axes
that are nearly parallel, cones that touch.
"""

from __future__ import annotations

import functools
import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik import cones
from tests.formulas.ik.circle_roots import UNIT, angle, apart, laurent, on_circle
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(cones.roots)


def small(rng):
    return 10.0 ** rng.uniform(-12, 0)


def vector(v):
    return [mpmath.mpf(float(x)) for x in v]


def unit(v):
    size = mpmath.sqrt(mpmath.fdot(v, v))
    return [x / size for x in v]


def across(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def turned(k, theta, a):
    """Rodrigues, in many digits."""
    ka = across(k, a)
    along = mpmath.fdot(k, a) * (1 - mpmath.cos(theta))
    return [
        mpmath.cos(theta) * x + mpmath.sin(theta) * y + along * z
        for x, y, z in zip(a, ka, k, strict=True)
    ]


def back(k, theta, m, phi, z):
    """k, a, m, b of two rotations that give z."""
    a = turned(unit(vector(k)), -mpmath.mpf(theta), vector(z))
    b = turned(unit(vector(m)), -mpmath.mpf(phi), vector(z))
    return tuple(tuple(float(x) for x in v) for v in (k, a, m, b))


def any_vectors(rng):
    k, m, z = rng.normal(size=(3, 3))
    size = 10.0 ** rng.choice([-60, 0, 60])
    return back(*problem(k, m, rng), z * size)


def problem(k, m, rng):
    return (
        k / np.linalg.norm(k),
        rng.uniform(-np.pi, np.pi),
        m / np.linalg.norm(m),
        rng.uniform(-np.pi, np.pi),
    )


def nearly_parallel_axes(rng):
    k = rng.normal(size=3)
    m = rng.choice([-1.0, 1.0]) * (k + 1e-3 * small(rng) * rng.normal(size=3))
    return back(*problem(k, m, rng), rng.normal(size=3))


def cones_that_touch(rng):
    """z in the plane of both axes, or nearly so."""
    k, m = rng.normal(size=(2, 3))
    z = rng.normal() * k + rng.normal() * m + rng.choice([0.0, small(rng)]) * np.cross(k, m)
    return back(*problem(k, m, rng), z)


DRAWS = (any_vectors, nearly_parallel_axes, cones_that_touch)


def roots(k, a, m, b):
    """Angles theta of m . e^{[k] theta} a = m . b, with what rounding costs; sizes are taken out."""
    size = mpmath.sqrt(mpmath.fdot(a, a))
    along = mpmath.fdot(m, k) * mpmath.fdot(k, a)
    A, B = mpmath.fdot(m, a) - along, mpmath.fdot(m, across(k, a))
    found = []
    for theta in on_circle(laurent(A, B, along - mpmath.fdot(m, b))):
        slope = B * mpmath.cos(theta) - A * mpmath.sin(theta)
        bend = A * mpmath.cos(theta) + B * mpmath.sin(theta)
        costs = [2 * UNIT * size / abs(slope)] if slope else []
        costs += [mpmath.sqrt(4 * UNIT * size / abs(bend))] if bend else []
        found.append((theta, min(costs, default=mpmath.inf) + UNIT))
    return found


@functools.cache
def cases(draw):
    """Problems, each with the angles theta; axes are floats, and units to rounding."""
    rng = np.random.default_rng(41)
    found = []
    for _ in range(100):
        k, a, m, b = draw(rng)
        exact = unit(vector(k)), vector(a), unit(vector(m)), vector(b)
        found.append(((k, a, m, b), exact, roots(*exact)))
    return found


@pytest.mark.parametrize("function", (FLOATS, COMPILED), ids=("floats", "compiled"))
@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_no_root_is_lost_and_each_right_to_4_times_what_rounding_costs(draw, function):
    with mpmath.workdps(120):
        for given, exact, expected in cases(draw):
            found = function(*given)
            margin = found[8]
            k, a, m, b = exact
            width = min(mpmath.sqrt(mpmath.fdot(v, v)) for v in (across(k, a), across(m, b)))
            width = width / mpmath.sqrt(mpmath.fdot(a, a))
            for theta, cost in expected:
                if cost < 1e-2 and width > 1e-2:
                    assert margin >= 0.0
                    errors = [apart(angle(*found[i : i + 2]), theta) for i in (0, 4)]
                    assert min(errors) <= 4 * cost / width


@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_both_rotations_bring_the_vectors_together(draw):
    with mpmath.workdps(120):
        for given, (k, a, m, b), _ in cases(draw):
            found = cones.roots(*given)
            size = mpmath.sqrt(mpmath.fdot(a, a))
            sine = mpmath.sqrt(mpmath.fdot(across(k, m), across(k, m)))
            for i in (0, 4):
                if found[8] > 0.0:
                    p = turned(k, angle(*found[i : i + 2]), a)
                    q = turned(m, angle(*found[i + 2 : i + 4]), b)
                    gap = max(abs(x - y) for x, y in zip(p, q, strict=True)) / size
                    # of the circles' crossing, gamma |k x m|, and of the axes' sine
                    assert gap <= 16 * UNIT * (1 + 1 / mpmath.sqrt(found[8])) / sine


def test_circles_that_pass_each_other_have_a_margin_below_0_and_turn_into_the_axes_plane():
    k, m = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
    a, b = (0.1, 0.1, 0.9), (0.9, 0.1, -0.1)
    found = cones.roots(k, a, m, b)
    assert found[8] < 0.0
    assert found[:4] == found[4:8]
    radius = math.hypot(0.1, 0.1)
    np.testing.assert_allclose(
        [found[0] * 0.1 - found[1] * 0.1, found[1] * 0.1 + found[0] * 0.1],
        [radius, 0.0],
        atol=1e-15,
    )


@pytest.mark.parametrize("sign", (1.0, -1.0))
def test_of_parallel_axes_one_of_a_continuum_is_given_or_none(sign):
    k, m = (0.0, 0.0, 1.0), (0.0, 0.0, sign)
    found = cones.roots(k, (0.6, 0.8, 0.5), m, (-1.0, 0.0, 0.5))
    assert found[8] == 0.0
    np.testing.assert_allclose(found[:4], (-0.6, 0.8, 1.0, 0.0), atol=1e-15)
    assert cones.roots(k, (0.6, 0.8, 0.5), m, (-1.0, 0.0, 0.4))[8] == -1.0


def test_a_vector_of_length_0_is_where_it_is():
    zero = (0.0, 0.0, 0.0)
    assert cones.roots((0.0, 0.0, 1.0), zero, (1.0, 0.0, 0.0), zero)[8] == 0.0


@pytest.mark.parametrize("place", range(12))
@pytest.mark.parametrize("function", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_nan_has_no_root(function, place):
    numbers = [0.0, 0.6, 0.8, 1.0, 2.0, 2.0, 1.0, 0.0, 0.0, 2.0, 1.0, 2.0]
    numbers[place] = math.nan
    vectors = (tuple(numbers[i : i + 3]) for i in (0, 3, 6, 9))
    assert not function(*vectors)[8] >= 0.0


def test_in_60_digits_it_gives_60_digits():
    with mpmath.workdps(60):
        k, m = unit(vector((1, 2, 2))), unit(vector((3, 0, 4)))
        z = vector((1, -2, 1))
        a, b = turned(k, mpmath.mpf("0.3"), z), turned(m, mpmath.mpf("-1.1"), z)
        found = cones.roots(tuple(k), tuple(a), tuple(m), tuple(b))
        errors = [abs(angle(*found[i : i + 2]) + mpmath.mpf("0.3")) for i in (0, 4)]
        assert min(errors) < mpmath.mpf(10) ** -57
