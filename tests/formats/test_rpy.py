"""Roll, pitch, yaw of a rotation: the three together are the rotation, at pitch ±90° as anywhere
else.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given, target
from hypothesis import strategies as st

from poekin.formats import rpy
from poekin.testing.strategies.group_strategies import rotations

BAR = 8 * 2.0**-53
"""As `rpy.angles` has it, 8 u: yaw, pitch and roll are off by u cos(pitch), u sin(2 pitch) and 2.5 u,
and arctan2 rounds them to 2 u, u and 2 u, together 6.6 u; in the lock 6 u are taken for 0 and π/2 is
rounded, 6.6 u too. The rest is for an arctan2 that is not rounded right.
"""
EYE = np.eye(3)

anything = st.floats(-math.pi, math.pi)
# Distances of the pitch from ±90°: exactly there, and every decade from where doubles end to a
# degree or so.
near = st.builds(
    lambda k, m: m * 10.0**-k, st.integers(2, 18), st.sampled_from([-3.0, -1.0, 0.0, 1.0, 2.0])
)


def exact(roll: float, pitch: float, yaw: float) -> Any:
    """Rz(yaw) Ry(pitch) Rx(roll) in 50 digits."""
    with mpmath.workdps(50):
        (a, b), (c, d), (e, f) = [(mpmath.sin(x), mpmath.cos(x)) for x in (roll, pitch, yaw)]
        X = mpmath.matrix([[1, 0, 0], [0, b, -a], [0, a, b]])
        Y = mpmath.matrix([[d, 0, c], [0, 1, 0], [-c, 0, d]])
        Z = mpmath.matrix([[f, -e, 0], [e, f, 0], [0, 0, 1]])
        return Z * Y * X


def rounded(R: Any) -> np.ndarray:
    return np.array(R.tolist(), dtype=float)


def worn(R: np.ndarray) -> np.ndarray:
    """The rotation after a turn there and back: each entry is off by some 1e-16, however small it
    is.
    """
    turn = rpy.pose((0, 0, 0), (0.3, 0.5, 0.7))[:3, :3]
    return turn @ (turn.T @ R)


def defect(R: np.ndarray) -> float:
    return float(np.abs(R @ R.T - EYE).max())


def error(R: np.ndarray, angles: Callable = rpy.angles) -> float:
    """How far the rotation of the angles is from R, in its worst entry."""
    with mpmath.workdps(50):
        return float(max(abs(x) for x in exact(*angles(R)) - mpmath.matrix(R.tolist())))


@given(rotations())
@example(np.array([[2.2e-16, -1.06e-15, 1], [-8.6e-16, 1, 1.06e-15], [-1, -8.6e-16, 2.2e-16]]))
def test_the_angles_of_a_rotation_are_that_rotation(R):
    # The strategy's rotations are orthonormal to a few units in the last place, no better.
    assert error(R) <= BAR + defect(R)


def angles_off(turns: np.ndarray) -> np.ndarray:
    """Error ÷ bound of the angles of rotations that are given by roll, ±1, π/2 less |pitch|, and yaw
    (n, 4): of each as rounding makes it, and after a turn there and back.
    """
    found = []
    for roll, sign, off, yaw in turns.tolist():
        with mpmath.workdps(50):
            R = rounded(exact(roll, sign * (mpmath.pi / 2 - off), yaw))
        turned = worn(R)
        found += [error(R) / BAR, error(turned) / (BAR + defect(turned))]
    return np.array(found)


@given(anything, st.sampled_from([-1, 1]), near, anything)
@example(0.0, 1, 0.0, 0.0)
@example(0.0, -1, 0.0, 0.0)
@example(1.0, 1, 1e-6, -2.0)
@example(math.pi, 1, -1e-6, math.pi)
@example(-0.6866908854034874, -1, -1e-07, -0.5299887092004831)
@example(0.00552, 1, -8.88e-16, -2.358)
@example(0.00552, 1, -6.5e-16, -2.358)
def test_the_digits_stay_near_a_quarter_turn_of_pitch(roll, sign, off, yaw):
    worst = float(angles_off(np.array([[roll, sign, off, yaw]])).max())
    target(worst)
    assert worst <= 1


@given(anything, st.floats(-1.5, 1.5), anything)
def test_away_from_there_each_angle_comes_back(roll, pitch, yaw):
    found = rpy.angles(rpy.pose((0, 0, 0), (roll, pitch, yaw))[:3, :3])
    turns = [
        (a - b + math.pi) % (2 * math.pi) - math.pi
        for a, b in zip(found, (roll, pitch, yaw), strict=True)
    ]
    assert max(map(abs, turns)) <= 2e-15 / math.cos(pitch)


@pytest.mark.parametrize(
    "angles", [(0, 0, 0), (math.pi / 2, 0, 0), (0, 0, -math.pi / 2), (math.pi / 2, 0, math.pi)]
)
def test_right_angles_are_right_angles_and_no_zero_has_a_sign(angles):
    R = np.round(rpy.pose((0, 0, 0), angles)[:3, :3])
    found = rpy.angles(R)
    assert found == angles
    assert all(math.copysign(1, x) == 1 for x in found if x == 0)


def plain(R):
    return (
        math.atan2(R[2][1], R[2][2]),
        math.atan2(-R[2][0], math.hypot(R[2][1], R[2][2])),
        math.atan2(R[1][0], R[0][0]),
    )


PLANTED = {
    "three entries at a time": (plain, 1e-11),
    "roll and yaw in each other's place": (lambda R: rpy.angles(R)[::-1], 0.1),
    "the transposed rotation": (lambda R: rpy.angles(R.T), 0.1),
    "pitch by asin": (lambda R: (rpy.angles(R)[0], math.asin(-R[2, 0]), rpy.angles(R)[2]), 1e-11),
    "the sign of pitch": (lambda R: (rpy.angles(R)[0], -rpy.angles(R)[1], rpy.angles(R)[2]), 0.1),
}


@pytest.mark.parametrize(("wrong", "least"), PLANTED.values(), ids=PLANTED)
def test_planted_errors_are_found(wrong, least):
    cases = [
        worn(rounded(exact(r, s * (math.pi / 2 - 1e-6), 0.7)))
        for r in np.linspace(-3, 3, 13)
        for s in (-1, 1)
    ]
    assert max(error(R) - defect(R) for R in cases) <= BAR
    assert max(error(R, wrong) for R in cases) > least


@given(turns=st.lists(st.floats(-20, 20), min_size=3, max_size=3), data=st.data())
def test_the_nearest_angles_are_the_same_turn_and_no_others_are_nearer(turns, data):
    near = data.draw(st.lists(st.floats(-20, 20), min_size=3, max_size=3))
    R = rpy.pose((0, 0, 0), turns)[:3, :3]
    found = rpy.nearest_angles(R, near)
    # the angles' own rotation is R within BAR; to three of them are added up to four whole turns,
    # each wrong by 2.5e-16, in two roundings of numbers below 32
    bound = BAR + 3 * (4 * 2.5e-16 + 2 * 2.0**-49)
    assert np.abs(rpy.pose((0, 0, 0), found)[:3, :3] - R).max() <= bound
    assert math.dist(found, near) <= _nearest(R, near) + 1e-12


def _nearest(R, near):
    """Distance to the nearest of all angles of a rotation, each tried with up to eight whole turns."""
    r, p, y = rpy.angles(R)
    distances = []
    for branch in ((r, p, y), (r + math.pi, math.pi - p, y + math.pi)):
        shifts = [
            min(abs(x + math.tau * k - x0) for k in range(-8, 9))
            for x, x0 in zip(branch, near, strict=True)
        ]
        distances.append(math.hypot(*shifts))
    return min(distances)


@given(turns=st.lists(st.floats(-7, 7), min_size=3, max_size=3))
def test_angles_near_which_a_rotation_is_written_are_its_own(turns):
    assume(abs(math.cos(turns[1])) > 0.1)
    R = rpy.pose((0, 0, 0), turns)[:3, :3]
    # an entry of R is right to 8 u, which roll and yaw are ten times as far off by
    assert np.abs(np.subtract(rpy.nearest_angles(R, turns), turns)).max() <= 2e-14
