"""Arms whose second to fourth axes are parallel against products of rotations in 60 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from poekin.formulas import elementary
from poekin.formulas.ik import three_parallel
from tests.formulas.ik.circle_roots import UNIT, apart
from tests.formulas.ik.moved import (
    across,
    angles,
    floats,
    jacobian,
    largest,
    place,
    rows_of,
    unit_vectors,
)
from tests.formulas.kinds import both

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
OUTER = dict(zip(("floats", "compiled"), both(three_parallel.outer), strict=True))
WITH_OUTER = dict(zip(("floats", "compiled"), both(three_parallel.with_outer), strict=True))
ZERO = (0.0, 0.0, 0.0)


def any_arm(rng):
    h = unit_vectors(rng, 6)
    h[2] = h[1] * rng.choice([-1.0, 1.0])
    h[3] = h[1] * rng.choice([-1.0, 1.0])
    return h, rng.normal(size=(6, 3))


def ur(rng):
    h = np.array([(0, 0, 1), (0, 1, 0), (0, 1, 0), (0, 1, 0), (0, 0, -1), (0, 1, 0)], dtype=float)
    P = np.array([ZERO, (0, 0.1, 0), (-0.43, 0, 0), (-0.39, 0, 0), (0, 0.1, 0), (0, 0, -0.1)])
    P = P * rng.uniform(0.5, 1.5, 6)[:, None]
    if rng.random() < 0.3:
        P[4] = -P[1]  # no height of the wrist above the shoulder
    return h, P


def solved(kind, h, P, R, p):
    h, P = rows_of(h), rows_of(P)
    rows = []
    for root in OUTER[kind](h, P, R, p):
        rows += WITH_OUTER[kind](h, P, across(np.array(h[1])), R, p, root)
    return rows


def pose(h, P, x):
    """Place of the sixth axis less P_0, and E_6."""
    return place(h, [ZERO, *P[1:6], ZERO], x)


def smallest_slope(h, P, x):
    return np.linalg.svd(jacobian(h, [*P[1:6], ZERO], x))[1][-1]


@pytest.mark.parametrize("kind", OUTER)
@pytest.mark.parametrize("draw", (any_arm, ur), ids=lambda draw: draw.__name__)
def test_the_angles_are_found_and_every_row_reaches_the_pose(draw, kind):
    rng = np.random.default_rng(71)
    with mpmath.workdps(60):
        for _ in range(25):
            h, P = draw(rng)
            x = rng.uniform(-np.pi, np.pi, 6)
            p, R = pose(h, P, x)
            reach = 1.0 + np.linalg.norm(P, axis=1).sum()
            got = [row for row in solved(kind, h, P, floats(R), floats(p)) if row[12] >= 0.0]
            assert len(got) >= 2
            errors = []
            for row in got:
                found = angles(row)
                flat = smallest_slope(h, P, [float(a) for a in found])
                place_there, turned = pose(h, P, found)
                gap = max(largest(place_there - p), largest(turned - R))
                assert gap <= 40 * UNIT * reach * max(reach / flat, 1.0)
                errors.append(max(apart(a, b) for a, b in zip(found, x, strict=True)))
            flat = smallest_slope(h, P, x)
            if flat > 1e-5:
                assert min(errors) <= 40 * UNIT * (reach / flat) ** 2


def test_out_of_reach_every_margin_is_below_0():
    rng = np.random.default_rng(72)
    for _ in range(20):
        h, P = ur(rng)
        with mpmath.workdps(60):
            R = floats(pose(h, P, rng.uniform(-3, 3, 6))[1])
        assert all(row[12] < 0.0 for row in solved("floats", h, P, R, (0.0, 30.0, 1.0)))
        assert all(row[12] < 0.0 for row in solved("floats", h, P, R, (30.0, 0.0, 1.0)))


@pytest.mark.parametrize("number", range(12))
@pytest.mark.parametrize("kind", OUTER)
def test_nan_has_no_root(number, kind):
    rng = np.random.default_rng(73)
    h, P = ur(rng)
    with mpmath.workdps(60):
        p, R = pose(h, P, rng.uniform(-3, 3, 6))
        numbers = [*floats(R), *floats(p)]
    numbers[number] = math.nan
    for row in solved(kind, h, P, tuple(numbers[:9]), tuple(numbers[9:])):
        assert not row[12] >= 0.0 or any(math.isnan(v) for v in row)


def test_in_60_digits_it_gives_60_digits():
    with mpmath.workdps(60):
        h = [(0, 0, 1), (0, 1, 0), (0, 1, 0), (0, 1, 0), (0, 0, -1), (0, 1, 0)]
        P = [(0, 0, 0), (0, 1, 0), (-4, 0, 0), (-3, 0, 1), (0, 1, 0), (0, 0, -1)]
        x = [mpmath.mpf(k) / 10 for k in (3, -4, 11, 7, -9, 14)]
        p, R = pose(h, P, x)
        h, P = (tuple(tuple(map(mpmath.mpf, v)) for v in rows) for rows in (h, P))
        axis = tuple(map(mpmath.mpf, (1, 0, 0)))
        rows = []
        for root in three_parallel.outer(h, P, tuple(R), tuple(p)):
            rows += three_parallel.with_outer(h, P, axis, tuple(R), tuple(p), root)
        errors = [
            max(apart(a, b) for a, b in zip(angles(row), x, strict=True))
            for row in rows
            if row[12] >= 0
        ]
        assert min(errors) < mpmath.mpf(10) ** -56
