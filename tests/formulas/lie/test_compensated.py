"""What rounding took, against the same in exact arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from poekin.formulas.lie.compensated import quotient_rest, square_rest, sum_rest, upper
from tests.formulas.kinds import both

rng = np.random.default_rng(7)
SIZES = 10.0 ** rng.integers(-100, 100, 40)
PAIRS = [(float(a), float(b)) for a, b in (rng.normal(size=(40, 2)) * SIZES[:, None])]
VECTORS = [
    tuple(map(float, v))
    for v in rng.normal(size=(40, 3)) * 10.0 ** rng.integers(-8, 1, (40, 3)) * SIZES[:, None]
]


def right(got, exact, scale):
    return abs(Fraction(got) - exact) <= abs(exact) * Fraction(1, 2**24) + scale * Fraction(
        1, 2**76
    )


@pytest.mark.parametrize("function", both(square_rest), ids=["floats", "compiled"])
def test_the_rest_of_a_square(function):
    for v in VECTORS:
        t = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        square = sum(Fraction(x) ** 2 for x in v)
        assert right(function(v, t, t * t), square - Fraction(t * t), square)


@pytest.mark.parametrize("function", both(quotient_rest), ids=["floats", "compiled"])
def test_the_rest_of_a_quotient(function):
    for a, b in PAIRS:
        assert right(
            function(a, a / b, b), Fraction(a) - Fraction(a / b) * Fraction(b), abs(Fraction(a))
        )


@pytest.mark.parametrize("function", both(sum_rest), ids=["floats", "compiled"])
def test_the_rest_of_a_sum_is_exact(function):
    for a, b in PAIRS:
        for x, y in ((a, b), (b, a), (a, -a / 3)):
            assert Fraction(function(x, y, x + y)) == Fraction(x) + Fraction(y) - Fraction(x + y)


@pytest.mark.parametrize("function", both(upper), ids=["floats", "compiled"])
def test_squares_of_upper_digits_add_up_exactly(function):
    for v in VECTORS:
        t = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        h = [function(x, t) for x in v]
        assert Fraction(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) == sum(Fraction(x) ** 2 for x in h)
        assert all(abs(x - y) <= t * 2.0**-25 for x, y in zip(h, v, strict=True))
