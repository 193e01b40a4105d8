"""`from_fk` gives the arm that a controller calculates with, and a bound that holds."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError, escape_unprintable
from poekin.formats.rpy import pose
from poekin.groups import rpy, se3, so3
from poekin.solve.calibration import Poses, from_fk, simulated
from poekin.solve.calibration.exact import other_readings

README = pk.ur.add_deltas(
    pk.dh.published("ur10e"),
    delta_theta=[-2.41e-07, 1.60233952, -1.68607191, 0.0837331148, -1.01e-07, 3.9e-08],
    delta_d=[-0.000160188, 439.140974080, -446.027059806, 6.886186896, -3.87e-05, -0.000879083],
    delta_a=[2.12e-05, 0.632017133, 0.002298336, -4.61e-05, -6.39e-05, 0],
    delta_alpha=[-0.000650247, 0.001394167, 0.006938188, -0.000811642, 0.000411121, 0],
)
UR10E = pk.dh.to_chain(pk.dh.published("ur10e"))
IIWA = pk.load("iiwa14").chain()
TRUE_UR10E = pk.ur.from_dh(README, nominal=pk.dh.published("ur10e")).to_chain()
ARMS = {
    "ur10e": (UR10E, TRUE_UR10E),
    "iiwa14": (IIWA, simulated(IIWA, 1, seed=2).truth),
}


def in_degrees(q: np.ndarray, places: int) -> np.ndarray:
    return np.radians(np.degrees(q).round(places))


def printed(T: np.ndarray, places: int | None, rotations: int | None) -> np.ndarray:
    """Poses as a controller prints them: mm, and roll, pitch, yaw in degrees, with these decimals."""
    T = T.copy()
    if places is not None:
        T[:, :3, 3] = (1e3 * T[:, :3, 3]).round(places) / 1e3
    if rotations is not None:
        turns = in_degrees(rpy.angles(T[:, :3, :3]), rotations)
        T[:, :3, :3] = [pose((0, 0, 0), row)[:3, :3] for row in turns]
    return T


def apart(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    turns = so3.log(a[..., :3, :3] @ np.swapaxes(b[..., :3, :3], -1, -2))
    return np.linalg.norm(turns, axis=-1), np.linalg.norm((a - b)[..., :3, 3], axis=-1)


@pytest.mark.parametrize("name", ARMS)
def test_forty_exact_pairs_give_the_screws_to_1e_9(name):
    nominal, true = ARMS[name]
    q = nominal.random(3, 40)
    found = from_fk(nominal, q, true.fk(q))
    np.testing.assert_allclose(found.chain.screws, true.screws, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.chain.home, true.home, rtol=0, atol=1e-12)
    assert found.screw_bounds.max() < 1e-9
    assert found.worst.position < 1e-9
    assert found.digits == ""
    assert found.remarks == ()


@pytest.mark.parametrize("name", ARMS)
@settings(max_examples=8)
@given(
    seed=st.integers(0, 2**32 - 1),
    places=st.none() | st.integers(0, 6),
    rotations=st.none() | st.integers(1, 6),
    readings=st.none() | st.integers(1, 6),
    count=st.integers(8, 60),
)
def test_screws_and_poses_are_within_the_reported_bounds(
    name, seed, places, rotations, readings, count
):
    nominal, _ = ARMS[name]
    true = simulated(nominal, 1, seed=seed % 1000).truth
    q = nominal.random(seed, count)
    T = printed(true.fk(q), places, rotations)
    if readings is not None:
        q = in_degrees(q, readings)
    found = from_fk(nominal, q, T)
    assert (np.abs(found.chain.screws - true.screws) <= found.screw_bounds).all()
    fresh = nominal.random(seed + 1, 200)
    turned, moved = apart(found.chain.fk(fresh), true.fk(fresh))
    bound = found.pose_bound(fresh)
    assert (turned <= bound.rotation).all()
    assert (moved <= bound.position).all()


@pytest.mark.parametrize("places", [0, 1, 3])
@pytest.mark.parametrize("name", ARMS)
def test_the_bound_holds_where_the_nominal_arm_is_the_true_one(name, places):
    """Along its own direction an axis that was not tilted moves in second order alone."""
    nominal, _ = ARMS[name]
    q = nominal.random(8, 40)
    found = from_fk(nominal, q, printed(nominal.fk(q), places, places))
    assert (np.abs(found.chain.screws - nominal.screws) <= found.screw_bounds).all()


@pytest.mark.parametrize("name", ARMS)
def test_three_decimals_of_millimetres_and_degrees_leave_a_tenth_of_a_millimetre(name):
    nominal, true = ARMS[name]
    q = nominal.random(5, 40)
    found = from_fk(nominal, in_degrees(q, 3), printed(true.fk(q), 3, 3))
    assert found.digits == (
        "joint angles to 0.001°, positions to 0.001 mm, rotations (roll, pitch, yaw) to 0.001°"
    )
    assert found.errors.joints == pytest.approx(np.full(nominal.dof, np.radians(5e-4)))
    assert found.errors.position == pytest.approx(5e-7)
    assert found.errors.rotation == pytest.approx(6**0.5 * np.radians(5e-4))
    fresh = nominal.random(6, 1000)
    turned, moved = apart(found.chain.fk(fresh), true.fk(fresh))
    assert moved.max() <= found.worst.position < 2e-4
    assert turned.max() <= found.worst.rotation < 3e-4
    # the worst signs of 240 numbers are some ten times as bad as chance
    assert 3 * found.typical.position < found.worst.position < 60 * found.typical.position
    assert str(found).splitlines()[-1] == f"the digits of the pairs are the limit: {found.digits}"


def test_joint_readings_of_whole_degrees_are_exact_where_the_poses_say_so():
    q = in_degrees(UR10E.random(1, 40), 0)
    found = from_fk(UR10E, q, printed(TRUE_UR10E.fk(q), 3, None))
    assert found.digits == "positions to 0.001 mm"
    assert found.errors.joints.max() < np.radians(1e-4)
    assert (np.abs(found.chain.screws - TRUE_UR10E.screws) <= found.screw_bounds).all()


def test_single_precision_is_bounded_by_the_residuals():
    q = UR10E.random(1, 40)
    T = TRUE_UR10E.fk(q).astype(np.float32).astype(float)
    found = from_fk(UR10E, q, T)
    assert found.digits == ""
    assert (np.abs(found.chain.screws - TRUE_UR10E.screws) <= found.screw_bounds).all()
    assert 1e-8 < found.worst.position < 1e-6


@pytest.mark.parametrize("turn", [0.0, np.pi])
def test_a_controller_may_have_its_base_and_flange_elsewhere(turn):
    base = se3.exp([0, 0, turn, 0.02, 0.0, 0.33])
    tool = se3.exp([0.0, np.pi / 2, 0.0, 0.0, 0.0, 0.1])
    true = TRUE_UR10E.rebased(base).retooled(tool)
    q = UR10E.random(2, 40)
    found = from_fk(UR10E, q, true.fk(q))
    np.testing.assert_allclose(found.chain.screws, true.screws, rtol=0, atol=1e-12)
    assert len(found.remarks) == 1
    assert found.remarks[0].startswith(
        "the controller's frames are others: its base is moved by 0.3"
    )
    assert str(found).endswith(found.remarks[0])


def test_sliding_joints_and_lengths_are_found_too():
    nominal = pk.load("stanford").chain()
    true = simulated(nominal, 1, seed=5).truth
    q = nominal.random(1, 40)
    q[:, 2] = (1e3 * q[:, 2]).round(2) / 1e3
    found = from_fk(nominal, q, true.fk(q))
    np.testing.assert_allclose(found.chain.screws, true.screws, rtol=0, atol=1e-12)


def test_rounded_lengths_of_joints_are_said_and_bounded():
    nominal = pk.load("stanford").chain()
    true = simulated(nominal, 1, seed=5).truth
    q = nominal.random(1, 40)
    read = q.copy()
    read[:, 2] = (1e3 * q[:, 2]).round(1) / 1e3
    found = from_fk(nominal, read, true.fk(q))
    assert found.digits == "joint lengths to 0.1 mm"
    np.testing.assert_allclose(found.errors.joints, [0, 0, 5e-5, 0, 0, 0], rtol=1e-12, atol=0)
    assert (np.abs(found.chain.screws - true.screws) <= found.screw_bounds).all()


@pytest.mark.parametrize("places", [None, 3])
def test_an_arm_that_does_not_turn_has_rotations_of_no_digits(places):
    axes = [pk.screw.prismatic(axis) for axis in np.eye(3)]
    gantry = pk.Chain.from_space(axes, se3.pose(np.eye(3), [0.1, 0.2, 0.3]))
    true = simulated(gantry, 1, seed=3).truth.replace(home=gantry.home)
    q = gantry.random(1, 30)
    found = from_fk(gantry, q, printed(true.fk(q), places, None))
    assert found.digits == ("" if places is None else "positions to 0.001 mm")
    assert (np.abs(found.chain.screws - true.screws) <= found.screw_bounds).all()
    assert found.worst.rotation < 1e-9
    assert found.worst.position < (1e-11 if places is None else 1e-5)


def test_the_result_is_data_and_a_calibration():
    q = UR10E.random(2, 12)
    found = from_fk(UR10E, q, TRUE_UR10E.fk(q))
    assert found.chain is found.calibration.chain
    document = found.to_dict()
    assert list(document) == ["digits", "errors", "screw_bounds", "typical", "worst", "remarks"]
    assert found.remarks == ("12 pairs: 20 and more say better whether the arm is a rigid one",)
    one, several = found.pose_bound(q[0]), found.pose_bound(q.reshape(3, 4, 6))
    assert (one.rotation.shape, several.position.shape) == ((), (3, 4))
    assert several.position[0, 0] == pytest.approx(one.position, rel=1e-9)
    first, second, third, _ = str(found).splitlines()
    assert first.startswith("12 exact pairs, residuals of at most ")
    assert second.startswith("screws: directions and moments known to ")
    assert re.fullmatch(
        r"poses: known to \S+ µrad and \S+ µm rms, \S+ µrad and \S+ µm at worst", third
    )


Q = UR10E.random(7, 40)
STILL = np.where(np.arange(6) == 2, 0.5, Q)
TWICE = np.concatenate(
    [TRUE_UR10E.fk(Q[:20]), TRUE_UR10E.retooled(se3.exp([0] * 5 + [0.1])).fk(Q[20:])]
)


def follows(joint: int, reading: int, ratio: float) -> np.ndarray:
    """Poses of joints one of which follows another one's reading."""
    x = Q.copy()
    x[:, joint] += ratio * Q[:, reading]
    return TRUE_UR10E.fk(x)


