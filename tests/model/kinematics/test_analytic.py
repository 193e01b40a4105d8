"""Analytic Jacobians: derivatives of the pose's numbers, at half a turn and at pitch ±90° too."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.formats import rpy
from poekin.model.kinematics import analytic
from poekin.model.kinematics.analytic import KINDS
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import differences
from tests.model.laws.chain_bounds import budget
from tests.model.laws.chain_cases import chain_cases

FEW = settings(max_examples=max(settings().max_examples // 2, 20))


def turn(axis, angle):
    """An arm of one joint about an axis, its tool on it turned by an angle."""
    return pk.Chain.from_space(
        [[*axis, 0, 0, 0]], pk.se3.exp([*(angle * np.array(axis, float)), 0, 0, 0])
    )


def wrist(pitch):
    """Three joints that are roll, pitch and yaw themselves, and its configuration with that pitch."""
    arm = pk.Chain.from_space(
        [[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0]], np.eye(4)
    )
    return arm, np.array([0.3, pitch, -0.7])


@FEW
@given(data=st.data(), kind=st.sampled_from(KINDS))
def test_it_is_the_derivative_of_the_numbers(data, kind):
    chain, q, dq = data.draw(chain_cases(("q", "dq")))
    rate = float(np.abs(chain.coupling @ dq).sum()) if chain.dof else 0.0
    x = chain.pose_coordinates(q, kind)
    # the stencil must not cross half a turn, where the vector and the quaternion jump, nor come
    # near pitch ±90°
    margin = np.pi - np.linalg.norm(chain.pose_coordinates(q, "rotation_vector")[:3])
    tilt = np.cos(chain.pose_coordinates(q, "rpy")[1])
    assume(
        margin > 0.7
        if kind != "rpy"
        else tilt > 0.7 and np.abs(np.abs(x[[0, 2]]) - np.pi).min() > 1.2
    )
    found = chain.analytic_jacobian(q, kind) @ dq
    wanted = differences.derivative(lambda at: chain.pose_coordinates(at, kind), q, dq, 8 * rate)
    # the sum of the stencil's weights over its step, 0.1/(8 rate), is what a difference makes of
    # rounding; the numbers are at most twice as far off as R, and rounded; of a function with the
    # margins above, truncation is 1e-14 rate
    turned, linear = budget(chain, q)
    numbers = 240 * (2 * turned + 4 * UNIT) + 1e-14
    error = np.abs(found - wanted)
    assert error[:-3].max() <= max(rate, 1) * numbers
    assert error[-3:].max() <= max(rate, 1) * (240 * linear + 1e-14 * chain.reach)


def angular(chain, q):
    """The budget of R at configurations (rows, m), rad."""
    return budget(chain, q)[0]


def maps_off(chain, q):
    """How far the maps of rates back to omega are from undoing those from it, at configurations
    (rows, m), ÷ rounding.

    The logarithm of R is off by up to pi/2 of what R is, the derivative of J_l⁻¹ by w is at most 1,
    and omega comes by two ways: together 2 (1 + pi/2) < 8 times the budget and u, which is an
    eighth of it, a rad per unit of q. Of roll, pitch and yaw it is 1/cos(pitch) squared times that.
    """
    T, J = chain.fk_jacobian(q, "hybrid")
    J, J_q = J[:, :3], chain.analytic_jacobian(q, "quaternion_wxyz")[:, :4]
    size = 8 * angular(chain, q) * max(1.0, np.abs(chain.coupling).sum(axis=0).max(initial=0))
    w = chain.pose_coordinates(q, "rotation_vector")[:, :3]
    off = [pk.so3.left_jacobian(w) @ chain.analytic_jacobian(q, "rotation_vector")[:, :3] - J]
    Q = chain.pose_coordinates(q, "quaternion_wxyz")[:, :4, None]
    # omega = 2 (w dv - dw v + v x dv), and Q stays of unit length
    v, dw, dv = Q[:, 1:], J_q[:, :1], J_q[:, 1:]
    off.append(2 * (Q[:, :1] * dv - v * dw + np.cross(v, dv, axis=1)) - J)
    off.append((Q * J_q).sum(axis=1, keepdims=True))
    regular = np.hypot(T[:, 0, 0], T[:, 1, 0]) > 1e-3
    # omega = roll' x + pitch' y + yaw' z, each axis turned by the angles after it
    _, pitch, yaw = chain.pose_coordinates(q[regular], "rpy")[:, :3].T
    zero, one, (cosine, sine) = 0 * pitch, 0 * pitch + 1, (np.cos(pitch), np.sin(pitch))
    axes = [
        [np.cos(yaw) * cosine, np.sin(yaw) * cosine, -sine],
        [-np.sin(yaw), np.cos(yaw), zero],
        [zero, zero, one],
    ]
    back = np.transpose(axes, (2, 1, 0)) @ chain.analytic_jacobian(q[regular], "rpy")[:, :3]
    off.append(np.zeros_like(J))
    off[-1][regular] = (back - J[regular]) * cosine[:, None, None] ** 2
    return np.max([np.abs(error).max(axis=(1, 2), initial=0.0) for error in off], axis=0) / size


def numbers_off(chain, q):
    """How far the numbers of poses (rows, ...) are from them ÷ what R misses being a rotation by,
    and rounding.
    """
    R, size = chain.fk(q)[:, :3, :3], angular(chain, q) + 16 * UNIT
    found = {kind: chain.pose_coordinates(q, kind)[:, :-3] for kind in KINDS}
    Q = found["quaternion_wxyz"]
    v = pk.so3.hat(Q[:, 1:])
    of_q = np.eye(3) + 2 * Q[:, :1, None] * v + 2 * v @ v
    of_rpy = np.reshape(
        [rpy.pose([0, 0, 0], row)[:3, :3] for row in found["rpy"].tolist()], R.shape
    )
    worst = [
        np.abs(X - R).max(axis=(1, 2)) for X in (pk.so3.exp(found["rotation_vector"]), of_q, of_rpy)
    ]
    return np.max([*worst, np.abs((Q * Q).sum(axis=1) - 1)], axis=0) / size


ANY = chain_cases(("q",), max_joints=6)


@FEW
@given(ANY)
def test_the_map_back_to_angular_velocity_undoes_it(case):
    chain, q = case
    assert maps_off(chain, q[None]).item() <= 1


@FEW
@given(ANY)
def test_the_numbers_are_the_pose(case):
    chain, q = case
    assert numbers_off(chain, q[None]).item() <= 1
    assert chain.pose_coordinates(q, "quaternion_wxyz")[0] >= 0
    for kind in KINDS:
        np.testing.assert_array_equal(chain.pose_coordinates(q, kind)[-3:], chain.fk(q)[:3, 3])


def test_roll_pitch_and_yaw_of_a_wrist_of_them_are_its_coordinates():
    arm, q = wrist(0.4)
    np.testing.assert_allclose(arm.pose_coordinates(q, "rpy")[:3], q[::-1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        arm.analytic_jacobian(q, "rpy")[:3], np.eye(3)[::-1], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_rpy_near_its_singularity_loses_what_it_says(off):
    arm, q = wrist(np.pi / 2 - off)
    assert np.abs(arm.analytic_jacobian(q, "rpy")[:3] - np.eye(3)[::-1]).max() <= 1e-15 / off**2


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2, np.pi / 2 + 1e-9])
def test_rpy_at_its_singularity_is_refused_with_numbers(pitch):
    arm, q = wrist(pitch)
    with pytest.raises(
        InputError,
        match=r"^q\[1\]: roll and yaw have no rates at pitch ±90°; here pitch = -?(90|89\.99)",
    ):
        arm.analytic_jacobian([0 * q, q], "rpy")
    for kind in ("rotation_vector", "quaternion_wxyz"):
        assert np.isfinite(arm.analytic_jacobian(q, kind)).all()


def test_at_half_a_turn_the_jacobian_is_that_of_the_branch():
    arm = turn([0, 0.6, 0.8], np.pi)
    assert (
        np.abs(arm.pose_coordinates([0.0], "quaternion_wxyz")[:4] - [0, 0, 0.6, 0.8]).max() < 1e-15
    )
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
    with pytest.raises(
        InputError,
        match=r"^kind: expected 'rotation_vector', 'quaternion_wxyz' or 'rpy', got ",
    ):
        wrist(0.1)[0].analytic_jacobian([0.0] * 3, kind)


HAT, INVERSE = pk.so3.hat, pk.so3.left_jacobian_inverse
PLANTED = {
    "the right Jacobian for the left": (
        "rotation_vector",
        "left_jacobian_inverse",
        lambda w: INVERSE(-w),
    ),
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
