"""The one home of small angles: the coefficients of exp, log and their Jacobians as functions of
theta.

    A = sin t / t        B = (1 - cos t) / t^2     C = (1 - A) / t^2
    E = (t/2) cot(t/2)   D = (1 - E) / t^2         and B'/t, C'/t, D'/t

A and E cancel nowhere. B and C subtract nearly equal numbers when t is small: there they are one
Taylor polynomial in t^2, B below t = 1, C and the derivatives below t = 2, where the closed form
still loses a factor of 10. exp takes the polynomials of B and C below t = 1 alone, which are
shorter there. D and D'/t are sums of partial fractions,

    D = sum over k of 2 / ((2 pi k)^2 - t^2)        D'/t = sum over k of 4 / ((2 pi k)^2 - t^2)^2,

of which two stand as they are, and the rest is a polynomial in t^2 for every t < 2 pi: none of that
cancels.
Accuracy: what it has to be for the bounds of exp, log and their Jacobians, which
tests/groups/test_accuracy.py holds
on both sides of every switch.
"""

from fractions import Fraction
from math import comb, factorial

from .. import elementary

# t^2 below which B, and in exp C too, is its polynomial: from t = 1 on 1 - cos t loses no digit.
NEAR = 1.0
SWITCH = 4.0  # t^2 below which C is its polynomial, and the derivatives, which cancel more: t = 2
_TURN = Fraction("39.478417604357434475337963999504604541254797628963162505653398")  # (2 pi)^2
_NEGLIGIBLE = Fraction(1, 10**20)  # relative to the first term, at the switch


def _bernoulli(most):
    """The Bernoulli numbers B_0 ... B_most, exact."""
    numbers = []
    for n in range(most + 1):
        below = sum((comb(n + 1, k) * numbers[k] for k in range(n)), start=Fraction(0))
        numbers.append(Fraction(1) if n == 0 else -below / (n + 1))
    return numbers


def _series(term, most=SWITCH):
    """Coefficients of t^0, t^2, ... as the nearest floats, as far as they matter where t^2 is
    `most`.
    """
    terms = [term(0)]
    k = 1
    while abs(term(k)) * int(most) ** k > _NEGLIGIBLE * abs(terms[0]):
        terms.append(term(k))
        k += 1
    return tuple(float(value) for value in terms)


_B = _bernoulli(60)


def _c(k):
    return Fraction((-1) ** k, factorial(2 * k + 3))


B_NEAR = _series(lambda k: Fraction((-1) ** k, factorial(2 * k + 2)), NEAR)
C_NEAR = _series(_c, NEAR)
C_SERIES = _series(_c)


def _beyond_poles(k):
    """Rest of D's coefficient of t^2k behind its first two poles."""
    return abs(_B[2 * k + 2]) / factorial(2 * k + 2) - (2 + Fraction(2, 4 ** (k + 1))) / _TURN ** (
        k + 1
    )


def _derivative_term(k, order):
    """Coefficient of t^2k of B'/t (order 4) and C'/t (order 5)."""
    return Fraction(
        (-1) ** (k + 1) * 2 * (k + 1),
        factorial(2 * k + order),
    )


FIRST = float(_TURN)
SECOND = 4 * float(_TURN)
FIRST_REST = float(_TURN - Fraction(FIRST))
D_SERIES = _series(_beyond_poles, FIRST)
B_DERIVATIVE_SERIES = _series(lambda k: _derivative_term(k, 4))
C_DERIVATIVE_SERIES = _series(lambda k: _derivative_term(k, 5))
D_DERIVATIVE_SERIES = _series(lambda k: 2 * (k + 1) * _beyond_poles(k + 1), FIRST)


def polynomial(coefficients, x):
    """The sum of coefficients[k] x^k by Horner's rule."""
    total = coefficients[len(coefficients) - 1]
    for k in range(len(coefficients) - 2, -1, -1):
        total = total * x + coefficients[k]
    return total


def _two_chains(coefficients, x):
    """Sum of a series by Horner's rule for even and odd k apart: two short chains of operations for
    a long one.
    """
    return polynomial(coefficients[0], x * x) + x * polynomial(coefficients[1], x * x)


_D_CHAINS, _D_DERIVATIVE_CHAINS = (
    (series[0::2], series[1::2]) for series in (D_SERIES, D_DERIVATIVE_SERIES)
)


def b_near(tt):
    """B from t^2 < 1."""
    return polynomial(B_NEAR, tt)


def c_near(tt):
    """C from t^2 < 1."""
    return polynomial(C_NEAR, tt)


def b_of(tt, t):
    """B = (1 - cos t) / t^2 from t^2 and t."""
    if elementary.below(tt, NEAR):
        return b_near(tt)
    return (1.0 - elementary.cos(t)) / tt


def e_of(t):
    """E = (t/2) cot(t/2), for t < 2 pi."""
    half = 0.5 * t
    if half != 0:
        return half * elementary.cos(half) / elementary.sin(half)
    return t + 1.0


def c_of(tt, a):
    """C = (1 - A) / t^2 from t^2 and A."""
    if elementary.below(tt, SWITCH):
        return polynomial(C_SERIES, tt)
    return (1.0 - a) / tt


def _beside_poles(tt, rest):
    """First term of D = 2 / ((2 pi)^2 - t^2 - rest) + ..., and the sum of the others."""
    return 2.0 / (FIRST - tt + (FIRST_REST - rest)), 2.0 / (SECOND - tt) + _two_chains(
        _D_CHAINS,
        tt,
    )


def d_of(tt):
    """D = (1 - E) / t^2 from t^2, for t < 2 pi: the coefficient of Lemma 4, 1/12 at 0 and 1/pi^2 at
    pi.
    """
    if not elementary.takes_series(tt):
        if tt != 0:
            return (1.0 - e_of(elementary.sqrt(tt))) / tt
        return (tt + 1.0) / 12.0
    first, others = _beside_poles(tt, 0.0)
    return first + others


def d_and_e(tt, rest):
    """D and E from t^2 = tt + rest, for t < 2 pi."""
    if not elementary.takes_series(tt):
        d = d_of(tt)
        return d, 1.0 - tt * d
    first, others = _beside_poles(tt, rest)
    return first + others, 1.0 - tt * first - (tt * others + rest * first)


def b_derivative(tt, a, b):
    """B'/t = (A - 2 B) / t^2."""
    if elementary.below(tt, SWITCH):
        return polynomial(B_DERIVATIVE_SERIES, tt)
    return (a - 2.0 * b) / tt


def c_derivative(tt, b, c):
    """C'/t = (B - 3 C) / t^2."""
    if elementary.below(tt, SWITCH):
        return polynomial(C_DERIVATIVE_SERIES, tt)
    return (b - 3.0 * c) / tt


def d_derivative(tt):
    """D'/t = (1/(2 B) + E - 2) / t^4 from t^2, for t < 2 pi."""
    if not elementary.takes_series(tt):
        t = elementary.sqrt(tt)
        if tt != 0:
            return (0.5 / b_of(tt, t) + e_of(t) - 2.0) / (tt * tt)
        return (tt + 1.0) / 360.0
    first = 2.0 / (FIRST - tt + FIRST_REST)
    second = 2.0 / (SECOND - tt)
    return first * first + (second * second + _two_chains(_D_DERIVATIVE_CHAINS, tt))
