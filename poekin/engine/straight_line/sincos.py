"""Sine and cosine of one angle together, without a table: a third of the library's time.

The angle loses a multiple k of pi/2, which stands here in three parts of which k times the first
two is exact; what is left, |r| <= pi/4, goes through both Taylor polynomials. Beyond `MODERATE` the
library's functions serve.
Absolute error at most 2.3e-16 (tests/engine/straight_line/test_sincos.py).
"""

import math
from fractions import Fraction

from ...formulas import elementary
from ...formulas.lie.coefficients import polynomial

MODERATE = 1e6  # rad; up to here k < 2^20
_HALF_PI = Fraction(314159265358979323846264338327950288419716939937510, 2 * 10**50)
_BITS = 2**33


def _split(x):
    """x as the sum of two parts of 33 bits and the nearest float to the rest."""
    high = Fraction(math.floor(x * _BITS), _BITS)
    middle = Fraction(math.floor((x - high) * _BITS**2), _BITS**2)
    return float(high), float(middle), float(x - high - middle)


_HIGH, _MIDDLE, _LOW = _split(_HALF_PI)
_PER_HALF_PI = float(1 / _HALF_PI)
_ROUND = 6755399441055744.0  # 1.5 * 2^52: there the last digit of a float is 1
_SINE = tuple(float(Fraction((-1) ** k, math.factorial(2 * k + 1))) for k in range(1, 9))
_COSINE = tuple(float(Fraction((-1) ** k, math.factorial(2 * k))) for k in range(2, 10))


def sincos(x):
    """(sin x, cos x) of an angle in rad."""
    if not abs(x) <= MODERATE:
        return elementary.sin(x), elementary.cos(x)
    return moderate(x)


def moderate(x):
    """(sin x, cos x) where abs(x) <= MODERATE: without a branch, so that a loop over many angles
    takes four at once.
    """
    k = rounded(x * _PER_HALF_PI)
    r = ((x - k * _HIGH) - k * _MIDDLE) - k * _LOW
    z = r * r
    s = r + r * (z * polynomial(_SINE, z))
    c = 1.0 - (0.5 * z - z * z * polynomial(_COSINE, z))
    half = rounded(0.5 * k - 0.25)  # k = 2 half + odd
    odd = k - 2.0 * half
    sign = 1.0 - 2.0 * (half - 2.0 * rounded(0.5 * half - 0.25))
    return sign * (c if odd > 0.0 else s), sign * (-s if odd > 0.0 else c)


def rounded(x):
    """The integer nearest to x, abs(x) < 2^51, as a float."""
    return (x + _ROUND) - _ROUND
