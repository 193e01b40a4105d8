"""Calibrations of Universal Robots: from DH tables and deltas, as screws, as files and as URDF."""

from __future__ import annotations

import math
import pickle
import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from benchmarks.calibrated_arm import UR10E
from poekin.errors import PoekinWarning
from poekin.formats import vendors
from poekin.formats.dh import Table
from poekin.formats.urdf import read_text as read_urdf
from poekin.formats.vendors import ur
from poekin.formats.vendors.yaml_io import make_text, read_text
from poekin.model.robot import Robot
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.formats import dh_product

NOMINAL = pk.dh.published("ur10e")
ZERO = np.zeros(6)
# The third calibration of ur_calibration/test/calibration_test.cpp: what UR10E has more than the
# nominal arm.
DELTAS = {
    "delta_d": [-0.000160188285741325043, 439.140974079900957, -446.027059806332147, 6.88618689642360149,
                -3.86588496858186748e-05, -0.00087908274257374186],
    "delta_a": [2.12234865571205891e-05, 0.632017132627700651, 0.00229833638891230319, -4.61409023720933908e-05,
                -6.39280053471801522e-05, 0],
    "delta_theta": [-2.41478068943590252e-07, 1.60233952386694556, -1.68607190752171299, 0.0837331147700118711,
                    -1.01260355871157781e-07, 3.91986209186123702e-08],
    "delta_alpha": [-0.000650246557584166496, 0.00139416666825590402, 0.00693818880325995126,
                    -0.000811641562390219562, 0.000411120504570705592, 0],
}  # fmt: skip
# A UR10's calibration.conf, published by its owner in the forum of Universal Robots, "Calibrated
# kinamatics info".
CONF = """[mounting]
delta_theta = [ -8.20642406610186392e-05, -0.103609197138685979, 0.673631891251821102, -0.57016974724960845, \
-4.59636351675856217e-05, 9.74999561134540574e-07]
delta_a = [ -0.000161187342296687116, 0.00304003843792177708, 0.0916468555721788314, -9.62964975953143595e-05, \
-2.97595340762196176e-05, 0]
delta_d = [ 0.000505390894843998906, 11.1984514757821039, -92.5270326908668181, 81.3282683520703529, \
-0.000212852818740727479, -0.000126145560998547346]
delta_alpha = [ -0.00032142399895862539, -0.00565024518540147101, -0.00378922621833689211, -0.00106533274011644252, \
0.000999586303470856308, 0]
joint_checksum = [ 0x6e0f7bf, 0xa32a713f, 0xf636a50, 0x9ec2338a, 0xa1afded8, 0xb29b2979]
calibration_status = 2 # 0 == notInitialized / 1 == notLinearised / 2 == Linearised
"""


def conf_arm(tmp_path) -> Table:
    """The UR10 of the forum."""
    path = tmp_path / "calibration.conf"
    path.write_text(CONF, encoding="utf-8")
    return ur.add_deltas(pk.dh.published("ur10"), **ur.read_deltas(path))


def moved(robot: Robot, other: Robot) -> dict[str, float]:
    """How far each link is from where it was, at zero [m]."""
    mine, theirs = robot.fk(ZERO), other.fk(ZERO)
    return {
        link: float(np.linalg.norm(mine[link][:3, 3] - theirs[link][:3, 3]))
        for link in mine
        if link in theirs
    }


def turned(robot: Robot, other: Robot) -> float:
    """By which angle the link that turns most is turned from how it was, at zero [rad]."""
    mine, theirs = robot.fk(ZERO), other.fk(ZERO)
    return max(
        float(np.linalg.norm(pk.so3.log(mine[link][:3, :3].T @ theirs[link][:3, :3])))
        for link in mine
    )


def nominal_robot(table: Table = NOMINAL) -> Robot:
    """The nominal arm with the links of ur_description and the table's limits."""
    plain = ur.from_dh(table, nominal=table).to_robot()
    joints = [
        pk.Joint(j.name, j.kind, j.parent, j.child, j.origin, j.axis, (-2 * math.pi, 2 * math.pi))
        for j in plain.joints
    ]
    return Robot("nominal", plain.links, joints)