def wrong_row() -> np.ndarray:
    T = TRUE_UR10E.fk(Q).copy()
    T[7] = T[8]
    return T


def measured() -> np.ndarray:
    poses = simulated(UR10E, 40, q=Q, noise=(1e-4, 1e-4)).measurements
    assert isinstance(poses, Poses)
    return np.asarray(poses.T)


def in_millimetres() -> np.ndarray:
    T = TRUE_UR10E.fk(Q).copy()
    T[:, :3, 3] *= 1e3
    return T


ENDS = {
    "few": (
        Q[:5],
        TRUE_UR10E.fk(Q[:5]),
        "5 pairs for 30 parameters: at least 6 are needed, and 20 to 60 say whether the arm is a rigid one",
    ),
    "still": (
        STILL,
        TRUE_UR10E.fk(STILL),
        "(elbow_joint is the same in all readings). Ask for poses with these joints in more positions",
    ),
    "degrees": (
        np.degrees(Q),
        TRUE_UR10E.fk(Q),
        "m where the joint angles look like degrees: give radians (numpy.deg2rad)",
    ),
    "millimetres": (
        Q,
        in_millimetres(),
        "m where the lengths look like millimetres: give metres (divide by 1000)",
    ),
    "plus": (
        Q,
        follows(2, 1, 1.0),
        "; with the readings coupled, 'elbow_joint = elbow_joint + shoulder_lift_joint', "
        "the nominal arm is off by D mm only (median)",
    ),
    "minus": (
        Q,
        follows(2, 1, -1.0),
        "; with the readings coupled, 'elbow_joint = elbow_joint - shoulder_lift_joint', "
        "the nominal arm is off by D mm only (median)",
    ),
    "sign": (
        Q * [1, 1, 1, -1, 1, 1],
        TRUE_UR10E.fk(Q),
        "; with wrist_1_joint reversed, the nominal arm is off by D mm only (median)",
    ),
    "order": (
        Q[:, [0, 1, 2, 4, 3, 5]],
        TRUE_UR10E.fk(Q),
        "; with wrist_1_joint and wrist_2_joint exchanged, the nominal arm is off by D mm only (median)",
    ),
    "wrist": (
        Q,
        follows(5, 4, -0.0125),
        "; most of it is as if wrist_3_joint = wrist_3_joint - 0.0125 wrist_2_joint",
    ),
    "gain": (
        Q,
        follows(1, 1, 1e-5),
        "; most of it is as if shoulder_lift_joint went 1.00001 times its reading",
    ),
    "row": (
        Q,
        wrong_row(),
        "; pairs 7 stand out (rows of q, from 0), the others fit better without them",
    ),
    "two tools": (
        Q,
        TWICE,
        "with the joints at rest and one tool, and are its joint readings not coupled?",
    ),
    "measured": (
        Q,
        measured(),
        "are its joint readings not coupled?",
    ),
}


