"""The engine's sine and cosine against 40 digits."""

import math
from fractions import Fraction

import mpmath
import pytest
from hypothesis import example, given, target
from hypothesis import strategies as st

from poekin.engine.straight_line import sincos as sincos_module
from poekin.engine.straight_line.sincos import MODERATE, sincos

BOUND = 2.3e-16  # absolute; half a unit in the last place of 1 is 1.1e-16


def error(x):
    with mpmath.workdps(40):
        s, c = sincos(x)
        return float(max(abs(s - mpmath.sin(mpmath.mpf(x))), abs(c - mpmath.cos(mpmath.mpf(x)))))


@given(
    st.one_of(
        st.floats(-10, 10),
        st.floats(-MODERATE, MODERATE),
        st.integers(-600000, 600000).map(lambda k: k * math.pi / 2),
    )
)
@example(math.nextafter(MODERATE, 0))
@example(355.0)  # 226 times pi/2, missed by 3e-5
def test_sine_and_cosine_are_within_a_unit_in_the_last_place_of_one(x):
    got = error(x)
    target(got)
    assert got <= BOUND


@given(st.floats(min_value=math.nextafter(MODERATE, 2e6), max_value=1e300))
def test_beyond_the_moderate_angles_they_are_the_library_s(x):
    assert sincos(x) == (math.sin(x), math.cos(x))


def test_zero_and_nan():
    assert sincos(0.0) == (0.0, 1.0)
    assert all(map(math.isnan, sincos(math.nan)))


@pytest.mark.parametrize("turn", [1, 10**5])
def test_the_sine_of_a_tiny_angle_keeps_its_relative_digits(turn):
    assert sincos(1e-300)[0] == 1e-300
    x = math.tau * turn
    assert sincos(x)[0] == pytest.approx(float(mpmath.sin(mpmath.mpf(x))), abs=BOUND)


def test_the_parts_of_a_right_angle_leave_multiples_exact_and_together_have_117_bits():
    high, middle, low = map(Fraction, sincos_module._split(sincos_module._HALF_PI))
    for part in (high, middle):
        assert part.numerator.bit_length() <= 33 + 1  # of a number below 2
    # what is left of 66 bits behind the point, and its rounding to 53 of its own
    assert 0 <= low < Fraction(1, 2**66)
    assert middle < Fraction(1, 2**33)
    assert abs(sincos_module._HALF_PI - high - middle - low) <= Fraction(1, 2**119)
