"""Four numbers at once: each is what it would be alone."""

import math
import operator

import numba
import numpy as np
import pytest

from poekin.engine.jit import compile as engine_compile
from poekin.engine.lanes import rows as lanes
from poekin.engine.straight_line import arctangent
from poekin.engine.straight_line.arctangent import atan2
from poekin.formulas import elementary
from poekin.formulas.ik.elimination import resultant
from poekin.formulas.inverse import least_squares

A = np.array([0.5, -1.5, 2.0, 0.0])
B = np.array([0.25, 3.0, 2.0, -0.5])


def compiled(function):
    return numba.njit(**engine_compile.OPTIONS)(function)


@pytest.mark.parametrize(
    "function",
    [operator.add, operator.sub, operator.mul, operator.truediv],
    ids=lambda f: f.__name__,
)
def test_operators_take_each_number_by_itself(function):
    def both(a, b, out):
        x = lanes.rows(a)[0]
        y = lanes.rows(b)[0]
        rows = lanes.rows(out)
        rows[0] = function(x, y)
        rows[1] = function(x, 1.5)
        rows[2] = function(2, y)

    out = np.empty(12)
    compiled(both)(A, B, out)
    expected = np.concatenate([function(A, B), function(A, 1.5), function(2, B)])
    np.testing.assert_array_equal(out, expected)


def test_functions_take_each_number_by_itself():
    def each(a, b, out):
        x = lanes.rows(a)[0]
        y = lanes.rows(b)[0]
        rows = lanes.rows(out)
        rows[0] = abs(x)
        rows[1] = elementary.sqrt(abs(x))
        rows[2] = elementary.where_less(x, y, x, 7.0)
        rows[3] = -x
        rows[4] = math.copysign(2.0, x)
        rows[5] = math.copysign(y, x)

    out = np.empty(24)
    compiled(each)(A, B, out)
    expected = [abs(A), np.sqrt(abs(A)), np.where(A < B, A, 7.0), -A]
    expected += [np.copysign(2.0, A), np.copysign(B, A)]
    np.testing.assert_array_equal(out, np.concatenate(expected))


def test_of_nan_the_second_number_is_taken_as_of_one_alone():
    def taken(a, out):
        lanes.rows(out)[0] = elementary.where_less(lanes.rows(a)[0], 0.0, 1.0, 2.0)

    out = np.empty(4)
    compiled(taken)(np.array([math.nan, -1.0, 1.0, 0.0]), out)
    assert out.tolist() == [2.0, 1.0, 2.0, 2.0]


def test_a_sum_that_begins_with_a_number_goes_on_with_four():
    def total(a, out):
        rows = lanes.rows(a)
        total = 0.0
        for k in range(2):
            total += rows[k]
        lanes.rows(out)[0] = total

    out = np.empty(4)
    compiled(total)(np.concatenate([A, B]), out)
    np.testing.assert_array_equal(out, A + B)


def test_rows_may_begin_anywhere_in_an_array():
    def copied(a, out):
        lanes.rows(out)[0] = lanes.rows(a[1:])[0]

    out = np.empty(4)
    compiled(copied)(np.arange(6.0), out)
    assert out.tolist() == [1.0, 2.0, 3.0, 4.0]


def test_plain_python_takes_one_at_once_and_compiled_code_four():
    assert lanes.at_once() == 1
    assert lanes.rows(A) is A
    assert lanes.table(A) is A
    assert compiled(lambda: lanes.at_once())() == 4


def test_a_formula_of_four_matrices_is_that_of_each():
    def together(A, M, out):
        lanes.rows(out)[0] = resultant.factor(lanes.rows(A), lanes.rows(M))

    A = np.random.default_rng(0).normal(size=(4, 54))
    A[1, 0] = 0.0  # one whose rows are exchanged where those of others are not
    out = np.empty(4)
    # the k-th numbers of all matrices lie beside each other
    compiled(together)(A.T.ravel(), np.empty(4 * 81), out)
    expected = [resultant.factor(list(map(float, row)), [0.0] * 81) for row in A]
    # products and sums are fused or not
    np.testing.assert_allclose(out, expected, rtol=1e-11)


def test_angles_of_four_points_are_those_of_each():
    engine_compile._register_functions(arctangent)

    def angles(y, x, out):
        lanes.rows(out)[0] = atan2(lanes.rows(y)[0], lanes.rows(x)[0])

    out = np.empty(4)
    compiled(angles)(A, B, out)
    # as exact as the angle of one point, tests/engine/straight_line/test_arctangent.py
    np.testing.assert_allclose(out, np.arctan2(A, B), rtol=0, atol=6e-16)


@pytest.mark.parametrize("count", [3, 6])
def test_equations_of_four_arms_are_solved_as_those_of_each(count):
    def together(J, e, free, H, g):
        equations = lanes.table(H)
        unknowns = lanes.rows(g)
        n = len(free)
        least_squares.normal_equations(
            lanes.table(J), lanes.rows(e), np.ones(6), 0.5, free, n, equations, unknowns
        )
        least_squares.solve(equations, unknowns, n)

    rng = np.random.default_rng(count)
    J = rng.normal(size=(4, 6, count))
    e = rng.normal(size=(4, 6))
    free = np.ones(count)
    free[1] = 0.0
    g = np.empty(4 * count)
    matrix = np.ascontiguousarray(J.transpose(1, 2, 0)).reshape(6, 4 * count)
    compiled(together)(matrix, e.T.ravel(), free, np.empty((count, 4 * count)), g)
    for k in range(4):
        H = np.empty((count, count))
        one = np.empty(count)
        least_squares.normal_equations(J[k], e[k], np.ones(6), 0.5, free, count, H, one)
        least_squares.solve(H, one, count)
        # damped, so of a condition of some tens: products and sums are fused or not
        np.testing.assert_allclose(g[k::4], one, rtol=0, atol=1e-13)
    assert (g[4:8] == 0.0).all()