@pytest.mark.parametrize("case", ENDS)
def test_pairs_of_no_such_arm_are_refused_with_what_would_explain_them(case):
    q, T, end = ENDS[case]
    with pytest.raises(InputError) as caught:
        from_fk(UR10E, q, T)
    message = re.sub(r"off by \S+ mm only", "off by D mm only", str(caught.value))
    assert message.endswith(end)


def test_parameters_that_are_seen_are_counted_of_all_that_there_are():
    with pytest.raises(InputError, match=r"^these pairs identify (\d+) of 30 param") as caught:
        from_fk(UR10E, *ENDS["still"][:2])
    assert int(str(caught.value).split()[3]) < 30


def test_a_quarter_of_the_pairs_may_stand_out():
    def said(odd: int, count: int = 8) -> str:
        errors = np.where(np.arange(count) < odd, 1.0, 1e-6)
        after = SimpleNamespace(length=errors, angle=errors)
        found: Any = SimpleNamespace(after=after, nominal=UR10E)
        return other_readings.odd_pairs(found, count)

    assert said(2) == (
        "; pairs 0, 1 stand out (rows of q, from 0), the others fit better without them"
    )
    assert said(0) == said(3) == ""


def test_a_long_name_is_cut_in_what_would_explain_the_pairs():
    name = "w" * 50
    q_names = [*UR10E.q_names[:5], name]
    with pytest.raises(InputError) as caught:
        from_fk(UR10E.replace(q_names=q_names), *ENDS["wrist"][:2])
    cut = escape_unprintable(name, 40)
    assert len(cut) == 40
    assert str(caught.value).endswith(f" as if {cut} = {cut} - 0.0125 wrist_2_joint")


