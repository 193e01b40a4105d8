"""Three joints that make a rotation against products of rotations in 60 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik import orientation
from tests.formulas.ik.circle_roots import UNIT, apart
from tests.formulas.ik.moved import across, angles, floats, largest, place, rows_of, unit_vectors
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(orientation.roots)
NOWHERE = ((0.0, 0.0, 0.0),) * 4


def axes(rng):
    """Any three, a wrist of right angles, or a wrist that is nearly one."""
    h = unit_vectors(rng, 3)
    if rng.random() < 0.5:
        h = np.array([(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
        h = h + rng.choice([0.0, 1e-3]) * rng.normal(size=(3, 3))
        h = h / np.linalg.norm(h, axis=1)[:, None]
    return h


def slope(h, x):
    """Of h_1 . e^{[h_2] x_2} h_3 by x_2: h_1, h_2 and the turned h_3 in a plane is singular."""
    E = place(h[1:2], NOWHERE[:2], x[1:2])[1]
    turned = E * mpmath.matrix([float(v) for v in h[2]])
    return abs(float(np.dot(np.cross(h[0], h[1]), np.array(floats(turned)))))


@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_the_angles_are_found_to_rounding_over_the_slope_and_every_row_makes_the_rotation(roots):
    rng = np.random.default_rng(51)
    with mpmath.workdps(60):
        for _ in range(100):
            h = axes(rng)
            x = rng.uniform(-np.pi, np.pi, 3)
            if rng.random() < 0.3:
                x[1] = 10.0 ** rng.uniform(-12, 0)
            R = place(h, NOWHERE, x)[1]
            got = roots(rows_of(h), across(h[2]), floats(R))
            flat = slope(h, x)
            errors = []
            for row in got:
                assert row[6] >= 0.0
                # a double root is known to the square root of rounding
                loss = 40 * UNIT / max(flat, math.sqrt(UNIT))
                assert largest(place(h, NOWHERE, angles(row))[1] - R) <= 64 * UNIT + loss
                errors.append(max(apart(a, b) for a, b in zip(angles(row), x, strict=True)))
            # x_1 and x_3 are known as well as sin x_2 tells them apart, and x_2 over the slope
            if flat > 1e-6:
                assert min(errors) <= 40 * UNIT / flat**2


@pytest.mark.parametrize("x2", (0.0, math.pi))
@pytest.mark.parametrize("roots", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_of_axes_in_line_the_margin_is_about_0_and_the_rotation_is_made(roots, x2):
    h = np.array([(0.0, 0.6, 0.8), (1.0, 0.0, 0.0), (0.0, 0.6, 0.8)])
    with mpmath.workdps(60):
        for x in np.random.default_rng(52).uniform(-np.pi, np.pi, (100, 3)):
            x[1] = x2
            R = place(h, NOWHERE, x)[1]
            for row in roots(rows_of(h), across(h[2]), floats(R)):
                assert 0.0 <= row[6] <= 16 * UNIT
                assert largest(place(h, NOWHERE, angles(row))[1] - R) <= 1e-7


def test_a_rotation_out_of_reach_has_a_margin_below_0_and_the_nearest_cosine():
    # h_2 along h_3: h_1 . R h_3 stays what it is
    h = np.array([(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.0, 0.0, 1.0)])
    R = (
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        1.0,
        0.0,
    )  # h_1 . R h_3 = 0, and at least 0.28 is reached
    with mpmath.workdps(60):
        for row in orientation.roots(rows_of(h), across(h[2]), R):
            assert row[6] < 0.0
            made = place(h, NOWHERE, angles(row))[1]
            assert abs(made[2, 2] - mpmath.mpf("0.28")) < 8 * UNIT


@pytest.mark.parametrize("number", range(9))
def test_nan_has_no_root(number):
    R = [1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0]
    R[number] = math.nan
    h = rows_of(unit_vectors(np.random.default_rng(53), 3))
    for row in orientation.roots(h, across(np.array(h[2])), tuple(R)):
        assert any(math.isnan(x) for x in row)


def test_in_60_digits_it_gives_60_digits():
    with mpmath.workdps(60):
        h = tuple(tuple(map(mpmath.mpf, v)) for v in ((0, 0, 1), (0, 1, 0), (1, 0, 0)))
        x = (mpmath.mpf("0.3"), mpmath.mpf("-0.4"), mpmath.mpf("1.1"))
        R = place(h, NOWHERE, x)[1]
        got = orientation.roots(h, tuple(map(mpmath.mpf, (0, 1, 0))), tuple(R))
        errors = [max(apart(a, b) for a, b in zip(angles(row), x, strict=True)) for row in got]
        assert min(errors) < mpmath.mpf(10) ** -57
