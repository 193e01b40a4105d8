"""The quaternion of a matrix with its rest, against the logarithm in 60 digits."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas.lie import quaternion
from poekin.testing.oracles import exact
from poekin.testing.oracles.exact import mp
from tests.formulas.matrices import hat
from tests.formulas.on_both_sides import ANGLES, AXES, same

UNIT = 2.0**-53
rng = np.random.default_rng(11)


def rotations(noise):
    """In all four cases of the largest component, a third about nearly an axis of the frame."""
    for scale in (0.1, 1.0, 3.0):
        for _ in range(25):
            axis = np.where(rng.random(3) < 1 / 3, 1e-9, 1.0) * rng.normal(size=3)
            w = scale * rng.random() * axis / np.linalg.norm(axis)
            yield exact.rounded(exact.exp(w)) + noise * rng.uniform(-1, 1, (3, 3))


def unit_quaternion(R):
    w = exact.log(R)
    half = exact.norm(w) / 2
    return np.array([mp.cos(half), *(mp.sin(half) / (2 * half) * w)])


def error(R):
    """Of sign (q + rest), as a unit quaternion, and of 1 / |q|^2, relative."""
    q, rest, inverse, sign = quaternion.parts(tuple(map(float, R.ravel())))
    found = sign * (exact.exactly(q) + exact.exactly(rest))
    size = exact.norm(found)
    return float(exact.norm(found / size - unit_quaternion(R))), float(abs(inverse * size**2 - 1))


def test_a_quaternion_with_its_rest_is_right_to_its_last_digit():
    errors = [error(R) for R in rotations(0.0)]
    assert max(e for e, _ in errors) < UNIT
    assert max(e for _, e in errors) < 4 * UNIT


@pytest.mark.parametrize("noise", [1e-6, 1e-5])
def test_what_a_matrix_misses_a_rotation_by_enters_squared(noise):
    # what is added is at most 3 noise in the Frobenius norm
    assert max(e for e, _ in map(error, rotations(noise))) < (3 * noise) ** 2


@pytest.mark.parametrize("noise", [0.0, 1e-5])
def test_the_square_of_w_has_lost_nothing_that_its_rest_has_not(noise):
    # digits down to 2^-25 add up without rounding, and what is below is 2^-25 at most
    for R in rotations(noise):
        (p, *_), (rest, *_), inverse = quaternion._of_smallest_angle(tuple(map(float, R.ravel())))
        exact = 1 + sum(Fraction(float(R[k, k])) for k in range(3))
        assert abs(Fraction(p) + Fraction(rest) - exact) <= Fraction(1, 2**76)
        assert abs(rest) <= UNIT * max(abs(p), 1.0)
        assert inverse == 0.25 / p


def test_the_quaternion_is_that_of_the_angle_and_at_pi_its_largest_component_is_positive():
    for axis in AXES:
        for t in ANGLES:
            q = np.array(quaternion.quaternion(expm(hat(axis * t)).ravel()))
            same(q / np.linalg.norm(q), np.r_[math.cos(t / 2), math.sin(t / 2) * axis])
        half_turn = 2 * np.outer(axis, axis) - np.eye(3)
        q = np.array(quaternion.quaternion(half_turn.ravel()))
        same(q / np.linalg.norm(q), np.r_[0.0, axis * np.sign(axis[np.abs(axis).argmax()])])


def test_each_component_of_a_quaternion_has_its_own_rest(monkeypatch):
    q = (1.0, 2.0, 3.0, 4.0)
    rest = (0.5, 0.25, 0.125, 0.0625)
    monkeypatch.setattr(quaternion, "parts", lambda R: (q, rest, 1.0, -1.0))
    assert quaternion.quaternion((0.0,) * 9) == (-1.5, -2.25, -3.125, -4.0625)


def test_the_unit_quaternion_is_that_of_the_logarithm_and_of_length_one():
    for R in rotations(0.0):
        q = exact.exactly(quaternion.unit_quaternion(tuple(map(float, R.ravel()))))
        # u of the sum with its rest, u of the division, and a length right to u
        assert float(exact.norm(q - unit_quaternion(R))) <= 3 * UNIT


@pytest.mark.parametrize("length", [0.5, 1.0, 3.0])
def test_a_multiple_of_a_quaternion_is_its_rotation(length):
    for _ in range(200):
        w = rng.normal(size=3)
        half = exact.norm(exact.exactly(w)) / 2
        q = [mp.cos(half), *(mp.sin(half) / (2 * half) * exact.exactly(w))]
        given = [float(length * x) for x in q]
        R = np.reshape(quaternion.rotation(*given), (3, 3))
        # the numbers are right to u each, and 2 (v v + w v) / |q|^2 rounds five times
        np.testing.assert_allclose(R, exact.rounded(exact.exp(w)), rtol=0, atol=8 * UNIT)