def worst(chain: pk.Chain, table: Table, seed: int, samples: int = 20) -> float:
    """The largest error of a chain's pose against the table's product in 50 digits, lengths ÷
    reach.
    """
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (samples, 6))
    errors = [np.abs(T - dh_product.pose(table, x)) for T, x in zip(chain.fk(q), q, strict=True)]
    return float((np.max(errors, axis=0)[:3] / [1, 1, 1, chain.reach]).max())


small = st.floats(-2e-3, 2e-3)


@st.composite
def arms(draw) -> Table:
    """A nominal arm with small deltas, as a calibration without near-parallel axes put far away
    would have them.
    """
    six = st.lists(small, min_size=6, max_size=6)
    table = pk.dh.published(draw(st.sampled_from(["ur3", "ur5", "ur10e", "ur16e"])))
    a, alpha = ([*draw(six)[:5], 0.0] for _ in range(2))
    return ur.add_deltas(
        table, delta_theta=draw(six), delta_d=draw(six), delta_a=a, delta_alpha=alpha
    )


@settings(max_examples=25)
@given(table=arms(), seed=st.integers(0, 2**32))
def test_a_calibration_of_small_deltas_has_the_kinematics_of_its_table(table, seed):
    calibration = ur.from_dh(table, nominal=pk.dh.published(table.name))
    assert worst(calibration.to_chain(), table, seed, 3) <= 1e-13


@settings(max_examples=25)
@given(table=arms())
def test_links_of_small_deltas_move_by_millimetres_and_milliradians(table):
    nominal = pk.dh.published(table.name)
    calibration = ur.from_dh(table, nominal=nominal).to_robot()
    plain = ur.from_dh(nominal, nominal=nominal).to_robot()
    # Twenty-two numbers of at most 2 mm and 2 mrad over an arm of at most 1.6 m: five angles lever
    # the wrist.
    assert max(moved(plain, calibration).values()) <= 0.04
    assert turned(plain, calibration) <= 0.025


@settings(max_examples=50)
@given(table=arms(), mark=st.text(max_size=20), rpy=st.sampled_from(["fixed", "moving"]))
def test_a_calibration_comes_back_from_its_file(table, mark, rpy):
    calibration = ur.from_dh(table, nominal=pk.dh.published(table.name), hash=mark)
    again = read_text(make_text(calibration, rpy=rpy))
    assert again.hash == mark
    assert np.array_equal(again.poses[:, :3, 3], calibration.poses[:, :3, 3])
    assert (
        np.abs(again.poses - calibration.poses).max() <= 1e-15
    )  # the bound of rpy.angles and pose, twice


def test_the_ur10e_s_calibration_is_in_the_driver_s_form_what_its_table_is():
    calibration = ur.from_dh(UR10E, nominal=NOMINAL)
    assert np.abs(UR10E.d).max() > 440
    assert np.abs(calibration.poses).max() <= 1.2
    chain = calibration.to_chain()
    assert np.abs(chain.screws).max() <= 1.2
    assert np.abs(chain.home).max() <= 1.2
    # The table's own rounding is 100 u n (R + 446 m) at worst, 3e-11; this arm comes out better
    # than that.
    assert worst(chain, UR10E, 0) <= 1e-13


def test_the_ur10e_s_links_stay_within_millimetres_although_its_table_puts_them_440_m_away():
    far = pk.dh.to_robot(UR10E).fk(ZERO)
    assert max(np.linalg.norm(T[:3, 3]) for T in far.values()) > 400
    nominal, calibrated = nominal_robot(), ur.from_dh(UR10E, nominal=NOMINAL).to_robot()
    distances = moved(nominal, calibrated)
    assert max(distances.values()) == pytest.approx(2.007e-3, abs=1e-6)
    assert max(distances, key=lambda link: distances[link]) in ("wrist_3_link", "tool0")
    assert (
        max(distances[f"{link}_link"] for link in ("shoulder", "upper_arm", "forearm")) <= 0.25e-3
    )
    assert math.degrees(turned(nominal, calibrated)) == pytest.approx(0.36, abs=0.005)


