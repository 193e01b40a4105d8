"""Calibrations on robots: the same poses as the vendor's own URDF, and a word on any other arm."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoekinError, UnknownName
from poekin.formats.chain_toml import CALIBRATED, FORMAT, VERSION, to_data
from poekin.formats.urdf import read_text as read_urdf
from poekin.formats.vendors.known_arms import known_arms
from poekin.formats.vendors.yaml_io import make_text, read_text
from poekin.model.robot import Robot
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.formats.vendors.origins import (
    RIZON_4S,
    RIZON_AXES,
    RIZON_FLANGE,
    UFACTORY,
    UR5E,
    UR_LINKS,
    urdf,
    yaml,
)
from tests.messages import says

# The nominal Rizon 4s, flexiv_description, config/Rizon4s/default_kinematics.yaml.
PI, HALF = 3.141592654, 1.570796327
RIZON_NOMINAL = [
    (0, 0, 0.155, 0, 0, -PI),
    (0, 0.03, 0.21, 0, 0, 0),
    (0, 0.035, 0.205, 0, 0, 0),
    (-0.02, -0.03, 0.19, 0, 0, -PI),
    (-0.02, 0.025, 0.195, 0, 0, -PI),
    (0, 0.03, 0.19, 0, 0, 0),
    (-0.055, 0.07, 0.11, 0, -HALF, 0),
]
RIZON_YAML = yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE)
XARM: dict[str, Any] = {"base": "link_base", "tip": "link_eef"}
FLEXIV: dict[str, Any] = {
    "base": "base_link",
    "tip": "flange",
    "axes": RIZON_AXES,
    "flange": RIZON_FLANGE,
}
MM = st.floats(-1e-3, 1e-3)
HOME = 24 * 2.0**-53 * 9 * 2 * 1.5
"""24 u n of both reaches, as `relinked` says at zero, of 9 joints and 1.5 m: 7e-14."""


def nominal(name: str, prefix: str = "") -> Robot:
    return read_urdf(urdf(UFACTORY[name], prefix=prefix, **XARM))


def worst(robot: Robot, text: str, base: str, tip: str, seed: int = 0) -> float:
    """The largest difference of a robot's poses, of its URDF as Pinocchio reads it, from those of
    the URDF in a text.
    """
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (20, robot.dof))
    named = dict(zip(robot.q_names, q.T, strict=True))
    mine = PinocchioOracle(pk.to_urdf(robot)).poses(named, tip, base)
    return float(np.abs(mine - PinocchioOracle(text).poses(named, tip, base)).max())


@settings(max_examples=25)
@given(data=st.data(), name=st.sampled_from(sorted(UFACTORY)), seed=st.integers(0, 2**32))
def test_a_file_of_ufactory_makes_the_arm_that_its_own_urdf_would_be(data, name, seed):
    six = st.lists(MM, min_size=6, max_size=6)
    rows = [tuple(np.add(row, data.draw(six)).tolist()) for row in UFACTORY[name]]
    robot = pk.calibration.apply(nominal(name), read_text(yaml(rows)))
    # 24 u n (1 + sum |x|) of both reaches, as `relinked` says, for 7 joints of up to pi
    bound = HOME * (1 + 7 * np.pi)
    assert worst(robot, urdf(rows, **XARM), "link_base", "link_eef", seed) <= bound


def test_a_calibrated_rizon_4s_is_made_of_the_nominal_one_and_its_file():
    robot = read_urdf(urdf(RIZON_NOMINAL, **FLEXIV))
    calibrated = pk.calibration.apply(robot, read_text(RIZON_YAML))
    assert worst(calibrated, urdf(RIZON_4S, **FLEXIV), "base_link", "flange") <= 1e-14
    assert calibrated.joint("stand") == robot.joint("stand")
    np.testing.assert_array_equal(calibrated.limits, robot.limits)


def test_a_file_without_the_flange_leaves_the_robot_s_own():
    robot = read_urdf(urdf(RIZON_NOMINAL, **FLEXIV))
    calibrated = pk.calibration.apply(robot, read_text(yaml(RIZON_4S, axes=RIZON_AXES)))
    text = urdf(RIZON_4S, **FLEXIV)
    assert worst(calibrated, text, "base_link", "link7") <= 1e-14
    assert calibrated.joint("joint8") == robot.joint("joint8")


@pytest.mark.parametrize("prefix", ["left_", "left_Rizon4s-123_"])
def test_links_are_found_behind_a_prefix(prefix):
    rows = [tuple(np.add(row, 1e-3).tolist()) for row in UFACTORY["xarm6"]]
    calibration = read_text(yaml(rows))
    robot = pk.calibration.apply(nominal("xarm6", prefix), calibration)
    chain = robot.chain(f"{prefix}link_base", f"{prefix}link_eef")
    assert np.abs(chain.home - calibration.to_chain().home).max() <= HOME


def two_arms() -> Robot:
    """Two xarm6 side by side on one stand, as left_ and right_."""
    left, right = (nominal("xarm6", prefix) for prefix in ("left_", "right_"))
    joints = [*left.joints, *(j for j in right.joints if j.name != "stand")]
    side = pk.se3.exp([0, 0, 0.1, 0.2, 0, 0])
    joints.append(pk.Joint("stand2", "fixed", "world", "right_link_base", side))
    return Robot("pair", [*left.links, *right.links[1:]], joints)


def test_of_two_arms_the_one_whose_tip_is_named_is_calibrated():
    rows = [tuple(np.add(row, 1e-3).tolist()) for row in UFACTORY["xarm6"]]
    calibration = read_text(yaml(rows))
    pair = two_arms()
    robot = pk.calibration.apply(pair, calibration, tip="right_link_eef")
    chain = robot.chain("right_link_base", "right_link_eef")
    assert np.abs(chain.home - calibration.to_chain().home).max() <= HOME
    assert robot.joint("left_joint3") == pair.joint("left_joint3")
    with pytest.raises(
        InputError, match=r"tip must be given, .*: 'left_link_eef', 'right_link_eef'$"
    ):
        pk.calibration.apply(pair, calibration)


def test_a_link_of_the_very_name_comes_before_those_behind_a_prefix():
    rows = [tuple(np.add(row, 1e-3).tolist()) for row in UFACTORY["xarm6"]]
    plain, left = nominal("xarm6"), nominal("xarm6", "left_")
    joints = [*plain.joints, *(j for j in left.joints if j.name != "stand")]
    side = pk.Joint("stand2", "fixed", "world", "left_link_base")
    pair = Robot("pair", [*plain.links, *left.links[1:]], [*joints, side])
    robot = pk.calibration.apply(pair, read_text(yaml(rows)))
    assert robot.joint("left_joint3") == pair.joint("left_joint3")
    assert robot.joint("joint3") != pair.joint("joint3")


def test_a_real_ur5e_goes_on_the_built_in_one_from_its_file(tmp_path):
    path = tmp_path / "ur5e.yaml"
    path.write_text(yaml(UR5E, names=UR_LINKS), encoding="utf-8")
    robot = pk.calibration.apply(pk.load("ur5e"), str(path))
    chain = pk.vendors.read(path).to_chain()
    assert np.abs(robot.chain().home - chain.home).max() <= HOME
    assert pk.calibration.apply(pk.load("ur5e"), path).joints == robot.joints


def ur10e() -> Any:
    table = pk.dh.published("ur10e")
    return pk.ur.from_dh(table, nominal=table)


def test_a_ur10e_s_calibration_on_a_ur5e_is_refused_unless_forced():
    robot = pk.load("ur5e")
    with pytest.raises(InputError) as caught:
        pk.calibration.apply(robot, ur10e())
    assert says(
        caught.value,
        "the calibration is not of the arm 'ur5e', from 'base' to 'tool0': the axis of 'elbow_joint'"
        " is 189 mm and 0° off, the tip 'tool0' is 372 mm and 0° off, and one of the same arm moves"
        " them by less than 20 mm and 3°; it fits 'ur10e', within 0 mm and 0°; force=True (--force) puts it on"
        " all the same",
    )
    forced = pk.calibration.apply(robot, ur10e(), force=True)
    assert np.abs(forced.chain().home - ur10e().to_chain().home).max() <= HOME


def test_a_refusal_names_the_links_of_the_robot_though_the_calibration_calls_them_otherwise():
    table = pk.dh.published("ur5e")
    robot = pk.ur.from_dh(table, nominal=table).to_robot("ur")
    joints = [
        replace(joint, parent=f"left_{joint.parent}", child=f"left_{joint.child}")
        for joint in robot.joints
    ]
    left = Robot("left", [f"left_{link}" for link in robot.links], joints)
    with pytest.raises(InputError, match=r"arm 'left', from 'left_base' to 'left_tool0': "):
        pk.calibration.apply(left, ur10e())


ARMS = [arm for n in (6, 7) for arm in known_arms(n)]


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_every_arm_refuses_others_and_takes_its_own(arm):
    robot = arm.calibration.to_robot(arm.name)
    base, tip = robot.root, robot.leaves[0]
    here = ARMS.index(arm)
    for k, other in enumerate(ARMS):
        if k != here and (k + here) % 3:
            continue  # of the others every third: each is refused by five or six
        if k == here:
            pk.calibration.apply(robot, other.calibration, base=base, tip=tip)
            continue
        with pytest.raises(InputError) as caught:
            pk.calibration.apply(robot, other.calibration, base=base, tip=tip)
        assert f"; it fits '{other.name}', within 0 mm and 0°" in str(caught.value)


def test_no_warning_comes_before_the_refusal():
    """A tip that is the last moving link would get a tool link, with a warning."""
    robot = pk.load("ur5e")
    with pytest.raises(InputError, match="not of the arm"):
        pk.calibration.apply(robot, ur10e(), tip="wrist_3_link")


def test_of_two_arms_that_differ_in_the_wrist_the_tip_says_so():
    """A UR3 and a UR3e: no axis is off by more than 18.7 mm."""
    table = pk.dh.published("ur3")
    calibration = pk.ur.from_dh(table, nominal=table)
    table = pk.dh.published("ur3e")
    robot = pk.ur.from_dh(table, nominal=table).to_robot("ur3e")
    with pytest.raises(InputError, match=r": the tip 'tool0' is 28\.9 mm and 0° off, and one of"):
        pk.calibration.apply(robot, calibration)


def test_an_arm_of_other_joints_is_refused_forced_or_not():
    for force in (False, True):
        with pytest.raises(InputError) as caught:
            pk.calibration.apply(pk.load("ur5e"), read_text(RIZON_YAML), force=force)
        assert re.fullmatch(
            r"the robot has 6 joints from 'base' to 'tool0': .*; the chain has 7: .*; it fits"
            r" 'Rizon4 or 4s', within 3\.38 mm and 0\.723°",
            str(caught.value),
        )


def test_a_chain_goes_between_the_links_that_it_is_called_after():
    robot = pk.load("panda")
    chain = robot.chain(tip="panda_hand")
    shift = pk.se3.exp([0, 0, 0, 0, 0, 1e-3])
    calibrated = pk.calibration.apply(robot, chain.rebased(shift))
    assert np.abs(calibrated.chain(tip="panda_hand").home - shift @ chain.home).max() <= HOME
    far = pk.se3.exp([0, 0, 0, 0, 0.03, 0])
    with pytest.raises(InputError) as caught:
        pk.calibration.apply(robot, chain.rebased(far))
    assert says(
        caught.value,
        "the calibration is not of the arm 'panda', from 'panda_link0' to 'panda_hand': the axis of"
        " 'panda_joint1' is 30 mm and 0° off, the tip 'panda_hand' is 30 mm and 0° off, and one of"
        " the same arm moves them by less than 20 mm and 3°; force=True (--force) puts it on all the same",
    )


def test_another_base_or_tip_that_fits_is_named():
    """base_link and base of ur_description, half a turn apart; a tool that is 0.1 m long."""
    plain = ur10e().to_robot()
    half = pk.se3.exp([0, 0, np.pi, 0, 0, 0])
    tool = pk.se3.exp([0, 0, 0, 0, 0, 0.1])
    joints = [
        *plain.joints,
        pk.Joint("mount", "fixed", "base_link", "base", half),
        pk.Joint("tool", "fixed", "tool0", "tcp", tool),
        pk.Joint("lamp", "floating", "base_link", "lamp"),
    ]
    robot = Robot("cell", ["base_link", *plain.links, "tcp", "lamp"], joints)
    for ends, said in (
        ({"base": "base_link"}, "; with 'base' for the base it is of this arm; it fits"),
        ({"tip": "tcp"}, "; with 'wrist_3_link' for the tip it is of this arm; it fits"),
    ):
        with pytest.raises(InputError) as caught:
            pk.calibration.apply(robot, ur10e(), base=ends.get("base"), tip=ends.get("tip"))
        assert said in str(caught.value)


def calibrated(arm: Any, nominal: Any, tmp_path: Any) -> Any:
    """The result of a calibration, through its file."""
    made = pk.calibration.simulated(arm, 30, seed=2)
    found = pk.calibrate(nominal, made.q, pk.calibration.Poses(made.truth.fk(made.q)), folds=0)
    found.save(tmp_path / "found.toml")
    return found, made.truth


def test_a_result_of_calibrate_goes_on_the_robot_it_began_with_whatever_base_it_found(tmp_path):
    robot = pk.load("ur5e")
    arm = robot.chain()
    tracker = pk.se3.exp([0.3, 0.2, 0.1, 1.0, 2.0, 3.0])
    found, truth = calibrated(arm.rebased(tracker), arm, tmp_path)
    for result in (found, tmp_path / "found.toml"):
        home = pk.calibration.apply(robot, result).chain().home
        assert np.abs(home - truth.home).max() <= 1e-6
    with pytest.raises(InputError, match=r"not of the arm 'ur', .*; it fits 'ur5e'"):
        pk.calibration.apply(ur10e().to_robot(), found, base="base", tip="tool0")


def test_what_a_controller_calculates_goes_on_the_robot(tmp_path):
    robot = pk.load("ur5e")
    q = robot.chain().random(0, 40)
    found = pk.calibration.from_fk(
        robot.chain(), q, read_text(yaml(UR5E, names=UR_LINKS)).to_chain().fk(q)
    )
    home = pk.calibration.apply(robot, found).chain().home
    assert np.abs(home - found.chain.home).max() <= HOME
    with pytest.raises(InputError, match=r"; it fits 'ur5e'"):
        pk.calibration.apply(ur10e().to_robot(), found)


def test_a_file_with_the_calibrated_chain_alone_is_judged_by_it(tmp_path):
    tomli_w = pytest.importorskip("tomli_w")
    chain = ur10e().to_chain()
    table = {"format": FORMAT, "version": VERSION, CALIBRATED: to_data(chain)}
    (tmp_path / "c.toml").write_text(tomli_w.dumps(table), encoding="utf-8")
    with pytest.raises(InputError, match=r"; it fits 'ur10e', within 0 mm and 0°; force"):
        pk.calibration.apply(pk.load("ur5e"), tmp_path / "c.toml")
    assert pk.calibration.apply(ur10e().to_robot(), tmp_path / "c.toml").root == "base"


def test_joints_in_another_order_or_of_another_kind_are_said_and_no_distance():
    robot = pk.load("ur5e")
    chain = robot.chain()
    swapped = (*chain.joint_names[1::-1], *chain.joint_names[2:])
    with pytest.raises(
        InputError, match=r"^the joints come in another order: .*'shoulder_lift_joint'"
    ):
        pk.calibration.apply(robot, chain.replace(joint_names=swapped))
    slides = chain.screws.copy()
    slides[0] = [0, 0, 0, 0, 0, 1]
    with pytest.raises(
        InputError, match=r"^joint 'shoulder_pan_joint' of the robot is revolute, and"
    ):
        pk.calibration.apply(robot, chain.replace(screws=slides))


def test_where_no_joint_moves_there_is_nothing_to_calibrate():
    robot = pk.load("ur5e")
    with pytest.raises(InputError, match=r"^no joint moves between 'base' and 'base'"):
        pk.calibration.apply(robot, robot.chain(tip="base"))


def test_a_robot_that_has_no_link_of_that_name_is_refused():
    with pytest.raises(UnknownName, match="no tip link 'gripper'"):
        pk.calibration.apply(pk.load("ur5e"), ur10e(), tip="gripper")
    with pytest.raises(UnknownName, match="no base link 'world'"):
        pk.calibration.apply(pk.load("ur5e"), ur10e(), base="world")


def test_the_root_and_the_only_leaf_are_taken_where_names_are_another_s():
    robot = read_urdf(urdf(UFACTORY["xarm6"], base="a", tip="b").replace("0.3 -0.2 0.7", "0 0 0")
                      .replace("0.1 0.2 0.3", "0 0 0"))  # fmt: skip
    calibration = read_text(yaml(UFACTORY["xarm6"]))
    assert pk.calibration.apply(robot, calibration).root == "world"


ANY: Any = 7
BAD: list[tuple[Any, str]] = [
    (
        lambda path: pk.calibration.apply(ANY, ur10e()),
        "apply: expected a Robot, got 7",
    ),
    (
        lambda path: pk.calibration.apply(pk.load("ur5e"), ANY),
        "apply: expected a Calibration, a FactoryCalibration, a Chain or the path of a file, got int",
    ),
    (
        lambda path: pk.calibration.apply(pk.load("ur5e"), ur10e(), force=ANY),
        "force: expected True or False, got 7",
    ),
    (
        lambda path: pk.calibration.apply(pk.load("ur5e"), "arm.urdf"),
        "'arm.urdf': expected a calibration, a .toml of `Calibration.save` or a .yaml of a vendor;"
        " pk.relinked puts the chain of any other model on a robot",
    ),
    (
        lambda path: pk.calibration.apply(pk.load("ur5e"), path / "gone.YAML"),
        "{}/gone.YAML: cannot be read: No such file or directory",
    ),
    (
        lambda path: pk.calibration.apply(pk.load("ur5e"), path / "gone.toml"),
        "{}/gone.toml: cannot be read: No such file or directory",
    ),
]


@pytest.mark.parametrize(("make", "message"), BAD)
def test_what_is_no_calibration_is_refused(make, message, tmp_path):
    with pytest.raises(PoekinError) as caught:
        make(tmp_path)
    assert says(caught.value, message.format(tmp_path))


def test_a_file_written_here_goes_back_on_the_robot(tmp_path):
    calibration = read_text(RIZON_YAML)
    path = tmp_path / "rizon.yml"
    path.write_text(make_text(calibration), encoding="utf-8")
    robot = read_urdf(urdf(RIZON_NOMINAL, **FLEXIV))
    home = pk.calibration.apply(robot, path).chain("base_link", "flange").home
    assert np.abs(home - calibration.to_chain().home).max() <= HOME
