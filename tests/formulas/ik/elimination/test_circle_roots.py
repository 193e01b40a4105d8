"""Real roots of trigonometric polynomials: all of them, against products of known factors."""

import math
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import circle_roots, line_equations

ROOM = circle_roots.ROOM
K = np.arange(1, 9)


def collected(f, noise, is_whole=True):
    """Angles and slopes (n, 2) of all roots, or of those not on the opposite side."""
    f = [*map(float, f)]
    b = [0.0] * (circle_roots.LENGTH * circle_roots.ARCS)
    found = [math.nan] * (circle_roots.FIELDS * ROOM)
    circle_roots.on_arcs(circle_roots.POLAR_FORMS, circle_roots.CENTRES, f, b, circle_roots.ARCS)
    count = circle_roots.brackets(b, noise, [0.0] * circle_roots.SCRATCH, found, is_whole)
    assert np.isfinite(np.reshape(found, (-1, ROOM))[:, :count]).all()
    return np.array([polished(f, found, k) for k in range(count)]).reshape(-1, 2)


def polished(f, found, k):
    steepest = circle_roots.steepest(f)
    for _ in range(circle_roots.STEPS):
        step, slope = circle_roots.newton(f, found, k, ROOM)
        if circle_roots.is_found(step, slope, steepest):
            break
    c, s = circle_roots.half_of_root(found, k, ROOM)
    return 2 * np.arctan2(s, c), slope


def with_roots(roots, rest):
    """Coefficients of the product of sin((x - r) / 2) over an even number of roots, and of 2 + cos
    of the rest: by values at 64 angles and their mean, which is exact to rounding.
    """
    x = 2 * pi * np.arange(64) / 64
    values = np.ones(64)
    for r in roots:
        values *= np.sin(0.5 * (x - r))
    for r in rest:
        values *= 2 + np.cos(x - r)
    values /= np.abs(values).max()
    a = 2 / 64 * np.cos(np.outer(K, x)) @ values
    b = 2 / 64 * np.sin(np.outer(K, x)) @ values
    f = np.empty(17)
    f[0] = values.mean()
    f[1::2] = a
    f[2::2] = b
    return f


def apart(a, b):
    return np.abs((a[:, None] - b[None] + pi) % (2 * pi) - pi)


@given(st.integers(0, 8), st.integers(0, 2**32 - 1))
def test_every_root_of_a_product_is_found_and_no_other(pairs, seed):
    rng = np.random.default_rng(seed)
    roots = rng.uniform(-pi, pi, 2 * pairs)
    gaps = apart(roots, roots) + 9 * np.eye(2 * pairs)
    if gaps.min(initial=9) < 0.03:  # nearer roots of 16 are lost in rounding
        return
    f = with_roots(roots, rng.uniform(-pi, pi, 8 - pairs))
    found = collected(f, 1e-15)
    slopes = np.abs(
        [circle_roots.value_and_slope(f, np.cos(r), np.sin(r))[1] for r in roots] or [1.0]
    )
    if slopes.min() < 1e-11:
        return
    assert len(found) == 2 * pairs
    if pairs:
        # rounding of some 64 terms of at most 1, over the slope
        assert (apart(roots, found[:, 0]).min(axis=1) <= 64 * 2e-16 / slopes + 1e-15).all()


@pytest.mark.parametrize("k", [0, 3])
@pytest.mark.parametrize("start, end", [(-0.3, 2), (0.3, 3)])
def test_a_step_leaves_the_root_between_the_ends_of_a_smaller_bracket(k, start, end):
    f = [0.0, 0.0, 1.0, *[0.0] * 14]  # sin, whose root in the middle of -1 and 1 is 0
    rows = np.zeros((circle_roots.FIELDS, ROOM))
    rows[:, k] = [1.0, 0.0, -1.0, 1.0, start, -1.0]  # the sign at the lower end is last
    found = rows.ravel().tolist()
    circle_roots.newton(f, found, k, ROOM)
    after = np.reshape(found, rows.shape)
    rows[end, k] = start
    rows[4, k] = after[4, k]
    np.testing.assert_array_equal(after, rows)  # the other end, and every other root, as it was
    assert after[2, k] <= 0.0 <= after[3, k]


@pytest.mark.parametrize("at", [0.0923, 0.0923 + pi / 4, 1.0, -3.0])
def test_a_double_root_is_found_once_and_is_flat(at):
    # 1 - cos(x - at), at ends of arcs too, within rounding of its touching 0
    f = np.zeros(17)
    f[0] = 1
    f[1] = -np.cos(at)
    f[2] = -np.sin(at)
    found = collected(f, 1e-15)
    assert len(found) == 1
    # f is below the noise within sqrt(2e-15) of the root
    assert apart(found[:, 0], np.array([at])).max() <= 1e-6
    assert abs(found[0, 1]) <= 1e-6


@pytest.mark.parametrize("simple", [(4.0, 5.0), (0.5, 4.0), (0.5, 1.0)])
def test_a_double_root_is_found_once_after_any_number_of_simple_ones(simple):
    # a product of three factors, of which the double one curves by more than 0.1 beside its root
    f = with_roots([*simple, 2.5, 2.5], [])
    # sums of 64 values of at most 1 lift f off 0 by some u
    found = collected(f, 1e-14)
    assert len(found) == 3
    # f is below the noise within sqrt(2e-14 / 0.1) of the double root
    assert apart(np.array([*simple, 2.5]), found[:, 0]).min(axis=1).max() <= 1e-6


