"""The rotation of one vector onto another against arctangents in 60 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas import elementary
from poekin.formulas.ik.rotation_onto import rotated, rotation_onto
from tests.formulas.ik.circle_roots import UNIT, angle, apart
from tests.formulas.kinds import both
from tests.formulas.matrices import hat

elementary.provide(mpmath.mpf, mpmath.mp, series=False)
FLOATS, COMPILED = both(rotation_onto)


def frame(rng):
    """Two vectors across a unit axis, and the axis."""
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return Q[0], Q[1], Q[2] if np.linalg.det(Q) > 0 else -Q[2]


def turn(k, a, b):
    """Angle from a to b about k, and the parts of both across k, of floats taken as exact."""
    k, a, b = ([mpmath.mpf(float(x)) for x in v] for v in (k, a, b))
    kk = mpmath.fdot(k, k)
    a = [x - mpmath.fdot(k, a) / kk * y for x, y in zip(a, k, strict=True)]
    b = [x - mpmath.fdot(k, b) / kk * y for x, y in zip(b, k, strict=True)]
    triple = sum(
        k[i] * (a[j] * b[n] - a[n] * b[j]) for i, j, n in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ) / mpmath.sqrt(kk)
    lengths = [mpmath.sqrt(mpmath.fdot(v, v)) for v in (a, b)]
    return mpmath.atan2(triple, mpmath.fdot(a, b)), lengths


@pytest.mark.parametrize("function", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_the_angle_is_right_to_4_units_of_the_vectors_over_their_parts_across(function):
    rng = np.random.default_rng(31)
    with mpmath.workdps(60):
        for _ in range(400):
            e, f, k = frame(rng)
            theta = rng.choice([rng.uniform(-np.pi, np.pi), 10.0 ** rng.uniform(-12, 0), np.pi])
            sizes = 10.0 ** rng.uniform(-70, 70, 2)
            along = rng.normal(size=2) * 10.0 ** rng.uniform(-3, 3, 2)
            a = sizes[0] * (e + along[0] * k)
            b = sizes[1] * (math.cos(theta) * e + math.sin(theta) * f + along[1] * k)
            c, s, length = function(tuple(k), tuple(a), tuple(b))
            expected, parts = turn(k, a, b)
            cost = UNIT * (np.linalg.norm(a) / parts[0]) * (np.linalg.norm(b) / parts[1])
            assert apart(angle(c, s), expected) <= 4 * cost + 2 * UNIT
            # two cross products, 2 u each, two sums of products, 3 u, their squares' root, 2 u, and
            # the axis, which is a unit vector to 1.5 u, twice
            assert abs(length / (parts[0] * parts[1]) - 1) <= 12 * cost


@pytest.mark.parametrize("zero", ("a", "b", "along"))
def test_vectors_without_a_part_across_are_not_turned(zero):
    k, a, b = (0.0, 0.6, 0.8), (1.0, 2.0, 3.0), (3.0, 2.0, 1.0)
    vectors = {"a": ((0.0,) * 3, b), "b": (a, (0.0,) * 3), "along": ((0.0, 0.0, 0.0), k)}[zero]
    assert rotation_onto(k, *vectors) == (1.0, 0.0, 0.0)


def test_no_other_rotation_brings_the_vectors_nearer():
    rng = np.random.default_rng(32)
    for _ in range(100):
        _, _, k = frame(rng)
        a, b = rng.normal(size=(2, 3))
        c, s, _ = rotation_onto(tuple(k), tuple(a), tuple(b))
        distances = [
            np.linalg.norm(expm(hat(k * (math.atan2(s, c) + t))) @ a - b)
            for t in (0.0, 1e-3, -1e-3)
        ]
        assert distances[0] == min(distances)


def test_rotated_is_the_exponential():
    rng = np.random.default_rng(33)
    for _ in range(100):
        _, _, k = frame(rng)
        a = rng.normal(size=3)
        theta = rng.uniform(-np.pi, np.pi)
        got = rotated(tuple(k), math.cos(theta), math.sin(theta), tuple(a))
        np.testing.assert_allclose(got, expm(hat(k * theta)) @ a, atol=1e-14)


@pytest.mark.parametrize("place", range(9))
@pytest.mark.parametrize("function", (FLOATS, COMPILED), ids=("floats", "compiled"))
def test_nan_is_no_angle(function, place):
    numbers = [0.0, 0.6, 0.8, 1.0, 2.0, 3.0, 3.0, 2.0, 1.0]
    numbers[place] = math.nan
    assert math.isnan(function(tuple(numbers[:3]), tuple(numbers[3:6]), tuple(numbers[6:]))[2])


def test_in_60_digits_it_gives_60_digits():
    with mpmath.workdps(60):
        k = tuple(mpmath.mpf(x) / 3 for x in (1, 2, 2))
        a, b = (tuple(map(mpmath.mpf, v)) for v in ((1, 2, 3), (3, -1, 1)))
        c, s, _ = rotation_onto(k, a, b)
        got = rotated(k, c, s, a)
        across = [mpmath.det(mpmath.matrix([k, v, b])) for v in (got,)]
        assert abs(across[0]) < mpmath.mpf(10) ** -57
        assert abs(c * c + s * s - 1) < mpmath.mpf(10) ** -58
