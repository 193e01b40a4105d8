"""The angle of a point against 60 digits, as floats and compiled."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.lie.arctangent import NARROW, NARROW_SERIES, angle
from tests.formulas.kinds import both

UNIT = 2.0**-53
SWITCHES = (0.5, 2.0)  # of y / x
TANGENTS = [
    *np.random.default_rng(3).uniform(0, 4, 300),
    *10.0 ** np.arange(-150.0, 151.0, 10.0),
    *(math.nextafter(s, end) for s in SWITCHES for end in (0.0, s, 9.0)),
]


@pytest.fixture(params=both(angle), ids=["floats", "compiled"])
def function(request):
    return request.param


def error(function, y, x):
    """Of the angle with its rest, relative; and the rest, relative."""
    total, rest = function(y, x)
    with mpmath.workdps(60):
        truth = mpmath.atan2(y, x)
        return float(abs(mpmath.mpf(total) + mpmath.mpf(rest) - truth) / truth), abs(rest) / total


def test_the_angle_with_its_rest_is_right_to_2_units(function):
    errors = [error(function, float(y), x) for y in TANGENTS for x in (1.0, 0.7)]
    assert max(e for e, _ in errors) < 2 * UNIT
    assert max(rest for _, rest in errors) <= UNIT


def test_from_1_rad_on_it_is_right_to_half_a_unit(function):
    assert (
        max(error(function, float(y), 1.0)[0] for y in TANGENTS if y > math.tan(1.0)) < 0.5 * UNIT
    )


def test_on_the_axes_and_between_them_it_is_exact(function):
    assert function(0.3, 0.3) == (math.pi / 4, 6.123233995736766e-17 / 2)
    assert function(0.0, 0.3) == (0.0, 0.0)
    assert function(0.3, 0.0) == (math.pi / 2, 6.123233995736766e-17)


def test_the_narrow_series_is_right_to_a_quarter_of_a_unit():
    # the first term of Chebyshev's series that is left out had a part in t's own coefficient, which
    # is taken as 1: q^19 2 / NARROW = 0.14 u, q = tan(atan(NARROW) / 2); others add 0.02 u at most
    with mpmath.workdps(60):
        for share in (1.0, 0.9, 0.5, 0.1, -1.0):
            t = share * mpmath.mpf(NARROW)
            series = sum(c * t ** (2 * k) for k, c in enumerate(NARROW_SERIES, 1))
            assert abs(1 + series - mpmath.atan(t) / t) < UNIT / 4


@pytest.mark.parametrize("y, x", [(0, 1), (0.3, 0.4), (1, 0), (3, 1)])
def test_of_many_digits_nothing_is_rounded_away(y, x):
    elementary.provide(mpmath.mpf, mpmath.mp, series=False)
    with mpmath.workdps(60):
        assert angle(mpmath.mpf(y), mpmath.mpf(x)) == (mpmath.atan2(y, x), 0)


@pytest.mark.parametrize("point", [(math.nan, 1.0), (1.0, math.nan)])
def test_the_angle_of_nan_is_nan(function, point):
    assert math.isnan(function(*point)[0])
