"""Axis and angle of rotation vectors, unit screw and angle of twists: their product is the whole."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import ShapeError
from poekin.groups import se3, so3
from poekin.testing.strategies import group_strategies

U = 2.0**-53
SIZES = st.floats(1e-300, 1e300)


@given(group_strategies.axes(), SIZES)
def test_the_axis_has_length_1_and_times_the_angle_is_the_vector(n, size):
    w = n * size
    axis, angle = so3.axis_angle(w)
    assert abs(np.linalg.norm(axis) - 1) <= 5 * U
    assert (np.abs(axis * angle - w) <= 10 * U * np.abs(w) + 5e-324).all()
    assert angle >= 0


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-160, 1e160, 1.7e308])
def test_neither_the_smallest_nor_the_largest_numbers_are_lost(size):
    axis, angle = so3.axis_angle([0.0, -size, 0.0])
    assert axis.tolist() == [0.0, -1.0, 0.0]
    assert angle == size
    screw, theta = se3.axis_angle([0.0, 0.0, 0.0, -size, 0.0, 0.0])
    assert screw.tolist() == [0.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    assert theta == size


@given(group_strategies.twists())
def test_a_twist_is_its_screw_times_theta(V):
    screw, theta = se3.axis_angle(V)
    assert (np.abs(screw * theta - V) <= 12 * U * np.abs(V)).all()
    unit = screw[:3] if V[:3].any() else screw[3:]
    assert abs(np.linalg.norm(unit) - 1) <= 5 * U
    assert V[:3].any() or not screw[:3].any()
    if V[:3].any():
        assert np.array_equal(screw[:3], so3.axis_angle(V[:3]).axis)
        assert theta == so3.axis_angle(V[:3]).angle


def test_nothing_goes_along_z():
    axis, angle = so3.axis_angle(np.zeros(3))
    assert axis.tolist() == [0.0, 0.0, 1.0]
    assert angle == 0.0
    screw, theta = se3.axis_angle(np.zeros(6))
    assert screw.tolist() == [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    assert theta == 0.0


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)])
def test_a_batch_is_its_elements(shape):
    V = np.random.default_rng(0).normal(size=(*shape, 6))
    if V.size:
        V.reshape(-1, 6)[-1, :3] = 0.0
    axis, angle = so3.axis_angle(V[..., 3:])
    screw, theta = se3.axis_angle(V)
    assert (axis.shape, angle.shape) == ((*shape, 3), shape)
    assert (screw.shape, theta.shape) == ((*shape, 6), shape)
    for index in np.ndindex(shape):
        assert np.array_equal(so3.axis_angle(V[index][3:]).axis, axis[index])
        assert so3.axis_angle(V[index][3:]).angle == angle[index]
        assert np.array_equal(se3.axis_angle(V[index]).screw, screw[index])
        assert se3.axis_angle(V[index]).theta == theta[index]


@pytest.mark.parametrize("poison", [np.nan, np.inf])
def test_what_is_not_finite_stays_in_its_element(poison):
    V = np.arange(18.0).reshape(3, 6)
    V[1, [2, 4]] = poison
    screw, theta = se3.axis_angle(V)
    assert np.isfinite(screw[[0, 2]]).all()
    assert np.isfinite(theta[[0, 2]]).all()
    assert np.isnan(theta[1])
    assert np.isnan(so3.axis_angle(V[:, :3]).axis[1]).all()


def test_a_screw_of_an_arm_comes_back_from_the_pose_that_it_makes():
    S = np.array([0.0, 0.6, 0.8, -0.3, 0.8, -0.6])
    screw, theta = se3.axis_angle(se3.log(se3.exp(0.7 * S)))
    assert np.abs(screw - S).max() < 1e-15
    assert abs(theta - 0.7) < 1e-15


def test_a_pose_and_a_matrix_of_a_vector_are_refused():
    with pytest.raises(
        ShapeError, match=r"^xi: expected shape \(..., 6\), got \(4, 4\): pk.se3.log of"
    ):
        se3.axis_angle(np.eye(4))
    with pytest.raises(ShapeError, match=r"so3.vee of it is w"):
        so3.axis_angle(so3.hat([1, 2, 3]))


def test_an_axis_of_the_other_sign_is_seen(monkeypatch):
    right = se3.axis_angle
    monkeypatch.setattr(se3, "axis_angle", lambda V: (-right(V)[0], right(V)[1]))
    with pytest.raises(AssertionError):
        test_a_twist_is_its_screw_times_theta()
