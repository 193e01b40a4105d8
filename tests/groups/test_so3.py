"""SO(3): every law of a group, and what is particular to rotations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

from poekin.errors import PoseError, ShapeError
from poekin.groups import so3
from poekin.testing.laws.group import make_group
from poekin.testing.laws.group_laws import GROUP_LAWS
from poekin.testing.strategies import group_strategies
from tests.groups.near_laws import NEAR_LAWS

SO3 = make_group(so3, 3)
# Where a formula changes over, one example in a hundred may be the only one that shows it.
MORE = settings(max_examples=2 * settings().max_examples)


@pytest.mark.parametrize("law", [*GROUP_LAWS, *NEAR_LAWS], ids=lambda law: law.name)
@MORE
@given(data=st.data())
def test_rotations_keep_the_law(law, data):
    target(law.check(SO3, *data.draw(group_strategies.group_cases(law.kinds, 3))))


def test_hat_is_the_cross_product():
    w, x = np.array([0.3, -1.2, 2.0]), np.array([1.5, 0.2, -0.7])
    assert np.abs(so3.hat(w) @ x - np.cross(w, x)).max() < 1e-15


def test_a_quarter_turn_about_z_takes_x_to_y():
    R = so3.exp([0, 0, np.pi / 2])
    assert np.abs(R @ [1, 0, 0] - [0, 1, 0]).max() < 2e-16


@pytest.mark.parametrize(
    "n", [(1, 0, 0), (0, -1, 0), (0, 0, 1), (0.6, -0.8, 0), (-0.48, 0.6, -0.64)]
)
def test_at_pi_the_component_of_largest_magnitude_is_positive(n):
    n = np.array(n)
    R = 2 * np.outer(n, n) - np.eye(3)
    expected = np.pi * n * np.sign(n[np.argmax(np.abs(n))])
    assert np.abs(so3.log(R) - expected).max() < 1e-15


@pytest.mark.parametrize("sign", [1, -1])
def test_the_sign_is_right_down_to_9e_16_from_pi(sign):
    angle = np.pi - 9e-16
    R = so3.exp([0, 0, sign * angle])
    assert so3.log(R)[2] == sign * angle


def test_a_rotation_that_misses_orthonormality_is_refused_with_its_place():
    R = np.tile(np.eye(3), (2, 3, 1, 1))
    R[1, 2, 0, 1] = 3e-5
    for function in (so3.log, so3.inverse, so3.adjoint):
        with pytest.raises(PoseError, match=r"R\[1, 2\].*3e-05.*1e-05"):
            function(R)
    R[1, 2, 0, 1] = 3e-6
    assert so3.log(R).shape == (2, 3, 3)


def test_a_reflection_is_refused():
    with pytest.raises(PoseError, match="reflection"):
        so3.log(np.diag([1.0, 1.0, -1.0]))
    # where what it misses of R R^T = I is just accepted
    with pytest.raises(PoseError, match="reflection"):
        so3.log(np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 1e-5], [0.0, 0.0, 1.0]]))


@pytest.mark.parametrize(
    ("function", "wrong"),
    [(so3.exp, (4,)), (so3.hat, ()), (so3.log, (3, 4)), (so3.vee, (3,)), (so3.left_jacobian, (6,))],
)
def test_a_wrong_shape_is_refused(function, wrong):
    with pytest.raises(ShapeError, match="expected shape"):
        function(np.zeros(wrong))


@pytest.mark.parametrize("sign", [1, -1])
def test_near_goes_the_other_way_round_where_that_is_closer(sign):
    w = sign * np.array([0.14453346, 0.0, 0.0])
    found = so3.log(so3.exp(w), near=[-3.0 * sign, 0.0, 0.0])
    assert np.abs(found - [sign * (0.14453346 - 2 * np.pi), 0.0, 0.0]).max() < 2e-15


@pytest.mark.parametrize("k", range(3))
def test_exp_leaves_a_frame_axis_that_it_turns_about_where_it_is_to_the_last_bit(k):
    axis = np.eye(3)[k]
    R = so3.exp(np.linspace(-10, 10, 401)[:, None] * axis)
    np.testing.assert_array_equal(R[:, k], np.tile(axis, (401, 1)))
    np.testing.assert_array_equal(R[:, :, k], np.tile(axis, (401, 1)))


@pytest.mark.parametrize("function", [so3.exp, so3.axis_angle])
def test_the_matrix_of_a_vector_in_its_place_is_refused(function):
    for w in ([1, 2, 3], [0, 0, 1e-300], [np.inf, 0, 0]):
        with pytest.raises(
            ShapeError, match=r"^w: expected rotation vectors \(\.\.\., 3\), .*so3.vee of it is w"
        ):
            function(so3.hat(w))
    skew = so3.hat([1, 2, 3])
    nearly = skew + np.diag([0, 0, 1e-12])
    for three in (np.zeros((3, 3)), np.eye(3), -np.eye(3), nearly, skew * np.nan):
        function(three)
    function(skew[None])
