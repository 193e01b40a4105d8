"""Two lengths against those that the equations were made of, and their residuals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.slides import two_lines

U = 2.0**-53
SEEDS = st.integers(0, 2**32 - 1)


def equations(seed, square):
    rng = np.random.default_rng(seed)
    t, w = rng.uniform(-2, 2, 2)
    first, second = rng.uniform(-1, 1, (2, 5))
    first[[1, 3]] = 0.0
    second[[1, 3]] = square, -square
    x = np.array([t, t * t, w, w * w])
    first[4], second[4] = first[:4] @ x, second[:4] @ x
    return tuple(first.tolist()), tuple(second.tolist()), t, w


def smallest_slope(first, second, t, w):
    J = [[e[0] + 2 * e[1] * t, e[2] + 2 * e[3] * w] for e in (first, second)]
    return np.linalg.svd(np.array(J))[1][-1]


@given(SEEDS, st.sampled_from([0.0, 0.5]))
def test_the_lengths_that_equations_were_made_of_are_found(seed, square):
    first, second, t, w = equations(seed, square)
    slope = smallest_slope(first, second, t, w)
    leading = square * abs(first[2] ** 2 - first[0] ** 2)
    if slope < 1e-2 or 0 < leading < 1e-2 or first[0] ** 2 + first[2] ** 2 < 1e-2:
        return  # nearly double, or one root far away
    rows = np.array(two_lines.roots(first, second))
    rows = rows[rows[:, 4] > 0]
    away = np.abs(rows[:, [0, 2]] - [t, w]).max(axis=1, initial=0)
    assert len(away)
    # rounding of a quadratic whose leading coefficient is 1e-2 or more, over the slope
    assert away.min() <= 1e4 * U / slope
    for x, _, y, _, _ in rows:
        size = 1 + x * x + y * y
        for e in (first, second):
            residual = e[0] * x + e[1] * x * x + e[2] * y + e[3] * y * y - e[4]
            assert abs(residual) <= 1e4 * U * size


def test_two_linear_equations_have_one_row():
    first, second, _, _ = equations(1, 0.0)
    one, none = two_lines.roots(first, second)
    assert one[4] > 0
    assert none[4] == -two_lines.NO_ROW


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((1.0, 0.0, 2.0, 0.0, 1.0), (2.0, 0.0, 4.0, 0.0, 3.0)),
        ((0.0, 0.0, 0.0, 0.0, 1.0), (1.0, 0.5, 1.0, -0.5, 1.0)),
        ((1.0, 0.0, 1.0, 0.0, 0.0), (1.0, 0.5, 1.0, -0.5, 1.0)),
    ],
    ids=["parallel", "nothing in the first", "no length left"],
)
def test_equations_that_do_not_tell_both_lengths_have_no_margin(first, second):
    assert all(row[4] <= -1.0 for row in two_lines.roots(first, second))


def test_slides_that_lie_alike_have_one_solution():
    # t = 1 - w, and t + t^2 / 2 - w^2 / 2 = 1 is then linear in w
    one, none = two_lines.roots((1.0, 0.0, 1.0, 0.0, 1.0), (1.0, 0.5, 0.0, -0.5, 1.0))
    t, w = one[0], one[2]
    assert t == pytest.approx(0.75, abs=4 * U)
    assert w == pytest.approx(0.25, abs=4 * U)
    assert none[4] == -two_lines.NO_ROW


@pytest.mark.parametrize("squares", [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)])
def test_of_one_square_alone_both_roots_solve_both_equations(squares):
    K, L = squares
    # of which t = 1/2 and w = 1/4 is one
    second = (0.5, K, -1.0, L, 0.25 * K + 0.0625 * L)
    for t, _, w, _, margin in two_lines.roots((1.0, 0.0, 2.0, 0.0, 1.0), second):
        assert margin > 0.0
        size = (1 + abs(t) + abs(w)) ** 2
        # a root of the quadratic to 4 u, and some roundings of sums of that size
        assert abs(t + 2 * w - 1) <= 8 * U * size
        assert abs(0.5 * t + K * t * t - w + L * w * w - second[4]) <= 16 * U * size


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_slides_that_lie_alike_are_told_whichever_way_they_point(side):
    one, _ = two_lines.roots((side, 0.0, side, 0.0, 1.0), (side, 0.5, 0.0, -0.5, 1.0))
    assert (one[0], one[2]) == pytest.approx((0.75 * side, 0.25 * side), abs=4 * U)


@pytest.mark.parametrize("d", [-3.0, -2.0, -0.5, 3.0])
def test_slides_that_lie_alike_are_told_on_either_side_of_where_they_are_parallel(d):
    # t = d - w, and t + t^2 / 2 - w^2 / 2 = 1 is (1 + d) w = d + d^2 / 2 - 1
    one, none = two_lines.roots((1.0, 0.0, 1.0, 0.0, d), (1.0, 0.5, 0.0, -0.5, 1.0))
    w = (d + d * d / 2 - 1) / (1 + d)
    # lengths of up to 3, whose sums and quotient round a few times
    assert (one[0], one[2]) == pytest.approx((d - w, w), abs=16 * U)
    assert one[4] > 0
    assert none[4] == -two_lines.NO_ROW
