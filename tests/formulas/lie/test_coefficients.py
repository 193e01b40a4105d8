"""The coefficients of exp, log and their Jacobians against their definitions in 100 digits, beside
every switch.
"""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from poekin.formulas import elementary
from poekin.formulas.lie import coefficients

U = 2.0**-53
# The relative error in u, from 0 to 2 and from there to pi. Below 2 a polynomial whose first term
# is nearly all of it rounds once or twice, as does a sine; the closed forms beyond lose what their
# difference is smaller than its terms.
BOUNDS = {
    "A": (2, 2), "B": (4, 4), "C": (3, 4), "E": (4, 4), "D": (3, 3), "B'/t": (3, 10), "C'/t": (3, 30),
    "D'/t": (6, 6),
}  # fmt: skip
SERIES = {
    "B": coefficients.B_NEAR,
    "C": coefficients.C_SERIES,
    "C near": coefficients.C_NEAR,
    "D": coefficients.D_SERIES,
    "B'/t": coefficients.B_DERIVATIVE_SERIES,
    "C'/t": coefficients.C_DERIVATIVE_SERIES,
    "D'/t": coefficients.D_DERIVATIVE_SERIES,
}


def defined(t):
    """Each coefficient by its definition, slopes as derivatives by t."""
    t = mpf(t)
    A, B, E = mpmath.sin(t) / t, (1 - mpmath.cos(t)) / t**2, t / 2 * mpmath.cot(t / 2)
    C, D = (1 - A) / t**2, (1 - E) / t**2
    slopes = {
        "B'/t": (A - 2 * B) / t**2,
        "C'/t": (B - 3 * C) / t**2,
        "D'/t": (1 / (2 * B) + E - 2) / t**4,
    }
    return {"A": A, "B": B, "C": C, "E": E, "D": D, **slopes}


def computed(t):
    tt, a, e = t * t, elementary.sin(t) / t if t else 1.0, coefficients.e_of(t)
    b, c, d = coefficients.b_of(tt, t), coefficients.c_of(tt, a), coefficients.d_of(tt)
    slopes = {
        "B'/t": coefficients.b_derivative(tt, a, b),
        "C'/t": coefficients.c_derivative(tt, b, c),
        "D'/t": coefficients.d_derivative(tt),
    }
    return {"A": a, "B": b, "C": c, "E": e, "D": d, **slopes}


BELOW = [
    1e-12,
    1e-3,
    *np.geomspace(0.05, 0.99, 12),
    0.9999999,
    1.0,
    *np.linspace(1.01, 1.99, 12),
    2 - 1e-15,
]
BEYOND = [2.0, 2 + 1e-15, *np.linspace(2.05, math.pi, 14)]


@pytest.mark.parametrize("side, angles", [(0, BELOW), (1, BEYOND)], ids=["below 2", "beyond"])
def test_a_coefficient_is_its_definition_to_a_few_roundings(side, angles):
    with mpmath.workdps(100):
        for t in map(float, angles):
            exact, got = defined(t), computed(t)
            wrong = {k: float(abs(got[k] - exact[k]) / abs(exact[k])) / U for k in exact}
            assert all(wrong[k] <= BOUNDS[k][side] for k in wrong), f"t = {t!r}: {wrong}"


@pytest.mark.parametrize("t", [1e-9, 0.5, 1.0, 1.5, 3.0])
def test_the_coefficients_are_even(t):
    assert coefficients.e_of(-t) == coefficients.e_of(t)
    assert coefficients.b_of(t * t, -t) == pytest.approx(coefficients.b_of(t * t, t), rel=1e-15)


@pytest.mark.parametrize("t", ["1e-6", "0.1", "1.9", "2.1"])
def test_numbers_of_many_digits_take_the_closed_forms(t):
    """A polynomial of floats would leave them sixteen digits."""
    elementary.provide(mpf, mpmath.mp, series=False)
    with mpmath.workdps(100):
        exact, got = defined(t), computed(mpf(t))
        # of 100 digits the slopes lose 36 at 1e-6
        assert all(abs(got[k] - exact[k]) < mpf(10) ** -50 * abs(exact[k]) for k in exact)


