"""The angle of a point in the first quadrant with what rounding took from it: atan2 without a call.

The point is turned back by 0, pi/4 or pi/2, so that the tangent t of what is left is at most 1/2;
there a polynomial serves: with q = tan(atan(1/2)/2) = sqrt(5) - 2,

    atan t = sum over n of 2 (-1)^n q^(2n+1) / (2n+1) T_(2n+1)(2 t),   T the Chebyshev polynomials,

whose terms fall like 18^-n, and in powers of t none of them cancels another.
Accuracy: with its rest the angle is right to 2 u of itself (tests/formulas/lie/test_arctangent.py),
u = 2^-53.
Source: the Chebyshev series of atan (Clenshaw 1962).
"""

from math import atan, comb, tan

from .. import elementary
from .coefficients import polynomial

_RIGHT = 1.5707963267948966  # pi/2 as a float, and what is missing
_RIGHT_REST = 6.123233995736766e-17
_Q = 0.2360679774997897
_TERMS = 14  # the next one is below 2^-58 of t


def _coefficient(k, q, stretch, terms):
    """The coefficient of t^(2k+1) in so many terms of the series for |t| <= 2 / stretch = tan(2 atan
    q).
    """
    total = sum(comb(n + k, 2 * k) * q ** (2 * n + 1) for n in range(k, terms))
    return (-1) ** k * stretch ** (2 * k + 1) / (2 * k + 1) * total


# that of t itself is 1; odd and even k apart: two short chains of operations take less time than a
# long one
ODD_SERIES = tuple(_coefficient(k, _Q, 4.0, _TERMS) for k in range(1, _TERMS, 2))
EVEN_SERIES = tuple(_coefficient(k, _Q, 4.0, _TERMS) for k in range(2, _TERMS, 2))

NARROW = 0.2360679774997897
NARROW_SERIES = tuple(
    _coefficient(k, tan(0.5 * atan(NARROW)), 2.0 / NARROW, 9) for k in range(1, 9)
)
"""Coefficients of t^3, t^5, ..., t^17 where |t| is at most sqrt(5) - 2, `NARROW`; the next term is
below 2^-62.
"""


def _reduce_angle(y, x):
    """(y', x', c, rest): the point turned back by c = 0, pi/4 or pi/2, and stretched, so that
    abs(y') <= x'/2.
    """
    if 2.0 * y <= x:
        return y, x, 0.0, 0.0
    if y <= 2.0 * x:
        return y - x, y + x, 0.5 * _RIGHT, 0.5 * _RIGHT_REST
    return -x, y, _RIGHT, _RIGHT_REST


def angle(y, x):
    """(angle, rest) of the point (x, y), y >= 0 and x >= 0, in rad; rest is what rounding took."""
    if not elementary.takes_series(y):
        return elementary.atan2(y, x), y - y
    y, x, start, start_rest = _reduce_angle(y, x)
    t = y / x
    tt = t * t
    beyond = t * tt * (polynomial(ODD_SERIES, tt * tt) + tt * polynomial(EVEN_SERIES, tt * tt))
    first = start + t
    rest = (start - first + t) + (beyond + start_rest)
    total = first + rest
    return total, first - total + rest
