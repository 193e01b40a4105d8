"""Errors of poses and directions against matrix exponentials and the exact logarithm."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from poekin.formulas.inverse import pose_error
from poekin.testing.oracles import exact

N = np.array([2.0, 3.0, -6.0]) / 7
ANGLES = [0.0, 1e-9, 0.3, 2.0, 3.1]
NUMBERS = st.floats(-2, 2)


def rotation(w):
    return expm(np.cross(np.eye(3), w))


def flat(R):
    return tuple(map(float, R.ravel()))


@pytest.mark.parametrize("angle", [*ANGLES, math.pi])
def test_the_error_of_a_rotation_is_twice_the_sine_of_half_its_angle_along_its_axis(angle):
    R = rotation([0.4, -1.2, 0.7])
    found = np.array(pose_error.rotation_error(flat(R), flat(rotation(angle * N) @ R)))
    expected = 2 * math.sin(angle / 2) * N
    opposite = angle == math.pi and found == pytest.approx(-expected)
    assert opposite or found == pytest.approx(expected, abs=2e-15)
    assert pose_error.angle(found) == pytest.approx(angle, abs=5e-8 if angle > 3.13 else 2e-14)


@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_the_error_of_a_rotation_has_the_direction_and_angle_of_the_exact_logarithm(w, w_target):
    R, S = rotation(w), rotation(w_target)
    with exact.mp.workdps(40):
        log = exact.log(exact.exactly(S) @ exact.exactly(R).T)
        phi = exact.norm(log)
        expected = [float(2 * exact.mp.sin(phi / 2) / phi * x) if phi else 0.0 for x in log]
    found = pose_error.rotation_error(flat(R), flat(S))
    if phi > math.pi - 1e-9 and np.dot(found, expected) < 0:
        expected = [-x for x in expected]  # Remark 1: both are logarithms at half a turn
    # SciPy's rotations miss orthonormality by some 1e-15, and enter as they are
    assert found == pytest.approx(expected, abs=2e-14)
    assert 2 * math.sin(pose_error.angle(found) / 2) == pytest.approx(
        np.linalg.norm(expected), abs=2e-14
    )


def test_an_angle_of_rounded_sines_is_at_most_pi():
    assert pose_error.angle((2.0 + 1e-9, 0.0, 0.0)) == math.pi
    assert pose_error.angle((0.6, 0.0, 0.8)) == pytest.approx(math.pi / 3, rel=1e-15)


@pytest.mark.parametrize("axis", [(0, 0, 1.0), (0.6, 0, -0.8), (0.48, 0.6, 0.64)])
@pytest.mark.parametrize("turn", [0.0, 1e-8, 0.7, 2.9])
def test_the_error_of_a_direction_is_that_of_the_smallest_turn(axis, turn):
    R = rotation([0.3, 0.8, -0.5])
    a = R @ axis
    across = np.cross(a, [1.0, 2.0, 3.0])
    across /= np.linalg.norm(across)
    target = rotation(turn * across) @ R @ rotation(1.3 * np.array(axis))
    found, error = pose_error.direction_error(flat(R), flat(target), axis)
    assert found == pytest.approx(a, abs=1e-15)
    assert error == pytest.approx(2 * math.sin(turn / 2) * across, abs=4e-15)


@pytest.mark.parametrize("turned", [0.0, 0.7, 2.0])
def test_towards_the_opposite_direction_half_a_turn_across_x_or_y_is_taken(turned):
    R = rotation([0, 0.4 * turned, turned])
    opposite = -R  # no rotation, but the opposite direction to the last bit
    for axis in np.eye(3):
        a, error = pose_error.direction_error(flat(R), flat(opposite), axis)
        assert np.dot(a, error) == pytest.approx(0, abs=1e-15)
        assert np.linalg.norm(error) == pytest.approx(2, rel=1e-15)
        assert error[0 if abs(a[0]) < 0.6 else 1] == 0


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, -2.0, 3.1])
@pytest.mark.parametrize("swing", [0.0, 1e-9, 0.7, 3.0])
def test_the_error_in_a_plane_is_the_turn_about_its_normal_whatever_the_swing(angle, swing):
    R = rotation([0.3, 0.8, -0.5])
    across = np.cross(N, [1.0, 2.0, 3.0])
    turned = rotation(swing * across / np.linalg.norm(across)) @ rotation(angle * N)
    found = pose_error.planar_error(flat(R), flat(turned @ R), N)
    assert found == pytest.approx(2 * math.sin(angle / 2) * N, abs=4e-15 / math.cos(swing / 2))


def test_upside_down_the_error_in_a_plane_is_half_a_turn():
    flipped = pose_error.planar_error(
        flat(np.eye(3)), flat(np.diag([1.0, -1, -1])), (0.0, 0.0, 1.0)
    )
    assert flipped == (0.0, 0.0, 2.0)


@given(st.integers(0, 2**32 - 1), st.integers(1, 8))
def test_in_a_plane_the_columns_have_the_turn_about_the_normal_and_what_is_across_it(seed, m):
    rng = np.random.default_rng(seed)
    J, v, n = rng.normal(size=(6, m)), rng.normal(size=3), rng.normal(size=3)
    n /= np.linalg.norm(n)
    along = np.outer(n, n)
    left = J.copy()
    pose_error.keep_in_plane(n, left, m)
    np.testing.assert_allclose(left[:3], along @ J[:3], rtol=0, atol=1e-14)
    np.testing.assert_allclose(left[3:], (np.eye(3) - along) @ J[3:], rtol=0, atol=1e-14)
    assert pose_error.across(n, v) == pytest.approx((np.eye(3) - along) @ v, abs=1e-14)


@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_differentiated_columns_lead_down_the_half_square_of_the_error(w, w_target):
    R, S = rotation(w), rotation(w_target)
    e = np.array([*pose_error.rotation_error(flat(R), flat(S)), 0.3, -0.2, 0.1])
    J = np.eye(6)
    pose_error.differentiate(e, J, 6)
    found = J.T @ e
    assert found[3:] == pytest.approx(e[3:], abs=1e-15)
    # E = |turn|^2 / 2 = 1 - cos(phi) = (3 - tr(S R^T)) / 2, and R' = [w] R
    expected = [0.5 * np.trace(S @ (np.cross(np.eye(3), -axis) @ R).T) for axis in np.eye(3)]
    assert np.abs(found[:3]) == pytest.approx(np.abs(expected), abs=3e-8)


def test_of_a_rounded_half_turn_no_column_leads_downhill():
    e = np.array([2.0 + 1e-9, 0.0, 0.0, 1.0, 2.0, 3.0])
    J = np.eye(6)
    pose_error.differentiate(e, J, 6)
    np.testing.assert_array_equal(J.T @ e, [0, 0, 0, 1, 2, 3])


def test_of_opposite_directions_the_columns_have_no_turn_about_them():
    a = np.array([0.0, 0.0, 1.0])
    e = np.array([2.0, 0.0, 0.0, 1.0, 2.0, 3.0])
    J, expected = np.eye(6), np.eye(6)
    pose_error.differentiate_direction(a, e, J, 6)
    pose_error.differentiate(e, expected, 6)
    np.testing.assert_array_equal(J, expected)


def test_the_distance_is_the_length_of_the_linear_half():
    assert pose_error.distance((9.0, 9.0, 9.0, 2.0, 3.0, 6.0)) == 7.0


@given(st.integers(0, 2**32 - 1), st.integers(1, 8))
def test_without_the_turn_about_a_direction_the_angular_columns_are_projected_across_it(seed, m):
    rng = np.random.default_rng(seed)
    J, a = rng.normal(size=(6, m)), rng.normal(size=3)
    a /= np.linalg.norm(a)
    left = J.copy()
    pose_error.remove_turn_about(a, left, m)
    np.testing.assert_allclose(left[:3], (np.eye(3) - np.outer(a, a)) @ J[:3], rtol=0, atol=1e-14)
    assert np.array_equal(left[3:], J[3:])