@pytest.mark.parametrize(
    ("q", "T", "kind"),
    [
        (Q[:, :5], TRUE_UR10E.fk(Q), ShapeError),
        (Q, TRUE_UR10E.fk(Q)[:39], ShapeError),
        (Q, TRUE_UR10E.fk(Q) + 1, PoseError),
    ],
)
def test_what_is_no_pair_of_readings_and_poses_is_refused(q, T, kind):
    with pytest.raises(kind):
        from_fk(UR10E, q, T)


def test_a_chain_without_joints_has_no_pairs():
    nothing = pk.Chain.from_space([], np.eye(4))
    with pytest.raises(InputError) as caught:
        from_fk(nothing, np.empty((20, 0)), np.tile(np.eye(4), (20, 1, 1)))
    assert str(caught.value) == (
        "chain: expected joints that move between 'base' and 'tool', there are none"
    )


def test_planted_digits_beyond_those_that_are_there_break_the_bound():
    """A bound that took the pairs for more exact than they are would not hold."""
    q = UR10E.random(5, 40)
    found = from_fk(UR10E, in_degrees(q, 3), printed(TRUE_UR10E.fk(q), 3, 3))
    error = np.abs(found.chain.screws - TRUE_UR10E.screws)
    assert not (error <= found.screw_bounds / 100).all()


def test_a_pair_more_is_needed_than_the_parameters_have_sixes():
    q = IIWA.random(0, 5)
    words = "5 pairs for 34 parameters: at least 6 are needed, and "
    with pytest.raises(InputError, match=words):
        from_fk(IIWA, q, IIWA.fk(q))
