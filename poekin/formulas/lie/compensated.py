"""Rounding errors of a length, a quotient or a sum, for a formula to put back to first order.

A number is split in two: its upper digits, of which products and sums of squares are exact, and the
rest. To add
2^27 s and take it away again rounds to the last digit of 2^27 s; that product is exact, so it makes
no difference whether a processor fuses it with the sum, and none of this needs a fused
multiplication.
Accuracy: a result is right to 2^-24 of itself and 2^-76 of what it was taken from
(tests/formulas/lie/test_compensated.py).
Source: Dekker 1971, but split at a common unit, where the squares of three numbers add up without
rounding.
"""

from .. import elementary

_HALF = 134217728.0  # 2^27: half of the 53 digits


def upper(x, size):
    """x rounded to a multiple of the last digit of 2^27 size, where abs(x) <= abs(size): at most 26
    digits.
    """
    large = _HALF * size
    return (x + large) - large


def square_rest(w, t, tt):
    """|w|^2 - tt of a vector of which t is the length and tt the square of the length, both to
    rounding.
    """
    x = upper(w[0], t)
    y = upper(w[1], t)
    z = upper(w[2], t)
    below = (w[0] - x) * (w[0] + x) + (w[1] - y) * (w[1] + y) + (w[2] - z) * (w[2] + z)
    return (x * x + y * y + z * z - tt) + below


def quotient_rest(a, q, b):
    """a - q b where q is a / b to rounding."""
    qu = upper(q, q)
    bu = upper(b, b)
    return (a - qu * bu) - (qu * (b - bu) + (q - qu) * b)


def sum_rest(a, b, total):
    """a + b - total where total is a + b to rounding."""
    of_b = total - a
    return (a - (total - of_b)) + (b - of_b)


def length(w, tt):
    """(t, dt, rest): t = sqrt(tt), where tt is |w|^2 to rounding; t + dt is |w|, and tt + rest its
    square.
    """
    t = elementary.sqrt(tt)
    rest = square_rest(w, t, tt)
    return t, 0.5 / t * (rest + quotient_rest(tt, t, t)), rest
