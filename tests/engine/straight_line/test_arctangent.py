"""The engine's angle of a point against 40 digits."""

import math

import mpmath
import numba
import pytest
from hypothesis import example, given, target
from hypothesis import strategies as st

from poekin.engine.jit import compile as engine_compile
from poekin.engine.straight_line import arctangent
from poekin.engine.straight_line.arctangent import atan2

# absolute, in u = 2^-53: three roundings of t, of at most 1/4, are 3/4; a constant and the sum with
# it, up to pi/4, 3/4; pi as a float is wrong by 1.2, and the last sum rounds up to pi, by 2
BOUND = 4.7 * 2.0**-53

# where one of the three angles that t is measured from takes over from another, and the octants end
ENDS = [math.atan(0.5) / 2, (math.atan(0.5) + math.pi / 4) / 2, math.pi / 4, math.pi / 2, math.pi]


def error(y, x):
    with mpmath.workdps(40):
        y += 0.0  # mpmath has one zero
        return float(abs(atan2(y, x) - mpmath.atan2(mpmath.mpf(y), mpmath.mpf(x))))


@given(
    st.one_of(st.floats(-math.pi, math.pi), st.sampled_from(ENDS), st.floats(-1e-9, 1e-9)),
    st.sampled_from([1.0, 1e-100, 1e100]),
)
@example(0.0, 1.0)
def test_the_angle_is_within_a_unit_in_the_last_place_of_pi(angle, length):
    y = length * math.sin(angle)
    x = length * math.cos(angle)
    points = ((y, x), (math.nextafter(y, 1), x), (-y, -x), (x, y))
    got = max(error(*point) for point in points)
    target(got)
    assert got <= BOUND


@given(st.floats(1e-200, 0.2))
def test_a_small_angle_keeps_its_relative_digits(angle):
    # three roundings of t, and those of the series and the last product
    assert error(math.sin(angle), math.cos(angle)) <= 5 * 2.0**-53 * angle


@pytest.mark.parametrize("y, x, angle", [
    (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, math.pi / 2), (-1.0, 0.0, -math.pi / 2),
    (0.0, -1.0, math.pi), (-0.0, -1.0, -math.pi), (0.0, -0.0, math.pi),
])  # fmt: skip
def test_on_the_axes_it_is_the_library_s(y, x, angle):
    assert atan2(y, x) == angle == math.atan2(y, x)


@pytest.mark.parametrize("y, x", [(math.nan, 1.0), (1.0, math.nan), (math.nan, math.nan)])
def test_of_what_is_no_number_it_is_none(y, x):
    assert math.isnan(atan2(y, x))


def test_compiled_it_is_as_exact():
    engine_compile._register_functions(arctangent)
    compiled = numba.njit(**engine_compile.OPTIONS)(lambda y, x: atan2(y, x))
    for k in range(-500, 501):
        y = math.sin(k * math.pi / 500)
        x = math.cos(k * math.pi / 500)
        with mpmath.workdps(40):
            exact = mpmath.atan2(mpmath.mpf(y), mpmath.mpf(x))
            assert abs(compiled(y, x) - exact) <= BOUND


def test_a_term_left_out_of_the_series_is_seen(monkeypatch):
    whole = arctangent._series
    monkeypatch.setattr(arctangent, "_series", lambda z: whole(z) + z**8 / 17)
    assert error(0.236, 1.0) > BOUND
