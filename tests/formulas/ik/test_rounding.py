"""Comparisons that know the rounding of floats and of 60 digits."""

from __future__ import annotations

import math

import mpmath
import pytest

from poekin.formulas.ik.rounding import is_rounding, least, told


@pytest.mark.parametrize("size", (1.0, 1e-150, 3.7, 1e150))
def test_rounding_is_up_to_half_a_unit_of_the_size(size):
    assert is_rounding(0.0, size)
    assert all(is_rounding(sign * 2.0**-55 * size, size) for sign in (1.0, -1.0))
    assert not any(is_rounding(sign * 2.0**-51 * size, size) for sign in (1.0, -1.0))


def test_both_signs_are_rounding_or_neither():
    # above 1 floats are twice as far apart as below
    assert [is_rounding(sign * 0.75 * 2.0**-53, 1.0) for sign in (1.0, -1.0)] == [False, False]


def test_of_60_digits_it_is_the_sixtieth():
    with mpmath.workdps(60):
        assert is_rounding(mpmath.mpf(10) ** -62, mpmath.mpf(1))
        assert not is_rounding(mpmath.mpf(10) ** -58, mpmath.mpf(1))


@pytest.mark.parametrize("x, size", [(math.nan, 1.0), (0.0, math.nan), (math.inf, 1.0)])
def test_nan_is_no_rounding(x, size):
    assert not is_rounding(x, size)


@pytest.mark.parametrize("x, y", [(1.0, 2.0), (2.0, 1.0), (-1.0, -1.0)])
def test_the_least_of_two(x, y):
    assert least(x, y) == min(x, y)


@pytest.mark.parametrize("x, y", [(math.nan, 1.0), (1.0, math.nan)])
def test_the_least_is_nan_where_one_is(x, y):
    assert math.isnan(least(x, y))


@pytest.mark.parametrize("size", [1e-100, 1e-3, 1.0, 1e6])
def test_coefficients_are_told_that_are_more_than_rounding_of_their_terms(size):
    row = tuple(size * x for x in (1e-14, 5e-16, -5e-16, -1e-14, 1e-16))
    assert told(row, size) == (row[0], 0.0, 0.0, row[3], row[4])


def test_an_equation_of_rounding_says_nothing_or_what_is_left():
    noise = (1e-15, 0.0, -1e-15, 0.0)
    for left, rest in ((5e-15, 0.0), (-5e-15, 0.0), (2e-14, 1e-14), (0.5, 0.25), (-1.0, -0.5)):
        assert told((*noise, left), 2.0) == (0.0, 0.0, 0.0, 0.0, rest)
    assert told((0.0, 0.0, 0.0, 0.0, 0.0), 0.0) == (0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("off", [0.0, 1e-14, -1e-14, 1e-12])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_equation_of_one_circle_touches_it_to_rounding_of_its_terms(off, sign):
    d = sign * (0.5 + off)
    rest = d if off == 1e-12 else sign * 0.5
    assert told((0.3, -0.4, 1e-16, 0.0, d), 8.0) == (0.3, -0.4, 0.0, 0.0, rest)
    assert told((0.0, 0.0, 0.4, 0.3, d), 8.0)[4] == rest
    # of both circles' points no single one is the nearest
    both = (0.3, 0.0, 0.0, 0.4, d)
    assert told(both, 8.0) == both
