"""An arm's parameters move its screws as the equations say, and the jacobian are those of the poses."""

from __future__ import annotations

import ast
import re

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, UnknownName
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.parameters import KINDS
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import differences
from poekin.testing.strategies import chain_strategies
from tests.model.laws.chain_bounds import budget

FEW = settings(max_examples=max(settings().max_examples // 3, 20))
PUMA = pk.load("puma560").chain()


def drawn(data, **options) -> tuple[pk.Chain, ErrorModel, np.ndarray, np.ndarray]:
    """A chain, all its parameters, values of up to some hundredths, and three configurations."""
    chain = data.draw(chain_strategies.chains(min_joints=1, max_joints=5, **options))
    kinds = data.draw(st.lists(st.sampled_from(KINDS), min_size=1, unique=True))
    try:
        arm = ErrorModel(chain, kinds, None)
    except InputError:  # pitches of prismatic joints alone, and the like
        reject()
    rng = np.random.default_rng(data.draw(st.integers(0, 2**16)))
    return (
        chain,
        arm,
        0.05 * rng.normal(size=len(arm.parameters)),
        rng.uniform(-2, 2, (3, chain.dof)),
    )


def rounding(chain: pk.Chain, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What poses of a chain whose screws were moved may be off by, in rad and in m (rows,), at
    joint values (rows, n).

    The budget of `fk`; and a screw that was moved, by its own parameters and those of the joints
    before it, is off by 24 u a joint, and moves what is behind it by that times its x.
    """
    joints = pk.Chain.from_space(chain.screws, chain.home, pitches=chain.pitches)
    angular, linear = np.transpose([budget(joints, row) for row in x])
    moved = 24 * UNIT * (len(chain.screws) + 1) * (1 + np.abs(x).sum(axis=1))
    return angular + moved, linear + moved * (chain.reach + np.abs(x) @ np.abs(chain.local.slides))


def slopes_off(arm: ErrorModel, p: np.ndarray, q: np.ndarray, some: np.ndarray) -> np.ndarray:
    """How far the jacobian of some parameters are from those of the poses, by differences of order
    12, ÷ rounding.

    Of each parameter and at each configuration.

    An axis tilted by an angle turns the tool by up to twice that; zeros and gains turn it by their
    ratios and readings. What a difference makes of the rounding of poses is 30 times the rate; the
    screw's own moment is as far as the tool.
    """
    T, D = arm.poses_and_twists(p, q)
    found, x = arm.joints(p), arm.values(p, q)
    rate = 2 + float((np.abs(arm.nominal.coupling) @ (1 + np.abs(q)).T).max())
    angular, linear = (60 * rate * part for part in rounding(found, x))
    worst = []
    for k in some:
        direction = np.eye(len(p))[k]
        X = differences.derivative(lambda at: arm.poses(at, q), p, direction, rate) @ np.linalg.inv(
            T
        )
        off = np.abs(
            D[..., k] - np.stack([X[:, 2, 1], X[:, 0, 2], X[:, 1, 0], *X[:, :3, 3].T], axis=-1)
        )
        worst.append(np.maximum(off[:, :3].max(axis=1) / angular, off[:, 3:].max(axis=1) / linear))
    return np.array(worst)


def chain_off(arm: ErrorModel, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """How far the poses of the chain of parameters are from those of the parameters ÷ rounding of
    both, at each q.
    """
    found = arm.chain(p)
    off = np.abs(found.fk(q) - arm.poses(p, q))
    angular, linear = rounding(found, arm.values(p, q))
    return (
        np.maximum(off[:, :3, :3].max(axis=(1, 2)) / angular, off[:, :3, 3].max(axis=1) / linear)
        / 2
    )


@FEW
@given(data=st.data())
def test_the_slopes_are_those_of_the_poses(data):
    _, arm, p, q = drawn(data)
    T, D = arm.poses_and_twists(p, q)
    assert D.shape == (3, 6, len(p))
    np.testing.assert_array_equal(T, arm.poses(p, q))
    # four parameters of each arm: a difference takes twelve chains
    assert slopes_off(arm, p, q, np.random.default_rng(len(p)).permutation(len(p))[:4]).max() <= 1


@FEW
@given(data=st.data())
def test_the_chain_has_the_poses_of_its_parameters(data):
    chain, arm, p, q = drawn(data)
    found = arm.chain(p)
    assert chain_off(arm, p, q).max() <= 1
    assert (found.joint_names, found.q_names, found.base, found.tip) == (
        chain.joint_names, chain.q_names, chain.base, chain.tip,
    )  # fmt: skip
    np.testing.assert_array_equal(found.limits, chain.limits)


@FEW
@given(data=st.data())
def test_without_a_change_the_arm_is_the_nominal_one_to_the_last_digit(data):
    chain, arm, p, _ = drawn(data)
    found = arm.chain(0 * p)
    for name in ("coupling", "offset", "limits"):
        np.testing.assert_array_equal(getattr(found, name), getattr(chain, name))
    np.testing.assert_array_equal(found.screws, chain.screws)
    np.testing.assert_array_equal(found.home, chain.home)


@FEW
@given(data=st.data())
def test_axes_stay_unit_and_pitches_what_they_are(data):
    chain = data.draw(chain_strategies.chains(min_joints=1, max_joints=6))
    arm = ErrorModel(chain, ("screws", "home"), None)
    p = 0.3 * np.random.default_rng(1).normal(size=len(arm.parameters))
    found = arm.chain(p)
    assert found.kinds == chain.kinds
    turns = chain.local.rotates != 0
    size = np.where(
        turns,
        np.linalg.norm(found.screws[:, :3], axis=1),
        np.linalg.norm(found.screws[:, 3:], axis=1),
    )
    np.testing.assert_allclose(
        size, 1.0, rtol=0, atol=4.5e-16 + 4 * UNIT
    )  # what is taken for 1, and of this length
    pitch = np.sum(found.screws[:, :3] * found.screws[:, 3:], axis=1)
    old = np.sum(chain.screws[:, :3] * chain.screws[:, 3:], axis=1)
    np.testing.assert_allclose(
        pitch, old, rtol=0, atol=4e-15 * max(1.0, np.abs(found.screws[:, 3:]).max())
    )


def test_a_revolute_joint_has_four_parameters_a_prismatic_one_two_and_the_home_pose_six():
    A = [[0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 1, 0], [1, 0, 0, 0.3, 0.5, 0.1]]
    arm = ErrorModel(
        pk.Chain.from_space(A, np.eye(4), joint_names=["turn", "slide", "screw"]),
        ("screws", "home"),
        None,
    )
    owners = [p.owner for p in arm.parameters]
    assert [owners.count(name) for name in ("turn", "slide", "screw", "home")] == [4, 2, 4, 6]
    turns, slides = ["rad", "rad", "m", "m"], ["rad", "rad"]
    assert [p.unit for p in arm.parameters] == [
        *turns,
        *slides,
        *turns,
        "rad",
        "rad",
        "rad",
        "m",
        "m",
        "m",
    ]


def test_a_tilt_turns_the_axis_about_what_it_says_and_a_shift_moves_it():
    arm = ErrorModel(PUMA, ("screws",), ["joint3"])
    assert [p.what.split(" ")[0] for p in arm.parameters] == ["tilt", "tilt", "shift", "shift"]
    z, foot = PUMA.screws[2, :3], np.cross(PUMA.screws[2, :3], PUMA.screws[2, 3:])
    for k, parameter in enumerate(arm.parameters):
        axis = np.array(ast.literal_eval(parameter.what.split(" ", 2)[2]))
        found = arm.chain(1e-3 * np.eye(4)[k]).screws[2]
        turned = np.cross(axis, z) * 1e-3 if "tilt" in parameter.what else 0.0
        np.testing.assert_allclose(found[:3], z + turned, rtol=0, atol=1e-6)
        if "shift" in parameter.what:
            np.testing.assert_allclose(
                np.cross(found[:3], found[3:]), foot + 1e-3 * axis, rtol=0, atol=1e-9
            )


def test_offsets_and_gains_are_read_as_q_times_one_plus_g_plus_o():
    arm = ErrorModel(PUMA, ("offsets", "gains"), ["joint2", "joint5"])
    assert [p.name for p in arm.parameters] == [
        "joint2: offset", "joint5: offset", "joint2: gain", "joint5: gain",
    ]  # fmt: skip
    q = PUMA.random(0, 4)
    read = q * [1, 1.003, 1, 1, 1.004, 1] + [0, 0.01, 0, 0, 0.02, 0]
    found = arm.chain(np.array([0.01, 0.02, 0.003, 0.004]))
    np.testing.assert_allclose(found.fk(q), PUMA.fk(read), rtol=0, atol=1e-14)


def test_a_pitch_makes_the_joint_helical():
    arm = ErrorModel(PUMA, ("pitch",), ["joint1"])
    found = arm.chain(np.array([1e-3]))
    assert found.kinds == ("helical",) + ("revolute",) * 5
    q = np.array([0.7, 0, 0, 0, 0, 0])
    moved = found.fk(q)[:3, 3] - PUMA.fk(q)[:3, 3]
    np.testing.assert_allclose(moved, 0.7e-3 * PUMA.screws[0, :3], rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("kinds", "joints", "error", "words"),
    [
        (
            ("screws", "zeros"),
            None,
            InputError,
            r"expected some of 'screws', 'home', 'offsets', .*, got 'zeros'",
        ),
        ((), None, InputError, r"nothing to calibrate"),
        (
            ("screws", "gains"),
            [],
            InputError,
            r"'screws', 'gains' of these joints: nothing to calibrate",
        ),
        (("screws",), ["joint7"], UnknownName, r"no joint 'joint7'; did you mean"),
    ],
    ids=["a kind that is none", "none", "of no joint", "no such joint"],
)
def test_what_cannot_be_free_is_refused(kinds, joints, error, words):
    with pytest.raises(error, match=words):
        ErrorModel(PUMA, kinds, joints)


def test_offsets_are_in_rad_or_m_as_their_coordinates_are_and_gains_in_neither():
    turn, slide = pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])
    chain = pk.Chain.from_space(
        [turn, slide, turn], np.eye(4), joint_names=["turn", "slide", "last"]
    )
    found = ErrorModel(chain, ("offsets", "gains", "pitch"), None).parameters
    assert [(p.owner, p.what, p.unit) for p in found] == [
        ("turn", "pitch", "m/rad"), ("last", "pitch", "m/rad"),
        ("turn", "offset", "rad"), ("slide", "offset", "m"), ("last", "offset", "rad"),
        ("turn", "gain", "1"), ("slide", "gain", "1"), ("last", "gain", "1"),
    ]  # fmt: skip
    home = ErrorModel(chain, ("home",), None).parameters
    assert [p.name for p in home] == [
        f"home: {how} {axis}" for how in ("turn about", "shift along") for axis in "xyz"
    ]
    # A coordinate that moves several joints is one offset of its own.
    tied = pk.Chain.from_space(
        [turn, slide, turn], np.eye(4), coupling=[[1, 0], [0, 1], [0.5, 0]], q_names=["a", "b"]
    )
    assert [p.name for p in ErrorModel(tied, ("offsets",), None).parameters] == [
        "a: offset",
        "b: offset",
    ]
    assert [p.name for p in ErrorModel(tied, ("offsets",), [tied.joint_names[2]]).parameters] == [
        "a: offset"
    ]
    # also one that moves them in opposite directions
    opposed = pk.Chain.from_space([turn, turn], np.eye(4), coupling=[[1], [-1]], q_names=["a"])
    found = ErrorModel(opposed, ("offsets", "gains", "lag"), None).parameters
    assert [p.name for p in found] == ["a: offset", "a: gain", "a: lag"]


def test_offsets_leave_the_own_limits_of_joints_of_coupled_readings():
    nominal = PUMA.coupled("J3 = J2 + J3")
    assert np.isfinite(nominal.joint_limits).any()
    found = ErrorModel(nominal, ("offsets",), None).chain(np.full(6, 0.1))
    np.testing.assert_array_equal(found.joint_limits, nominal.joint_limits)


def test_offsets_and_gains_leave_the_limits_and_the_constants_of_the_nominal_arm():
    turn, slide = pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])
    nominal = pk.Chain.from_space(
        [turn, slide],
        pk.se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        limits=[(-1, 2), (0, 0.5)],
        offset=[0.3, 0.1],
        velocity_limits=[2.5, 0.1],
    )
    q = nominal.random(0, 3)
    for kinds, p in (
        (("offsets",), [0.2, -0.1]),
        (("gains",), [0.05, 0.1]),
        (("offsets", "gains"), [0.2, 0, 0.05, 0]),
    ):
        found = ErrorModel(nominal, kinds, None).chain(np.array(p))
        np.testing.assert_array_equal(found.limits, nominal.limits)
        np.testing.assert_array_equal(found.velocity_limits, nominal.velocity_limits)
        np.testing.assert_array_equal(found.offset, nominal.offset)
        np.testing.assert_allclose(
            found.fk(q), ErrorModel(nominal, kinds, None).poses(np.array(p), q), rtol=0, atol=1e-14
        )


@pytest.mark.parametrize("axis", np.eye(3))
def test_a_direction_is_named_without_the_sign_of_what_rounds_to_0(axis):
    for tilt in 1e-8 * np.random.default_rng(2).normal(size=(20, 3)):
        # beside the axis of the base, of which the link frames are made
        joints = [pk.screw.revolute(w, [0.3, 0, 0]) for w in (np.eye(3)[2], axis + tilt)]
        found = ErrorModel(pk.Chain.from_space(joints, np.eye(4)), ("screws",), None)
        assert [p.what for p in found.parameters if re.search(r"-0[,)]", p.what)] == []
