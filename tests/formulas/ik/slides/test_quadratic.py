"""Roots of a quadratic against the roots that it was made of, and in 60 digits."""

from __future__ import annotations

import mpmath
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.slides import quadratic

U = 2.0**-53
SIZE = st.floats(-9, 9).map(lambda k: 10.0**k)
NUMBER = st.builds(lambda sign, x: sign * x, st.sampled_from([-1.0, 1.0]), SIZE)


@given(NUMBER, st.one_of(NUMBER, st.just(0.0)), st.one_of(NUMBER, st.just(0.0)))
def test_roots_are_right_to_rounding_however_unlike_they_are(k, h, e):
    x, y, margin = quadratic.roots(k, h, e)
    with mpmath.workdps(60):
        K, H, E = map(mpmath.mpf, (k, h, e))
        square = H * H - K * E
        if margin <= 0:
            # no real root but by the rounding of the two products
            assert square <= 2 * U * (H * H + abs(K * E))
            return
        w = mpmath.sqrt(square)
        far = -(H + (w if H >= 0 else -w))
        # w^2 is right to 2 u of its terms, w to that over 2 w^2 of itself, and far is no smaller
        bound = 4 * U + 2 * U * (H * H + abs(K * E)) / square
        assert abs(x - far / K) <= bound * abs(far / K)
        assert abs(y - E / far) <= bound * abs(E / far)


def test_the_margin_is_0_at_a_double_root_and_both_are_it():
    assert quadratic.roots(2.0, -6.0, 18.0) == (3.0, 3.0, 0.0)
    assert quadratic.roots(5.0, 0.0, 0.0) == (0.0, 0.0, 0.0)


def test_where_there_is_no_root_both_are_the_lowest_point():
    x, y, margin = quadratic.roots(2.0, -6.0, 40.0)
    assert x == y == 3.0
    assert margin < 0.0
