"""Three turns of a rotation against elementary rotations multiplied out in 60 digits, in the lock,
beside it, and anywhere else.
"""

from __future__ import annotations

import itertools
import math

import mpmath
import numpy as np
import pytest

from poekin.formulas.lie import euler

UNIT = 2.0**-53
DISTANCES = (0.0, 1e-18, 6.5e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-2, 0.5)
ENDS = {"zyx": (-math.pi / 2, math.pi / 2), "zyz": (0.0, math.pi)}
TURNS = {"zyx": euler.zyx_turns, "zyz": euler.zyz_turns}
MAKE = {"zyx": euler.zyx, "zyz": euler.zyz}
OUTER = (-3.0, -math.pi / 2, 0.0, 0.7, 2.2, math.pi)


def turn(axis, angle):
    """The elementary rotation about an axis of the frame, as textbooks print it."""
    s, c = mpmath.sin(angle), mpmath.cos(angle)
    rows = {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }
    return mpmath.matrix(rows[axis])


def product(sequence, angles):
    first, second, third = (turn(axis, a) for axis, a in zip(sequence, angles, strict=True))
    return first * second * third


def error(sequence, R, turns):
    """How far the rotation of the points (sine, cosine) is from R, in its worst entry."""
    exact = [mpmath.mpf(float(x)) for x in turns]
    angles = [mpmath.atan2(exact[2 * i], exact[2 * i + 1]) for i in range(3)]
    return float(max(abs(x) for x in product(sequence, angles) - mpmath.matrix(R.tolist())))


def rotations(sequence, distance):
    """Rotations with B at a distance from both ends, rounded to floats."""
    for end, sign, a, c in itertools.product(ENDS[sequence], (-1, 1), OUTER, OUTER):
        exact = product(sequence, (a, mpmath.mpf(end) + sign * distance, c))
        yield np.array(exact.tolist(), dtype=float)


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("sequence", ENDS)
def test_the_turns_of_a_rotation_are_that_rotation_at_any_distance_from_the_lock(
    sequence, distance
):
    # zyx: the turns are off by u cos(B), u sin(2B) and 2.5 u, about axes across to each other; zyz
    # alike. In the lock up to 6 u is taken for 0.
    with mpmath.workdps(60):
        worst = max(
            error(sequence, R, TURNS[sequence](R.ravel().tolist()))
            for R in rotations(sequence, distance)
        )
    assert worst <= 6 * UNIT


@pytest.mark.parametrize("sequence", ENDS)
def test_in_the_lock_the_last_turn_is_none_and_in_front_of_it_all_three_are_there(sequence):
    s, c = 0.6, 0.8
    ends = {"zyx": (1.0, 0.0), "zyz": (0.0, -1.0)}[sequence]
    R = MAKE[sequence](s, c, *ends, c, s)
    a_s, a_c, *_, c_s, c_c = TURNS[sequence](R)
    assert (c_s, c_c) == (0.0, 1.0)
    # zyx: Rz(A) Ry(90°) Rx(C) turns by A - C; zyz: Rz(A) Ry(180°) Rz(C), by A - C as well
    np.testing.assert_allclose((a_s, a_c), (s * s - c * c, 2 * c * s), rtol=0, atol=2 * UNIT)
    beside = 2 * euler.LOCK
    tilted = {"zyx": (1.0, beside), "zyz": (beside, -1.0)}[sequence]
    turns = TURNS[sequence](MAKE[sequence](s, c, *tilted, c, s))
    np.testing.assert_allclose(turns[:2], (s, c), rtol=0, atol=1e-15)
    assert math.hypot(turns[2] - tilted[0], turns[3] - tilted[1]) <= 4 * UNIT


@pytest.mark.parametrize("sequence", ENDS)
def test_sines_and_cosines_make_the_product_of_the_elementary_rotations(sequence):
    rng = np.random.default_rng(7)
    for angles in rng.uniform(-4, 4, (200, 3)):
        pairs = [f(a) for a in angles for f in (math.sin, math.cos)]
        with mpmath.workdps(60):
            exact = np.array(product(sequence, angles.tolist()).tolist(), dtype=float)
        # two products of three factors, each factor right to u, and four roundings
        np.testing.assert_allclose(
            np.reshape(MAKE[sequence](*pairs), (3, 3)), exact, rtol=0, atol=6 * UNIT
        )


def worn(R):
    """R after a turn there and back: each entry is off by some 1e-16, however small it is."""
    turned = np.reshape(euler.zyx(0.28, 0.96, -0.6, 0.8, 0.8, 0.6), (3, 3))
    return turned @ (turned.T @ R)


@pytest.mark.parametrize("sequence", ENDS)
def test_what_rounding_took_from_small_entries_is_made_good_beside_the_lock(sequence):
    with mpmath.workdps(60):
        for R in map(worn, itertools.islice(rotations(sequence, 1e-9), 40)):
            defect = np.abs(R @ R.T - np.eye(3)).max()
            assert error(sequence, R, TURNS[sequence](R.ravel().tolist())) <= 6 * UNIT + defect


def test_three_entries_at_a_time_lose_the_rotation_beside_the_lock():
    def plain(R):
        return (R[3], R[0], -R[6], math.hypot(R[7], R[8]), R[7], R[8])

    with mpmath.workdps(60):
        beside = map(worn, itertools.islice(rotations("zyx", 1e-9), 40))
        assert max(error("zyx", R, plain(R.ravel().tolist())) for R in beside) > 1e-9