def test_pinocchio_sees_the_table_in_the_urdf_and_the_links_where_the_nominal_arm_has_them():
    nominal = nominal_robot()
    robot = pk.calibration.apply(nominal, ur.from_dh(UR10E, nominal=NOMINAL))
    text = pk.to_urdf(robot)
    oracle = PinocchioOracle(text)
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (20, 6))
    poses = oracle.poses(dict(zip(ur.JOINTS, q.T, strict=True)), "tool0", "base")
    reach = robot.chain().reach
    for T, x in zip(poses, q, strict=True):
        off = np.abs(T - dh_product.pose(UR10E, x))[:3] / [1, 1, 1, reach]
        assert off.max() <= 1e-13
    there, here = oracle.link_poses({}), nominal.fk(ZERO)
    assert (
        max(np.linalg.norm(there[link][0][:3, 3] - here[link][:3, 3]) for link in nominal.links)
        <= 2.1e-3
    )
    back = read_urdf(text)
    assert back.q_names == ur.JOINTS
    np.testing.assert_array_equal(back.limits, nominal.limits)


def test_the_base_of_a_table_moves_the_first_frame_alone():
    base = pk.se3.exp([0.25, 0.5, 0, 0.5, 0, 1])
    lifted = Table(NOMINAL.convention, NOMINAL.rows, base=base)
    first, *others = ur.from_dh(NOMINAL, nominal=NOMINAL).poses
    found = ur.from_dh(lifted, nominal=lifted).poses
    np.testing.assert_allclose(found, [base @ first, *others], rtol=0, atol=1e-14)


def test_deltas_on_the_nominal_table_are_the_arm_s_own():
    table = ur.add_deltas(NOMINAL, **DELTAS)
    for column in ("theta", "d", "a"):
        np.testing.assert_allclose(
            getattr(table, column), getattr(UR10E, column), rtol=1e-13, atol=1e-15
        )
    # The controller's quarter turn has ten digits.
    np.testing.assert_allclose(table.alpha, UR10E.alpha, rtol=0, atol=2.1e-10)
    assert table.names == NOMINAL.names
    assert ur.add_deltas(NOMINAL) == NOMINAL


