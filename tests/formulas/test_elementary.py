"""The functions that formulas take from their scalar's kind."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace

import mpmath
import pytest

from poekin.formulas import elementary

POINTS = [-0.9, -0.3, 0.0, 0.25, 1.0]


@pytest.mark.parametrize("x", POINTS)
def test_of_floats_they_are_the_standard_library_s(x):
    assert elementary.sqrt(x * x) == math.sqrt(x * x)
    assert elementary.sin(x) == math.sin(x)
    assert elementary.cos(x) == math.cos(x)
    assert elementary.asin(x) == math.asin(x)
    assert elementary.atan2(x, -0.5) == math.atan2(x, -0.5)


@pytest.mark.parametrize("a, b, expected", [(1.0, 2.0, 3.0), (2.0, 2.0, 4.0), (math.nan, 0.0, 4.0)])
def test_of_two_numbers_the_first_is_taken_where_others_are_in_order(a, b, expected):
    assert elementary.where_less(a, b, 3.0, 4.0) == expected


@pytest.mark.parametrize("x", [-0.5, -2.0, math.nan])
def test_a_float_without_a_square_root_has_nan_as_in_compiled_code(x):
    assert math.isnan(elementary.sqrt(x))


@pytest.mark.parametrize("x", [-math.inf, math.inf, math.nan])
def test_an_angle_that_is_not_finite_has_neither_sine_nor_cosine(x):
    assert math.isnan(elementary.sin(x))
    assert math.isnan(elementary.cos(x))


@pytest.mark.parametrize("x", [-1.0 - 2e-16, 1.0 + 3e-16, math.inf, math.nan])
def test_what_is_no_sine_has_no_angle(x):
    assert math.isnan(elementary.asin(x))


@pytest.mark.parametrize("x", POINTS)
def test_a_kind_with_its_own_functions_takes_these(x):
    elementary.provide(mpmath.mpf, mpmath.mp, series=False)
    with mpmath.workdps(50):
        y = mpmath.mpf(x)
        assert elementary.asin(y) == mpmath.asin(y)
        assert abs(mpmath.sin(elementary.asin(y)) - y) < 1e-49
        assert elementary.atan2(y, y - 2) == mpmath.atan2(y, y - 2)
        assert elementary.sqrt(y * y) == abs(y)


def test_small_arguments_take_the_series_unless_a_kind_does_without():
    class Few(Fraction):
        pass

    elementary.provide(Few, SimpleNamespace(), series=False)
    assert elementary.below(0.5, 1.0)
    assert not elementary.below(1.0, 1.0)
    assert elementary.takes_series(0.5)
    assert not elementary.takes_series(Few(1, 2))
    assert not elementary.below(Few(1, 2), 1.0)
    assert elementary.below(Few(0), 1.0)
