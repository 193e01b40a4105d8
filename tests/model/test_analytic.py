"""Analytic Jacobians: derivatives of the pose's numbers, at half a turn and at pitch ±90° too."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.formats import rpy
from poekin.model import analytic
from poekin.model.analytic import KINDS
from poekin.testing import chain_strategies, differences
from poekin.testing.chain_laws import budget

FEW = settings(max_examples=max(settings().max_examples // 2, 20))


def turn(axis, angle):
    """An arm of one joint about an axis, its tool on it turned by an angle."""
    return pk.Chain([[*axis, 0, 0, 0]], pk.se3.exp([*(angle * np.array(axis, float)), 0, 0, 0]))


def wrist(pitch):
    """Three joints that are roll, pitch and yaw themselves, and its configuration with that pitch."""
    arm = pk.Chain([[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0]], np.eye(4))
    return arm, np.array([0.3, pitch, -0.7])


@FEW
@given(data=st.data(), kind=st.sampled_from(KINDS))
def test_it_is_the_derivative_of_the_numbers(data, kind):
    chain, q, dq = data.draw(chain_strategies.chain_cases(("q", "dq")))
    rate = float(np.abs(chain.coupling @ dq).sum()) if chain.dof else 0.0
    x = chain.pose_coordinates(q, kind)
    # the stencil must not cross half a turn, where the vector and the quaternion jump, nor come near pitch ±90°
    margin = np.pi - np.linalg.norm(chain.pose_coordinates(q, "rotation_vector")[:3])
    tilt = np.cos(chain.pose_coordinates(q, "rpy")[1])
    assume(margin > 0.7 if kind != "rpy" else tilt > 0.7 and np.abs(np.abs(x[[0, 2]]) - np.pi).min() > 1.2)
    found = chain.analytic_jacobian(q, kind) @ dq
    wanted = differences.derivative(lambda at: chain.pose_coordinates(at, kind), q, dq, 4 * rate)
    # the rounding of the values over the step of 0.025/rate; truncation is 1e-16 of the function's growth, which the
    # margins keep within some hundreds
    size = budget(chain, q)[1]
    assert np.abs(found - wanted).max() <= max(rate, 1) * (1e3 * size + 1e-10)


@FEW
@given(data=st.data())
def test_the_map_back_to_angular_velocity_undoes_it(data):
    chain, q = data.draw(chain_strategies.chain_cases(("q",), max_joints=6))
    J = chain.jacobian(q, "hybrid")
    w = chain.pose_coordinates(q, "rotation_vector")[:3]
    size = 1e3 * budget(chain, q)[1] * (1 + np.abs(J).sum())
    back = pk.so3.left_jacobian(w) @ chain.analytic_jacobian(q, "rotation_vector")[:3]
    assert np.abs(back - J[:3]).max(initial=0.0) <= size
    Q, dQ = chain.pose_coordinates(q, "quaternion_wxyz")[:4], chain.analytic_jacobian(q, "quaternion_wxyz")[:4]
    # omega = 2 (w dv - dw v + v x dv), and Q stays of unit length
    back = 2 * (Q[0] * dQ[1:] - np.outer(Q[1:], dQ[0]) + np.cross(Q[1:], dQ[1:], axisb=0, axisc=0))
    assert np.abs(back - J[:3]).max(initial=0.0) <= size
    assert np.abs(Q @ dQ).max(initial=0.0) <= size


@FEW
@given(data=st.data())
def test_the_numbers_are_the_pose(data):
    chain, q = data.draw(chain_strategies.chain_cases(("q",)))
    T, size = chain.fk(q), 1e-14 + 8 * budget(chain, q)[0]
    w = chain.pose_coordinates(q, "rotation_vector")
    assert np.abs(pk.so3.exp(w[:3]) - T[:3, :3]).max() <= size
    np.testing.assert_array_equal(w[3:], T[:3, 3])
    a, *v = Q = chain.pose_coordinates(q, "quaternion_wxyz")[:4]
    R = np.eye(3) + 2 * a * pk.so3.hat(v) + 2 * pk.so3.hat(v) @ pk.so3.hat(v)
    assert np.abs(R - T[:3, :3]).max() <= size
    assert a >= 0
    assert abs(Q @ Q - 1) < 1e-14
    angles = chain.pose_coordinates(q, "rpy")[:3]
    assert np.abs(rpy.pose([0, 0, 0], angles.tolist())[:3, :3] - T[:3, :3]).max() <= size


def test_roll_pitch_and_yaw_of_a_wrist_of_them_are_its_coordinates():
    arm, q = wrist(0.4)
    np.testing.assert_allclose(arm.pose_coordinates(q, "rpy")[:3], q[::-1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(arm.analytic_jacobian(q, "rpy")[:3], np.eye(3)[::-1], rtol=0, atol=1e-15)


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_rpy_near_its_singularity_loses_what_it_says(off):
    arm, q = wrist(np.pi / 2 - off)
    assert np.abs(arm.analytic_jacobian(q, "rpy")[:3] - np.eye(3)[::-1]).max() <= 1e-15 / off**2


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2, np.pi / 2 + 1e-9])
def test_rpy_at_its_singularity_is_refused_with_numbers(pitch):
    arm, q = wrist(pitch)
    with pytest.raises(
        InputError, match=r"^q\[1\]: roll and yaw have no rates at pitch ±90°; here pitch = -?(90|89\.99)"
    ):
        arm.analytic_jacobian([0 * q, q], "rpy")
    for kind in ("rotation_vector", "quaternion_wxyz"):
        assert np.isfinite(arm.analytic_jacobian(q, kind)).all()


def test_at_half_a_turn_the_jacobian_is_that_of_the_branch():
    arm = turn([0, 0.6, 0.8], np.pi)
    assert np.abs(arm.pose_coordinates([0.0], "quaternion_wxyz")[:4] - [0, 0, 0.6, 0.8]).max() < 1e-15
    np.testing.assert_allclose(
        arm.analytic_jacobian([0.0], "rotation_vector")[:3, 0], [0, 0.6, 0.8], rtol=0, atol=1e-15
    )
    np.testing.assert_allclose(
        arm.analytic_jacobian([0.0], "quaternion_wxyz")[:4, 0], [-0.5, 0, 0, 0], rtol=0, atol=1e-15
    )


def test_the_quaternion_changes_sign_past_half_a_turn():
    arm = turn([0, 0, 1], 0.0)
    before, after = arm.pose_coordinates([[np.pi - 0.1], [np.pi + 0.1]], "quaternion_wxyz")
    np.testing.assert_allclose(before[:4], [np.sin(0.05), 0, 0, np.cos(0.05)], rtol=0, atol=1e-15)
    np.testing.assert_allclose(after[:4], [np.sin(0.05), 0, 0, -np.cos(0.05)], rtol=0, atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_batches_have_their_shapes_and_nan_stays_where_it_is(kind):
    arm, q = wrist(0.3)
    rows = 7 if kind == "quaternion_wxyz" else 6
    for shape in ((), (0,), (3, 1, 2)):
        at = np.broadcast_to(q, (*shape, 3))
        assert arm.analytic_jacobian(at, kind).shape == (*shape, rows, 3)
        assert arm.pose_coordinates(at, kind).shape == (*shape, rows)
    J = arm.analytic_jacobian([q, [np.nan] * 3], kind)
    assert np.isfinite(J[0]).all()
    assert np.isnan(J[1, :-3]).any()


@pytest.mark.parametrize("kind", ["quaternion", "euler", 3, None])
def test_a_kind_that_is_none_is_refused(kind):
    with pytest.raises(InputError, match=r"^kind: expected one of 'rotation_vector', 'quaternion_wxyz', 'rpy', got "):
        wrist(0.1)[0].analytic_jacobian([0.0] * 3, kind)


HAT, INVERSE = pk.so3.hat, pk.so3.left_jacobian_inverse
PLANTED = {
    "the right Jacobian for the left": ("rotation_vector", "left_jacobian_inverse", lambda w: INVERSE(-w)),
    "omega in tool axes": ("quaternion_wxyz", "hat", lambda v: -HAT(v)),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_the_comparison_sees_what_is_wrong(fault, monkeypatch):
    kind, name, wrong = PLANTED[fault]
    arm, q = wrist(0.4)
    wanted = differences.derivative(lambda at: arm.pose_coordinates(at, kind), q, np.ones(3), 12)
    assert np.abs(arm.analytic_jacobian(q, kind).sum(1) - wanted).max() < 1e-11
    monkeypatch.setattr(analytic.so3, name, wrong)
    assert np.abs(arm.analytic_jacobian(q, kind).sum(1) - wanted).max() > 1e-3