def test_the_slopes_are_derivatives():
    """Of B, C and D by t, divided by t: what their names in `defined` say."""
    with mpmath.workdps(60):
        for name in "BCD":
            slope = mpmath.diff(lambda t, name=name: defined(t)[name], 1.3) / mpf(1.3)
            assert abs(slope - defined(1.3)[f"{name}'/t"]) < 1e-15


@pytest.mark.parametrize("number", [0, 0.0, Fraction(0)], ids=repr)
def test_at_zero_the_coefficients_are_their_limits(number):
    assert coefficients.e_of(number) == 1
    assert coefficients.b_of(number, number) == 0.5
    zero = computed(0.0)
    limits = {"C": 1 / 6, "D": 1 / 12, "B'/t": -1 / 12, "C'/t": -1 / 60, "D'/t": 1 / 360}
    assert all(
        abs(zero[k] - limit) <= (BOUNDS[k][0] if k[0] == "D" else 1) * U * abs(limit)
        for k, limit in limits.items()
    )


def test_at_zero_of_many_digits_the_coefficients_are_their_limits_to_a_float():
    elementary.provide(mpf, mpmath.mp, series=False)
    limits = {
        "A": 1,
        "B": 0.5,
        "C": 1 / 6,
        "E": 1,
        "D": 1 / 12,
        "B'/t": -1 / 12,
        "C'/t": -1 / 60,
        "D'/t": 1 / 360,
    }
    found = computed(mpf(0))
    assert {k: float(found[k]) for k in limits} == pytest.approx(limits, rel=2 * U)
    assert tuple(map(float, coefficients.d_and_e(mpf(0), 0.0))) == pytest.approx(
        (1 / 12, 1), rel=2 * U
    )
    half = mpf(0.5)
    assert coefficients.d_and_e(half, 0.0) == (
        coefficients.d_of(half),
        1 - half * coefficients.d_of(half),
    )


def exact_series(count=40):
    """Power series in t^2 of C, D without its first two poles, and the slopes, from those of sine
    and cosine.
    """
    sine = [Fraction((-1) ** k, math.factorial(2 * k + 1)) for k in range(count)]  # of sin t / t
    cosine = [Fraction((-1) ** k, math.factorial(2 * k)) for k in range(count)]
    E: list[Fraction] = []  # cos h / (sin h / h) with h = t/2, term by term
    for k in range(count):
        E.append(cosine[k] / 4**k - sum(E[i] * sine[k - i] / 4 ** (k - i) for i in range(k)))
    B, C, D = ([-x for x in series[1:]] for series in (cosine, sine, E))
    with mpmath.workdps(60):
        turn = Fraction(int(4 * mpmath.pi**2 * 10**50), 10**50)
    # without 2 / (turn - t^2) and 2 / (4 turn - t^2), the poles of the cotangent at 2 pi and 4 pi
    D = [x - 2 / turn ** (k + 1) - 2 / (4 * turn) ** (k + 1) for k, x in enumerate(D)]
    slopes = [[2 * k * x for k, x in enumerate(series)][1:] for series in (B, C, D)]
    return dict(
        zip(("B", "C", "C near", "D", "B'/t", "C'/t", "D'/t"), (B, C, C, D, *slopes), strict=True)
    )


EXACT = exact_series()


@pytest.mark.parametrize("name", SERIES)
def test_each_number_of_a_series_is_the_nearest_float(name):
    series = SERIES[name]
    assert series == tuple(map(float, EXACT[name][: len(series)]))


@pytest.mark.parametrize("name", SERIES)
def test_a_series_ends_where_its_terms_no_longer_matter(name):
    """At its switch every term above 1e-20 of the first is there, and one more at most."""
    n, first = len(SERIES[name]), abs(EXACT[name][0])
    square = 1 if name.endswith("near") or name == "B" else 39 if name[0] == "D" else 4
    sizes = [abs(x) * square**k / first for k, x in enumerate(EXACT[name])]
    assert sizes[n] <= Fraction(1, 10**20) < sizes[n - 1]


def test_the_bernoulli_numbers_are_those_of_mpmath():
    assert len(coefficients._bernoulli(24)) == 25
    for n, got in enumerate(coefficients._bernoulli(24)):
        exact = Fraction(*map(int, mpmath.bernfrac(n)))
        assert got == exact


def test_a_polynomial_is_the_sum_of_its_terms():
    assert coefficients.polynomial((2, 3, 5, 7), 10) == 7532
    assert coefficients.polynomial((2,), 10) == 2
