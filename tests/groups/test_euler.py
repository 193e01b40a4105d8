"""Three angles of rotations as arrays, in rad and degrees, against SciPy and against themselves."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from poekin.groups import euler
from poekin.groups.rpy import angles as rpy_angles

UNIT = 2.0**-53
SEQUENCES = ("zyx", "xyz", "zyz")
RIGHT = [-180.0, -90.0, 0.0, 90.0, 180.0, 270.0, 720.0]


def random_angles(count, degrees, sequence):
    angles = np.random.default_rng(3).uniform(-180, 180, (count, 3))
    angles[:, 1] *= 0.5
    if sequence == "zyz":
        angles[:, 1] = np.abs(angles[:, 1]) * 2
    return angles if degrees else np.radians(angles)


@pytest.mark.parametrize("degrees", [False, True])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_angles_and_rotations_are_those_of_scipy(sequence, degrees):
    angles = random_angles(500, degrees, sequence)
    # capitals are SciPy's turns about axes that turn along
    expected = Rotation.from_euler(sequence.upper(), angles, degrees=degrees).as_matrix()
    R = euler.rotations(angles, sequence, degrees=degrees)
    # SciPy goes by a quaternion: some ten roundings of numbers up to 1
    np.testing.assert_allclose(R, expected, rtol=0, atol=20 * UNIT)
    found = euler.angles(R, sequence, degrees=degrees)
    whole = 360.0 if degrees else 2 * np.pi
    off = (found - angles + whole / 2) % whole - whole / 2
    sines = np.sin(np.radians(angles[:, 1]) if degrees else angles[:, 1])
    conditioned = np.abs(sines) if sequence == "zyz" else np.sqrt(1 - sines**2)
    bound = 12 * UNIT * (180 / np.pi if degrees else 1.0) / conditioned
    assert (np.abs(off).max(axis=1) <= bound).all()


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_multiples_of_ninety_degrees_are_exact_and_no_zero_has_a_sign(sequence):
    angles = np.array(list(itertools.product(RIGHT, repeat=3)))
    R = euler.rotations(angles, sequence, degrees=True)
    assert set(np.unique(R)) == {-1.0, 0.0, 1.0}
    assert not np.signbit(R[R == 0]).any()
    back = euler.angles(R, sequence, degrees=True)
    assert set(np.unique(back)) <= {-180.0, -90.0, 0.0, 90.0, 180.0}
    assert not np.signbit(back[back == 0]).any()
    np.testing.assert_array_equal(euler.rotations(back, sequence, degrees=True), R)
    assert (back > -180.0).all()
    assert (euler.angles(R, sequence) > -np.pi).all()


@pytest.mark.parametrize("angle", [1e17, -3.7e19, 2.0**70, 1e300, -1.7e308])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_degrees_of_any_size_are_what_is_left_after_whole_turns(sequence, angle):
    left = float(math.fmod(angle, 360.0))  # exact, as math.fmod always is
    big, small = ([[x, 20.0, 0.0], [30.0, x, 0.0], [0.0, 50.0, x]] for x in (angle, left))
    found, right = (euler.rotations(np.array(x), sequence, degrees=True) for x in (big, small))
    assert np.array_equal(found, right)


@pytest.mark.parametrize("turns", [1, -1, 10**6])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_whole_turns_in_degrees_change_nothing(sequence, turns):
    angles = np.array([[30.0, -45.0, 60.0]])
    np.testing.assert_array_equal(
        euler.rotations(angles + 360.0 * turns, sequence, degrees=True),
        euler.rotations(angles, sequence, degrees=True),
    )


LOCKED = {
    # an outer turn of 30 and of 50 degrees: what controllers print in the lock
    ("zyx", (30, 90, 50)): (-20, 90, 0),
    ("zyx", (30, -90, 50)): (80, -90, 0),
    ("xyz", (23, 90, 67)): (0, 90, 90),
    ("xyz", (23, -90, 67)): (0, -90, 44),
    ("zyz", (30, 0, 50)): (80, 0, 0),
    ("zyz", (30, 180, 50)): (-20, 180, 0),
}


@pytest.mark.parametrize(("sequence", "angles"), LOCKED)
def test_in_the_lock_one_outer_angle_is_zero(sequence, angles):
    R = euler.rotations(np.array(angles, float), sequence, degrees=True)
    found = euler.angles(R, sequence, degrees=True)
    np.testing.assert_allclose(found, LOCKED[sequence, angles], rtol=0, atol=3e-14)


@pytest.mark.parametrize("distance", [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-2, 0.5])
@pytest.mark.parametrize("degrees", [False, True])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_there_and_back_a_rotation_keeps_its_digits_also_in_the_lock(sequence, degrees, distance):
    # 343 rotations with B at a distance from each end, of floats' own sines: the angles lose
    # 8 u of the rotation at most, in degrees 12 u, and making it again 6 u; they never add up so.
    outer = np.radians([-180.0, -90.0, -33.0, 0.0, 12.0, 90.0, 177.0])
    middle = np.array([0.0, np.pi]) if sequence == "zyz" else np.array([-0.5, 0.5]) * np.pi
    shifts = np.concatenate([middle - distance, middle + distance])
    angles = np.array(list(itertools.product(outer, shifts, outer)))
    R = euler.rotations(angles, sequence)
    found = euler.angles(R, sequence, degrees=degrees)
    back = euler.rotations(found, sequence, degrees=degrees)
    assert np.abs(back - R).max() <= 1e-15


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_leading_axes_are_a_batch(sequence, shape):
    angles = np.random.default_rng(1).uniform(-1, 1, (*shape, 3))
    R = euler.rotations(angles, sequence)
    assert R.shape == (*shape, 3, 3)
    found = euler.angles(R, sequence)
    assert found.shape == (*shape, 3)
    for index in np.ndindex(shape):
        np.testing.assert_array_equal(euler.rotations(angles[index], sequence), R[index])
        np.testing.assert_array_equal(euler.angles(R[index], sequence), found[index])


def test_roll_pitch_and_yaw_are_the_angles_of_zyx_from_the_last_to_the_first():
    R = euler.rotations(np.array([[0.3, 0.2, 0.1]]), "zyx")
    np.testing.assert_allclose(rpy_angles(R), [[0.1, 0.2, 0.3]], rtol=0, atol=4 * UNIT)


def test_a_transposed_rotation_and_reversed_angles_are_seen():
    angles = np.array([10.0, 20.0, 30.0])
    right = euler.rotations(angles, "zyx", degrees=True)
    for wrong in (
        euler.rotations(angles[::-1], "zyx", degrees=True),
        euler.rotations(angles, "xyz", degrees=True),
        euler.rotations(angles, "zyx", degrees=True).T,
    ):
        assert np.abs(wrong - right).max() > 0.1