def test_deltas_leave_base_tool_name_and_coupling_of_a_table_as_they_are():
    base, tool = pk.se3.exp([0, 0, 1, 0.1, 0.2, 0.3]), pk.se3.exp([0.5, 0, 0, 0, 0, 0.1])
    placed = Table(
        "standard", NOMINAL.rows, base=base, tool=tool, name="left", coupling="J3 = J2 + J3"
    )
    table = ur.add_deltas(placed, delta_a=[1e-4, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(table.base, placed.base)
    np.testing.assert_array_equal(table.tool, placed.tool)
    assert (table.name, table.coupling) == ("left", placed.coupling)


def test_a_controller_s_file_is_read_and_moves_a_ur10_by_three_millimetres(tmp_path):
    table, nominal = conf_arm(tmp_path), pk.dh.published("ur10")
    assert table.d[1] == 11.1984514757821039
    robot = ur.from_dh(table, nominal=nominal).to_robot()
    assert max(moved(nominal_robot(nominal), robot).values()) == pytest.approx(3.245e-3, abs=1e-6)
    with pytest.warns(
        PoekinWarning,
        match=(
            r"^table 'ur10' moves 'wrist_3_link' by 373 mm from where the nominal 'ur5' has it: the "
            r"calibration of another arm\?$"
        ),
    ):
        ur.from_dh(table, nominal=pk.dh.published("ur5"))


@pytest.mark.parametrize("by, said", [(0.019, False), (0.021, True), (0.1, True)])
def test_a_table_that_moves_a_link_by_more_than_two_centimetres_is_said(by, said):
    table = ur.add_deltas(NOMINAL, delta_d=[by, 0, 0, 0, 0, 0])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ur.from_dh(table, nominal=NOMINAL)
    messages = [str(w.message) for w in caught]
    assert len(messages) == said
    what = rf"table 'ur10e' moves '\w+' by {by * 1e3:g} mm from where the nominal 'ur10e' has it"
    assert all(re.match(what, message) for message in messages)


@pytest.mark.parametrize("names, first", [
    (("base", "base_link_inertia"), 0), (("base_link_inertia", "base"), 1), (("pedestal", "base_link_inertia"), 1),
])  # fmt: skip
def test_the_controller_s_base_is_called_base_else_base_link_inertia(names, first):
    plain = ur.from_dh(NOMINAL, nominal=NOMINAL).to_robot()
    poses = [np.eye(4), pk.se3.exp([0, 0, 0.3, 0.1, 0.2, 0.3])]
    arm = [pk.Joint(j.name, j.kind, {"base": names[0]}.get(j.parent, j.parent), j.child, j.origin, j.axis)
           for j in plain.joints]  # fmt: skip
    stands = [
        pk.Joint(f"world-{name}", "fixed", "world", name, T)
        for name, T in zip(names, poses, strict=True)
    ]
    robot = Robot("arm", ["world", *names, *plain.links[1:]], [*stands, *arm])
    calibration = ur.from_dh(UR10E, nominal=NOMINAL)
    pose = (
        pk.calibration.apply(robot, calibration, force=True).chain(names[first], "tool0").fk(ZERO)
    )
    assert np.abs(pose - calibration.to_chain().fk(ZERO)).max() <= 1e-14


def test_a_calibration_of_ur_description_s_urdf_keeps_its_tree_and_its_tool():
    plain = ur.from_dh(NOMINAL, nominal=NOMINAL).to_robot()
    half = pk.se3.exp([0, 0, math.pi, 0, 0, 0])
    camera = pk.se3.exp([0.1, 0.2, 0.3, 0.01, 0.02, 0.03])
    renamed = {"base": "base_link_inertia"}
    arm = [
        pk.Joint(
            j.name, j.kind, renamed.get(j.parent, j.parent), j.child, j.origin, j.axis, (-3, 3)
        )
        for j in plain.joints[:6]
    ]
    links = [
        "base_link",
        "base",
        "base_link_inertia",
        *plain.links[1:-1],
        "flange",
        "tool0",
        "camera",
    ]
    quarter = pk.se3.exp([0, math.pi / 2, 0, 0, 0, 0])
    joints = [
        pk.Joint("base_link-base_link_inertia", "fixed", "base_link", "base_link_inertia", half),
        pk.Joint("base_link-base", "fixed", "base_link", "base", half),
        *arm,
        pk.Joint("wrist_3-flange", "fixed", "wrist_3_link", "flange", quarter),
        pk.Joint("flange-tool0", "fixed", "flange", "tool0", pk.se3.inverse(quarter)),
        pk.Joint("bracket", "fixed", "wrist_1_link", "camera", camera),
    ]
    description = Robot("ur10e", links, joints)
    calibration = ur.from_dh(UR10E, nominal=NOMINAL)
    robot = pk.calibration.apply(description, calibration)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (50, 6))
    assert np.abs(robot.chain("base", "tool0").fk(q) - calibration.to_chain().fk(q)).max() <= 1e-14
    for joint in ("base_link-base_link_inertia", "base_link-base", "flange-tool0", "bracket"):
        assert robot.joint(joint) == description.joint(joint)
    assert robot.q_names == description.q_names
    np.testing.assert_array_equal(robot.limits, description.limits)
    assert max(moved(description, robot).values()) <= 2.1e-3


def test_the_built_in_ur5e_has_the_frames_of_a_calibration():
    table = pk.dh.published("ur5e")
    robot = ur.from_dh(table, nominal=table).to_robot()
    mine, built_in = robot.fk(ZERO), pk.load("ur5e").fk(ZERO)
    for link in ("base", "wrist_3_link", "tool0"):
        assert np.abs(mine[link][:3, :3] - built_in[link][:3, :3]).max() <= 1e-15
    assert np.abs(mine["tool0"] - built_in["tool0"]).max() <= 1e-15
    applied = pk.calibration.apply(pk.load("ur5e"), ur.from_dh(table, nominal=table))
    assert max(moved(pk.load("ur5e"), applied).values()) <= 1e-15


def test_calibrations_are_values():
    calibration = ur.from_dh(UR10E, nominal=NOMINAL, hash="calib_1")
    assert pickle.loads(pickle.dumps(calibration)) == calibration
    assert hash(vendors.FactoryCalibration(calibration.poses, "calib_1")) == hash(calibration)
    assert vendors.FactoryCalibration(calibration.poses) != calibration
    assert calibration != 1
    with pytest.raises(ValueError, match="read-only"):
        calibration.poses[0, 0, 0] = 2