def test_a_root_at_the_end_of_an_arc_is_found_once():
    at = 0.0923
    f = np.zeros(17)
    f[1] = -np.sin(at)
    f[2] = np.cos(at)
    found = collected(f, 1e-15)
    assert len(found) == 2
    assert apart(found[:, 0], np.array([at, at + pi])).min(axis=1).max() <= 1e-12


def test_roots_on_the_opposite_side_are_left_out_where_they_are_not_asked_for():
    roots = np.array([-2.26, -1.0, 0.2, 2.25, 2.6, 3.1, 3.5, 3.9])
    f = with_roots(roots, [0.0, 1.0, 2.0, 3.0])
    found = collected(f, 1e-15, is_whole=False)[:, 0]
    assert apart(found, roots[:4]).min(axis=1).max() <= 1e-9
    assert len(found) == 4
    assert len(collected(f, 1e-15)) == 8


def test_values_at_the_samples_tell_the_coefficients_and_what_is_beyond_them():
    rng = np.random.default_rng(0)
    f = rng.normal(size=17)
    x = 2 * pi * np.arange(circle_roots.SAMPLES) / circle_roots.SAMPLES
    values = f[0] + f[1::2] @ np.cos(np.outer(K, x)) + f[2::2] @ np.sin(np.outer(K, x))
    back = [0.0] * circle_roots.COEFFICIENTS
    circle_roots.fourier(circle_roots.WAVES, list(values), back, circle_roots.COEFFICIENTS)
    size, noise = circle_roots.size_and_noise(back)
    # twenty sums of seventeen terms of size 1
    assert noise <= 20 * 17 * 2.3e-16
    assert np.abs(back[:17] - f).max() <= 20 * 17 * 2.3e-16
    assert size == np.abs(back[:17]).max()
    assert circle_roots.size_and_noise([0.1 * x for x in back])[0] == 0.1 * size
    beyond = list(values + 0.1 * np.cos(9 * x))
    circle_roots.fourier(circle_roots.WAVES, beyond, back, circle_roots.COEFFICIENTS)
    assert circle_roots.size_and_noise(back)[1] >= 0.09


@pytest.mark.parametrize("steepest", [0.25, 2.0])
def test_a_step_is_the_last_where_half_of_f_s_second_derivative_leaves_little(steepest):
    # |f''| <= 8 steepest, and 1e-17 is little
    step = 1e-6
    most = circle_roots.DEGREE * steepest * step**2 / 1e-17
    for sign in (1, -1):
        assert circle_roots.is_found(step, sign * 1.01 * most, steepest)
        assert not circle_roots.is_found(-step, sign * 0.99 * most, steepest)
    assert circle_roots.is_found(1e-15, 0.0, steepest)
    assert circle_roots.is_found(-4e-16, 0.0, steepest)
    assert not circle_roots.is_found(1.1e-15, 0.0, steepest)


def test_coefficients_of_no_number_have_no_size_and_no_noise():
    # so a target that is not finite is told as one whose coefficients are all zero
    assert circle_roots.size_and_noise([math.nan] * circle_roots.COEFFICIENTS) == (0.0, 0.0)


@pytest.mark.parametrize("arc", range(circle_roots.ARCS))
def test_coefficients_on_an_arc_begin_and_end_with_the_values_at_its_ends(arc):
    f = [*map(float, np.random.default_rng(2).normal(size=17))]
    width = circle_roots.ARCS
    b = [0.0] * (circle_roots.LENGTH * width)
    circle_roots.on_arcs(circle_roots.POLAR_FORMS, circle_roots.CENTRES, f, b, width)
    centre = np.arctan2(circle_roots.CENTRES[width + arc], circle_roots.CENTRES[arc])
    for end, j in ((-1, 0), (1, circle_roots.LENGTH - 1)):
        x = centre + end * pi / width
        expected, _ = circle_roots.value_and_slope(f, np.cos(x), np.sin(x))
        # some seventeen terms of size 1
        assert abs(b[width * j + arc] - expected) <= 100 * 2.3e-16 * 17


def test_halves_are_points_of_half_of_each_sample_s_angle():
    x = pi * np.arange(circle_roots.SAMPLES) / circle_roots.SAMPLES
    np.testing.assert_allclose(circle_roots.HALVES, [*np.cos(x), *np.sin(x)], rtol=0, atol=1e-15)


def test_rows_that_are_done_four_numbers_at_once_have_fours_of_them():
    for width in (circle_roots.COEFFICIENTS, circle_roots.ARCS, ROOM, line_equations.ROOM):
        assert width % 4 == 0


def test_the_steepest_slope_is_the_sum_of_what_each_order_has():
    f = np.random.default_rng(3).normal(size=2 * circle_roots.DEGREE + 1)
    each = [k * np.hypot(*f[2 * k - 1 : 2 * k + 1]) for k in range(1, circle_roots.DEGREE + 1)]
    # of some 20 products and roots, each rounded by 1.2e-16 of itself
    assert circle_roots.steepest(f) == pytest.approx(sum(each), rel=1e-14)


@pytest.mark.parametrize("sign", (1, -1))
def test_a_first_guess_is_where_the_coefficients_joined_by_lines_pass_0(sign):
    last = circle_roots.LENGTH - 1
    for place in (0.25, 1.5, last - 0.125):
        b = [math.nan, *(sign * (place - j) for j in range(last + 1))]
        assert circle_roots._crossing(b, 1) == place / last
