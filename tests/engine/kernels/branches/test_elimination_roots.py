"""Roots of the determinant of elimination, as plain Python: views of it, and all roots with slopes."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from poekin.engine.kernels.branches import elimination_kernels
from poekin.engine.kernels.branches import elimination_roots as module
from poekin.formulas import elementary
from poekin.formulas.ik.elimination import line_equations
from tests.engine.kernels.branches.four_at_once import FOUR
from tests.engine.kernels.branches.test_elimination_kernels import chain, table

WHOLE = (1.0, 0.0, 1.0)
ONE = SimpleNamespace(at_once=lambda: 1, rows=lambda array: array)


@pytest.fixture(params=[ONE, FOUR], ids=["one", "four"], autouse=True)
def lanes(request, monkeypatch) -> SimpleNamespace:
    """One number at once, and four."""
    monkeypatch.setattr(module, "lanes", request.param)
    where = SimpleNamespace(**vars(elementary))
    where.where_less = lambda a, b, x, y: np.where(a < b, x, y)
    for used in (module.circle_roots, module.resultant):
        monkeypatch.setattr(used, "elementary", where)
    return request.param


def drawn() -> module.EliminationScratch:
    """The equations of an arm."""
    arm, scratch = chain(4), module.make_scratch()
    one = elimination_kernels._loop(table(arm, 0, 0), arm.fk(np.arange(6.0)), scratch.axes)
    line_equations.far_side(one.h, one.P, scratch.far_side, scratch.near_side)
    line_equations.near_side(one.h[0], one.P[0], one.W, one.d, scratch.near_side)
    line_equations.combine(scratch.near_side, scratch.far_side, line_equations.ROOM, scratch.sigma)
    return scratch


def test_the_determinant_has_degree_16_in_half_the_angle_and_a_view_is_the_same_at_its_place(lanes):
    scratch, many = drawn(), lanes.at_once()
    x, y = (np.linspace(a, a + 0.5, many) if many > 1 else a for a in (0.6, -0.9))
    c, s, stretch = view = math.cos(0.8), math.sin(0.8), 0.2
    value = module.determinant(scratch, view, x, y)
    C, S = c * x - s * stretch * y, s * x + c * stretch * y
    # 1e-8: some thousand roundings of a determinant of twelve rows, which is not small here
    np.testing.assert_allclose(value, module.determinant(scratch, WHOLE, C, S), rtol=1e-8)
    larger = module.determinant(scratch, view, 1.25 * x, 1.25 * y)
    np.testing.assert_allclose(larger, 1.25**16 * value, rtol=1e-8)


def test_the_determinant_is_that_of_the_equations_at_a_point_of_the_circle(lanes):
    scratch, many = drawn(), lanes.at_once()
    half = np.full(many, 0.9) if many > 1 else 0.9
    C, S = np.cos(half), np.sin(half)
    value = module.determinant(scratch, WHOLE, C, S)
    A, M = lanes.rows(np.zeros(216)), lanes.rows(np.zeros(324))
    module.resultant.equations(scratch.sigma, (C * C, C * S, S * S), A)
    np.testing.assert_allclose(value, module.resultant.factor(A, M), rtol=1e-9)
    assert (np.abs(value) > 0.0).all()


def test_the_polynomial_has_the_determinant_s_values():
    scratch = drawn()
    view = math.cos(0.8), math.sin(0.8), 0.7
    size, noise = module.polynomial(scratch, view)
    f = scratch.f.copy()
    assert noise <= 1e-8 * size
    assert size == pytest.approx(np.abs(f[:17]).max())
    for angle in (0.3, 2.0, -1.0):
        k = np.arange(1, 9)
        series = f[0] + f[1:17:2] @ np.cos(k * angle) + f[2:17:2] @ np.sin(k * angle)
        half = np.full(4, angle / 2)
        if module.lanes is ONE:
            half = half[0]
        value = module.determinant(scratch, view, np.cos(half), np.sin(half))
        np.testing.assert_allclose(value, series, rtol=0, atol=1e-7 * size)


def roots_of(f, is_whole=True, zero=1e-13):
    """Angles in (-pi, pi] and slopes of the roots of a polynomial, and the number of steps."""
    scratch = module.make_scratch()
    for array in scratch:
        array[...] = 7.0
    scratch.f[:] = 0.0
    for place, value in f.items():
        scratch.f[place] = value
    steepest = module.circle_roots.steepest(scratch.f)
    number = module.roots(scratch, zero, steepest, is_whole)
    found = scratch.found.reshape(3, -1)
    many = module.lanes.at_once()
    lanes = -(-number // many) * many
    assert (found[:, lanes:] == 7.0).all()
    # those of no root are the first one, after steps of other lanes
    first = np.broadcast_to(found[:, :1], found[:, number:lanes].shape)
    np.testing.assert_allclose(found[:, number:lanes], first, rtol=0, atol=1e-8)
    C, S, slope = found[:, :number]
    return 2 * np.arctan2(S, C), slope


# of f = cos(3 x) - 0.3 and of f = sin(x): places of a_3 and b_1
COSINE, SINE = {0: -0.3, 5: 1.0}, {2: 1.0}


def test_all_roots_are_found_with_their_slopes():
    angles, slopes = roots_of(COSINE)
    expected = [(sign * math.acos(0.3) + 2 * math.pi * k) / 3 for sign in (1, -1) for k in range(3)]
    turn = 2 * math.pi
    np.testing.assert_allclose(
        np.sort(angles % turn), np.sort(np.array(expected) % turn), atol=1e-14
    )
    # before the last step, of some 1e-9 rad
    np.testing.assert_allclose(slopes, -3 * np.sin(3 * angles), rtol=0, atol=1e-8)
    angles, _ = roots_of({0: -0.3, 3: 1.0})
    np.testing.assert_allclose(np.cos(2 * angles), [0.3] * 4, rtol=0, atol=1e-14)
    angles, slopes = roots_of(SINE)
    np.testing.assert_allclose(np.sort(np.abs(np.sin(angles / 2))), [0, 1], atol=1e-14)
    np.testing.assert_allclose(slopes, np.cos(angles), atol=1e-8)


def test_roots_far_from_a_view_s_quarter_are_left_out():
    angles, _ = roots_of(SINE, is_whole=False)
    np.testing.assert_allclose(np.sin(angles / 2), [0.0], atol=1e-14)
    # five of six roots of cos(3 x - 1.05) = 0.3
    angles, _ = roots_of({0: -0.3, 5: math.cos(1.05), 6: math.sin(1.05)}, is_whole=False)
    np.testing.assert_allclose(np.cos(3 * angles - 1.05), [0.3] * 5, rtol=0, atol=1e-14)


def test_a_polynomial_without_roots_has_none():
    angles, slopes = roots_of({0: 2.0, 1: 1.0})
    assert len(angles) == len(slopes) == 0


@pytest.mark.parametrize("together", [1, 2])
def test_newton_s_rule_ends_where_all_are_found_or_out_of_steps(together, monkeypatch, lanes):
    many, asked, step = lanes.at_once(), [], 0
    scratch = module.make_scratch()

    def newton(*rest):
        nonlocal step
        step += 1
        both = np.arange(many) + 10.0 * step, -1.0 - np.arange(many)
        return both if many > 1 else (both[0][0], both[1][0])

    def is_found(step, slope, steepest):
        asked.append((step, slope, steepest))
        return together == 2 and (step >= 30 or step % 10 != many - 1)

    rule = SimpleNamespace(STEPS=5, newton=newton, is_found=is_found)
    monkeypatch.setattr(module, "circle_roots", rule)
    module._polish(scratch, None, 0, 8, 7.0)
    assert step == (3 if together == 2 else 5)
    assert asked[-1] == (10.0 * step + many - 1, -float(many), 7.0) or together == 1
    assert scratch.values[many : 2 * many].tolist() == [-1.0 - k for k in range(many)]
