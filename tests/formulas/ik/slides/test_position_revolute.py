"""Three revolute joints that bring a point to a place against products of rotations in 60 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik.slides import position
from tests.formulas.ik.circle_roots import UNIT, apart
from tests.formulas.ik.moved import angles, floats, jacobian, largest, place, rows_of, unit_vectors
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(position.roots)
ZERO = (0.0, 0.0, 0.0)
REVOLUTE = (False, False, False)


def any_arm(rng):
    return unit_vectors(rng, 3), rng.normal(size=(3, 3)), rng.uniform(-np.pi, np.pi, 3)


def puma(rng):
    """Shoulder, and parallel axes of upper arm and forearm."""
    h = np.array([(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    P = np.array([(0.15, 0.1, 0.6), (0.0, -0.1, 0.45), (0.43, 0.0, 0.02)])
    return h, P * rng.uniform(0.5, 1.5, 3)[:, None], rng.uniform(-np.pi, np.pi, 3)


def without_offset(rng):
    """The first two axes meet."""
    h = unit_vectors(rng, 3)
    P = rng.normal(size=(3, 3))
    P[0] *= 0.0
    return h, P, rng.uniform(-np.pi, np.pi, 3)


def nearly_parallel(rng):
    h = np.ones(3) + 10.0 ** rng.uniform(-6, 0) * rng.normal(size=(3, 3))
    h = h / np.linalg.norm(h, axis=1)[:, None]
    return h, rng.normal(size=(3, 3)), rng.uniform(-np.pi, np.pi, 3)


DRAWS = (any_arm, puma, without_offset, nearly_parallel)


def smallest_slope(h, P, x):
    """Smallest singular value of the place's Jacobian."""
    return np.linalg.svd(jacobian(h, P, x)[:, 3:])[1][-1]


@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
@pytest.mark.parametrize("draw", DRAWS, ids=lambda draw: draw.__name__)
def test_the_angles_are_found_and_every_row_reaches_the_place(draw, roots):
    rng = np.random.default_rng(61)
    with mpmath.workdps(60):
        for _ in range(30):
            h, P, x = draw(rng)
            p = place(h, [ZERO, *P], x)[0]
            reach = np.linalg.norm(P, axis=1).sum()
            got = [
                row for row in roots(REVOLUTE, rows_of(h), rows_of(P), floats(p)) if row[6] >= 0.0
            ]
            assert got
            errors = []
            for row in got:
                found = angles(row)
                flat = smallest_slope(h, P, [float(a) for a in found])
                gap = largest(place(h, [ZERO, *P], found)[0] - p)
                assert gap <= 40 * UNIT * reach * max(reach / flat, 1.0)
                errors.append(max(apart(a, b) for a, b in zip(found, x, strict=True)))
            flat = smallest_slope(h, P, x)
            if flat > 1e-6 * reach:
                assert min(errors) <= 40 * UNIT * (reach / flat) ** 2


@pytest.mark.parametrize("x3", (0.0, math.pi))
def test_a_stretched_arm_is_a_double_root_near_margin_0(x3):
    h = rows_of([(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    P = rows_of([(0.15, 0.0, 0.0), (0.45, 0.0, 0.0), (0.4, 0.0, 0.0)])
    with mpmath.workdps(60):
        for x in np.random.default_rng(62).uniform(-np.pi, np.pi, (50, 2)):
            p = place(h, [ZERO, *P], (*x, x3))[0]
            got = position.roots(REVOLUTE, h, P, floats(p))
            near = [row for row in got if row[6] > -64 * UNIT]
            errors = [
                max(apart(a, b) for a, b in zip(angles(row), (*x, x3), strict=True)) for row in near
            ]
            assert min(errors) < 1e-6


def test_out_of_reach_every_margin_is_below_0():
    h = rows_of(unit_vectors(np.random.default_rng(63), 3))
    P = rows_of(np.random.default_rng(64).normal(size=(3, 3)))
    for p in ((20.0, 0.0, 0.0), (0.0, -1e3, 1.0), (1e100, 0.0, 0.0)):
        assert all(row[6] < 0.0 for row in position.roots(REVOLUTE, h, P, p))


def test_on_the_first_axis_the_first_angle_is_free():
    """An arm without offsets, the place on the axis: one of a continuum."""
    h = rows_of([(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
    P = rows_of([(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.5, 0.0, 0.0)])
    got = position.roots(REVOLUTE, h, P, (0.0, 0.0, 0.75))
    assert all(row[6] == 0.0 for row in got)
    with mpmath.workdps(60):
        for row in got:
            gap = place(h, [ZERO, *P], angles(row))[0] - mpmath.matrix([0.0, 0.0, 0.75])
            assert largest(gap) <= 8 * UNIT


@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize("which", ("p", "P"))
def test_nan_has_no_root(number, which):
    h, P, x = puma(np.random.default_rng(65))
    p = list(floats(place(h, [ZERO, *P], x)[0]))
    steps = [list(row) for row in P]
    (p if which == "p" else steps[1])[number] = math.nan
    for row in position.roots(REVOLUTE, rows_of(h), rows_of(steps), tuple(p)):
        assert not row[6] >= 0.0 or any(math.isnan(v) for v in row)


def test_in_60_digits_it_gives_60_digits():
    with mpmath.workdps(60):
        h = tuple(tuple(map(mpmath.mpf, v)) for v in ((0, 0, 1), (0, 1, 0), (0, 1, 0)))
        P = tuple(tuple(map(mpmath.mpf, v)) for v in ((1, 1, 0), (2, 0, 1), (3, 1, 0)))
        x = (mpmath.mpf("0.3"), mpmath.mpf("-0.4"), mpmath.mpf("1.1"))
        p = place(h, [ZERO, *P], x)[0]
        got = [row for row in position.roots(REVOLUTE, h, P, tuple(p)) if row[6] >= 0]
        errors = [max(apart(a, b) for a, b in zip(angles(row), x, strict=True)) for row in got]
        assert min(errors) < mpmath.mpf(10) ** -56
