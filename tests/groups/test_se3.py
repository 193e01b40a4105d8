"""SE(3): every law of a group, and what is particular to poses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

from poekin.errors import BranchError, PoseError, ShapeError
from poekin.groups import se3
from poekin.testing.laws.group import make_group
from poekin.testing.laws.group_laws import GROUP_LAWS
from poekin.testing.strategies import group_strategies
from tests.groups.near_laws import NEAR_LAWS

SE3 = make_group(se3, 6)
# Where a formula changes over, one example in a hundred may be the only one that shows it.
MORE = settings(max_examples=2 * settings().max_examples)


@pytest.mark.parametrize("law", [*GROUP_LAWS, *NEAR_LAWS], ids=lambda law: law.name)
@MORE
@given(data=st.data())
def test_poses_keep_the_law(law, data):
    target(law.check(SE3, *data.draw(group_strategies.group_cases(law.kinds, 6))))


# Pinocchio's own faults lie outside: near 0 and beyond 3 rad its log, exp and Jacobians lose up to
# ten digits.
WHERE_PINOCCHIO_IS_RIGHT = group_strategies.twists(3.0, (1e-3, 10.0)).filter(
    lambda xi: 0.1 < np.linalg.norm(xi[:3]) < 3
)


@given(WHERE_PINOCCHIO_IS_RIGHT)
def test_pinocchio_agrees_where_it_is_right(xi):
    pin = pytest.importorskip("pinocchio")
    v_first, T, scale = se3.linear_first(xi), se3.exp(xi), 1 + np.linalg.norm(xi[3:])
    assert np.abs(pin.exp6(v_first).homogeneous - T).max() < 1e-13 * scale
    assert np.abs(se3.linear_first(pin.log6(T).vector) - se3.log(T)).max() < 1e-12 * scale
    for theirs, ours in (
        (pin.Jexp6(v_first), se3.right_jacobian(xi)),
        (pin.Jlog6(pin.SE3(T)), se3.right_jacobian_inverse(xi)),
        (pin.SE3(T).action, se3.adjoint(T)),
    ):
        angular_first = se3.linear_first(se3.linear_first(theirs, axis=0), axis=1)
        assert np.abs(angular_first - ours).max() < 1e-11 * scale


def test_the_angular_part_comes_first():
    assert np.array_equal(se3.exp([0, 0, 0, 1, 2, 3])[:3, 3], [1, 2, 3])
    assert np.array_equal(se3.exp([0, 0, 0.5, 0, 0, 0])[:3, 3], [0, 0, 0])


@given(group_strategies.poses(), st.sampled_from([(), (2,), (3, 1)]))
def test_pose_puts_rotation_and_translation_together_over_the_batch(T, batch):
    R = np.broadcast_to(T[:3, :3], (*batch, 3, 3))
    for rotation, translation in ((R, T[:3, 3]), (T[:3, :3], np.tile(T[:3, 3], (*batch, 1)))):
        made = se3.pose(rotation, translation)
        assert np.array_equal(made, np.broadcast_to(T, (*batch, 4, 4)))
    made[...] = 0.0  # a new array, which shares nothing with what it was made of
    assert T[3, 3] == 1.0


def test_pose_lets_nan_through_and_refuses_what_is_no_rotation_or_does_not_fit():
    assert np.isnan(se3.pose(np.eye(3), [0.0, np.nan, 0.0])[1, 3])
    assert np.isnan(se3.pose(np.full((3, 3), np.nan), np.zeros(3))[:3, :3]).all()
    with pytest.raises(PoseError, match=r"R is no rotation: its rotation is a reflection"):
        se3.pose(-np.eye(3), np.zeros(3))
    with pytest.raises(ShapeError, match=r"p: expected shape \(..., 3\), got \(4,\)"):
        se3.pose(np.eye(3), np.zeros(4))
    with pytest.raises(
        ShapeError, match=r"p: shape \(3, 3\) does not broadcast against \(2, 3, 3\)"
    ):
        se3.pose(np.tile(np.eye(3), (2, 1, 1)), np.zeros((3, 3)))


def test_linear_first_swaps_the_halves_and_undoes_itself():
    x = np.arange(12.0).reshape(2, 6)
    assert se3.linear_first(x).tolist() == [[3, 4, 5, 0, 1, 2], [9, 10, 11, 6, 7, 8]]
    assert np.array_equal(se3.linear_first(se3.linear_first(x)), x)
    assert np.array_equal(se3.linear_first(x.T, axis=0), se3.linear_first(x).T)


def test_linear_first_needs_six():
    with pytest.raises(ShapeError, match="length 6"):
        se3.linear_first(np.zeros((6, 5)))


def test_linear_first_on_both_axes_turns_ad_into_that_of_linear_first_twists():
    xi, eta = (
        np.array([0.3, -1.0, 2.0, 0.5, 0.25, -4.0]),
        np.array([1.5, 0.5, -2.0, 3.0, -0.125, 1.0]),
    )
    ad = se3.linear_first(se3.linear_first(se3.ad(xi), axis=0), axis=1)
    assert np.abs(ad @ se3.linear_first(eta) - se3.linear_first(se3.ad(xi) @ eta)).max() < 1e-14


def test_at_pi_omega_is_the_documented_one_and_v_goes_with_it():
    T = np.diag([1.0, -1.0, -1.0, 1.0])
    T[:3, 3] = [2.0, 0.0, 1.0]
    xi = se3.log(T)
    assert np.array_equal(xi[:3], [np.pi, 0, 0])
    assert np.abs(se3.exp(xi) - T).max() < 1e-15


@pytest.mark.parametrize("turns", [1, 2, -1])
@pytest.mark.parametrize("axis", [(0, 0, 1), (0.6, -0.64, 0.48)])
def test_a_full_turn_is_a_logarithm_of_a_translation_along_its_axis(turns, axis):
    near = np.concatenate([2 * np.pi * turns * np.array(axis), np.zeros(3)])
    T = np.eye(4)
    T[:3, 3] = 0.7 * np.array(axis)
    xi = se3.log(T, near=near)
    assert np.abs(xi[:3] - near[:3]).max() < 1e-14
    assert np.abs(se3.exp(xi) - T).max() < 1e-14


@pytest.mark.parametrize("turns", [1, 2, -1])
def test_a_full_turn_is_refused_where_the_translation_is_not_along_its_axis(turns):
    T = np.tile(np.eye(4), (2, 1, 1))
    T[1, 0, 3] = 1e-3
    near = [0, 0, 2 * np.pi * turns, 0, 0, 0]
    with pytest.raises(BranchError, match=r"T\[1\].*2 pi k"):
        se3.log(T, near=near)
    assert se3.log(T[0], near=near).shape == (6,)
    assert np.array_equal(se3.log(T[1], near=np.zeros(6)), [0, 0, 0, 1e-3, 0, 0])


def test_near_broadcasts_against_the_poses():
    T = se3.exp([[0, 0, 0.2, 1, 2, 3], [0, 0.1, 0, 0, 0, 0]])
    near = [[[0, 0, 6.5, 0, 0, 0]], [[0, 0, 0, 0, 0, 0]], [[0, 13.0, 0, 0, 0, 0]]]
    assert se3.log(T, near=near).shape == (3, 2, 6)
    with pytest.raises(ShapeError, match="near"):
        se3.log(T, near=np.zeros((3, 6)))


def test_a_matrix_that_is_no_pose_is_refused_with_its_place_and_reason():
    T = np.tile(np.eye(4), (3, 1, 1))
    T[2, 0, 1] = 3e-5
    for function in (se3.log, se3.inverse, se3.adjoint):
        with pytest.raises(PoseError, match=r"T\w*\[2\].*3e-05.*1e-05"):
            function(T)
    T[2] = np.diag([1.0, 1.0, -1.0, 1.0])
    with pytest.raises(PoseError, match=r"T\w*\[2\].*reflection"):
        se3.log(T)
    T[2] = np.eye(4)
    T[2, 3, 0] = 1.0
    with pytest.raises(PoseError, match=r"T\w*\[2\].*last row"):
        se3.log(T)


@pytest.mark.parametrize("function", [se3.exp, se3.hat, se3.ad, se3.left_jacobian, se3.log])
def test_a_wrong_shape_is_refused(function):
    with pytest.raises(ShapeError, match="expected shape"):
        function(np.zeros((2, 5)))
