"""A user's own URDF back: what moved is changed, and every other byte is the user's."""

from __future__ import annotations

import gzip
import re
import warnings
import zipfile
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import FileError, InputError, ModelError, PoekinWarning
from poekin.formats import urdf_in_place
from poekin.formats.erd import available, example_robots
from poekin.formats.urdf_in_place import in_place
from poekin.model.joint import Joint
from poekin.model.robot import Robot
from poekin.testing.strategies import urdf_strategies
from tests.formats.urdf_in_place.in_place_cases import (
    ARM,
    longest,
    moved_joints,
    perturbed,
    quietly,
    read,
    without,
)

EXACT = 1e-13
"""What issue and docstring promise of poses, in reaches."""
NO_ROBOT = {"biped2d", "bike", "husky", "humanoid", "ur3"}


def pose_error(data: bytes, chain: pk.Chain, tip: str) -> float:
    """How far the branch of a URDF is from a chain at some configurations [rad, and in reaches]."""
    branch = read(data).chain(chain.base, tip)
    q = np.random.default_rng(1).uniform(-1.5, 1.5, (20, chain.dof))
    error = np.abs(branch.fk(q) - chain.fk(q)) / [1, 1, 1, chain.reach]
    return float(error.max())


def as_pinocchio_has_it(data: bytes) -> tuple[Any, ...]:
    """Names and order of joints, masses and limits, by Pinocchio."""
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio.buildModelFromXML(data.decode())
    arrays = (
        model.lowerPositionLimit,
        model.upperPositionLimit,
        model.velocityLimit,
        model.effortLimit,
        np.array([inertia.mass for inertia in model.inertias]),
    )
    return list(model.names), *(array.tolist() for array in arrays)


def calibrated(data: bytes, robot: Robot, seed: int = 0) -> tuple[bytes, pk.Chain, str] | None:
    """The text with its longest branch calibrated, the calibrated chain, and where its tip is."""
    nominal = longest(robot)
    if nominal is None:
        return None
    chain = perturbed(nominal, np.random.default_rng(seed))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        result = pk.to_urdf(chain, into=data)
    tools = [re.search(r"the tip is the new link '([^']*)'", str(w.message)) for w in said]
    tip = next((found[1] for found in tools if found), chain.tip)
    return result, chain, tip


def without_tool(data: bytes, tip: str) -> bytes:
    """The text without the link that was added for the tool, and its joint."""
    link = rf'\s*<link name="{tip}"/>\s*<joint name="{tip}_joint" type="fixed">.*?</joint>'
    return re.sub(link.encode(), b"", data, flags=re.DOTALL)


# Neighbours by name are variants of one robot.
@pytest.mark.parametrize("name", sorted(available())[::2])
def test_a_calibration_changes_nothing_but_origins_and_axes_of_joints_that_moved(name):
    with open(available()[name], "rb") as stream:
        data = stream.read()
    if name not in example_robots()[0]:
        pytest.skip("a file without a robot")
    robot = read(data)
    assert quietly(pk.to_urdf, robot, into=data) == data
    made = calibrated(data, robot)
    if made is None:
        pytest.skip("no joint moves")
    assert quietly(pk.to_urdf, longest(robot), into=data) == data  # which moves nothing
    result, chain, tip = made
    assert pose_error(result, chain, tip) <= EXACT
    if tip != chain.tip:
        assert tip == f"{chain.tip}_tool"
        result = without_tool(result, tip)
    moved = moved_joints(data, result)
    # the joints of the chain, and the first of the fixed ones behind them
    assert len(moved) in (len(chain.joint_names), len(chain.joint_names) + 1)
    assert moved >= set(chain.joint_names)
    # an element that was not there brings the blanks before it
    assert without(result, moved).split() == without(data, moved).split()
    if moved_joints(data, result).isdisjoint(_lacking(data)):
        assert without(result, moved) == without(data, moved)
    assert as_pinocchio_has_it(result) == as_pinocchio_has_it(data)


def _lacking(data: bytes) -> set[str]:
    """Joints without an origin, or moving ones without an axis."""
    found = set()
    for text in re.findall(rb"<joint\s[^>]*type.*?</joint>", data, flags=re.DOTALL):
        name = re.search(rb"name\s*=\s*[\"']([^\"']*)", text)
        if name and (b"<origin" not in text or b"<axis" not in text):
            found.add(name[1].decode())
    return found


@given(odd=urdf_strategies.odd_urdfs(), seed=st.integers(0, 2**32))
def test_any_joint_of_any_robot_may_move_and_a_second_time_nothing_does(odd, seed):
    rng = np.random.default_rng(seed)
    before = read(odd.text)
    joints = [_moved(joint, rng) for joint in before.joints]
    wanted = Robot(before.name, before.links, joints)
    once = quietly(urdf_in_place.edit, odd.text, wanted)
    assert quietly(urdf_in_place.edit, once, wanted) == once
    still = {joint.name for joint, new in zip(before.joints, joints, strict=True) if joint == new}
    assert still.isdisjoint(moved_joints(odd.text.encode(), once))


def _moved(joint: Joint, rng: np.random.Generator) -> Joint:
    """The joint, with another origin, another axis, both or neither; by much, or by very little."""
    size = 10.0 ** rng.integers(-12, 1)
    twist = rng.normal(size=6) * size * rng.integers(0, 2, 6)
    axis = joint.axis
    if joint.kind in ("revolute", "continuous", "prismatic", "planar") and rng.integers(2):
        axis = pk.so3.exp(rng.normal(size=3) * size) @ axis
    return replace(joint, origin=joint.origin @ pk.se3.exp(twist), axis=axis)


def test_a_change_is_the_numbers_that_changed():
    robot = read(ARM)
    up = replace(robot.joint("turn"), origin=pk.se3.exp([0, 0, 0, 0, 0, 0.25]))
    assert _edited(robot, up) == ARM.replace('xyz="0  0 0.30"', 'xyz="0  0 0.25"')
    lift = robot.joint("lift")
    shift = pk.se3.exp([0, 0, 0, 0, 0.125, 0])
    aside = replace(lift, origin=shift @ lift.origin)
    assert _edited(robot, aside) == ARM.replace('"1e-1 0 0.4"', '"1e-1 0.125 0.4"')
    tilted = replace(lift, axis=(0.0, 0.6, 0.8))
    assert _edited(robot, tilted) == ARM.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 0.6 0.8"/>')


def _edited(robot: Robot, *joints: Joint) -> str:
    new = {joint.name: joint for joint in joints}
    every = [new.get(joint.name, joint) for joint in robot.joints]
    links = [*robot.links, *(j.child for j in joints if j.child not in robot.links)]
    added = [joint for joint in joints if joint.name not in {j.name for j in robot.joints}]
    return pk.to_urdf(Robot(robot.name, links, [*every, *added]), into=ARM.encode()).decode()


def test_what_is_not_there_is_inserted_as_the_file_is_written():
    text = (
        ARM.replace("\n", "\r\n")
        .replace('link="', "link='")
        .replace('"/>\r\n    <child', "'/>\r\n    <child")
    )
    text = text.replace("link='one\"/>", "link='one'/>")
    text = text.replace('    <axis xyz="0 0 1"/>\r\n', "").replace(
        '<origin xyz="0  0 0.30" rpy="0 0 0" />\r\n    ', ""
    )
    text = re.sub(r"link='(\w+)\"", r"link='\1'", text)
    robot = read(text)
    turn = replace(
        robot.joint("turn"), origin=pk.se3.exp([0, 0, 0, 0, 0, 0.5]), axis=(0.0, 0.0, 1.0)
    )
    flange = replace(robot.joint("flange"), origin=pk.se3.exp([0, 0, 0.5, 0, 0, 0]))
    joints = [{"turn": turn, "flange": flange}.get(j.name, j) for j in robot.joints]
    wanted = Robot(robot.name, robot.links, joints)
    expected = text.replace(
        "    <parent link='base'/>\r\n",
        "    <origin xyz='0 0 0.5'/>\r\n    <axis xyz='0 0 1'/>\r\n    <parent link='base'/>\r\n",
    ).replace('<origin xyz="0.5 0 0"/>', '<origin xyz="0 0 0" rpy="0 0 0.5"/>')
    assert urdf_in_place.edit(text, wanted).decode() == expected


def test_an_origin_without_any_attribute_gets_its_own():
    text = ARM.replace('<origin xyz="0.5 0 0"/>', "<origin />")
    robot = read(text)
    flange = replace(robot.joint("flange"), origin=pk.se3.exp([0, 0, 0, 0, 0, 0.5]))
    wanted = Robot(robot.name, robot.links, [*robot.joints[:-1], flange])
    assert urdf_in_place.edit(text, wanted).decode() == text.replace(
        "<origin />", '<origin xyz="0 0 0.5" />'
    )


def test_at_gimbal_lock_a_calibration_tilts_the_axis_and_leaves_roll_pitch_yaw():
    robot = read(ARM)
    chain = perturbed(robot.chain(tip="hand"), np.random.default_rng(0))
    text = pk.to_urdf(chain, into=ARM.encode()).decode()
    assert 'rpy="0 1.5707963267948966 3.141592653589793"' in text
    assert '<axis xyz="0 1 0"/>' not in text
    assert '<axis xyz="0 0 1"/>' in text


def test_roll_pitch_yaw_are_the_nearest_of_all_that_are_the_same_turn():
    text = ARM.replace('rpy="0 0 0.7853981633974483"', 'rpy="3.14159 3.14159 -6.28"')
    robot = read(text)
    held = robot.joint("held")
    turned = replace(held, origin=held.origin @ pk.se3.exp([1e-3, 1e-3, 1e-3, 0, 0, 0]))
    joints = [turned if joint == held else joint for joint in robot.joints]
    new = urdf_in_place.edit(text, Robot(robot.name, robot.links, joints)).decode()
    found = re.search(r'<origin xyz="0.25 0 0" rpy="([^"]*)"/>', new)
    assert found
    numbers = [float(x) for x in found[1].split()]
    # a turn of sqrt(3) mrad, and pitch 2.7e-6 rad from half a turn: each angle changes by that much
    assert np.abs(np.subtract(numbers, [3.14159, 3.14159, -6.28])).max() <= 1.8e-3


@pytest.mark.parametrize(("version", "counts"), [("1.1", True), ("1.0", False)])
def test_a_quaternion_stays_one_where_it_counts(version, counts):
    half = 0.7071067811865476
    text = ARM.replace('<robot name="arm">', f'<robot name="arm" version="{version}">').replace(
        '<origin xyz="0.5 0 0"/>', f'<origin xyz="0.5 0 0" quat_xyzw="0 0 -{half} -{half}"/>'
    )
    robot = read(text)
    flange = robot.joint("flange")
    turned = replace(flange, origin=flange.origin @ pk.se3.exp([0, 0, 1e-3, 0, 0, 0]))
    wanted = Robot(robot.name, robot.links, [*robot.joints[:-1], turned])
    new = urdf_in_place.edit(text, wanted).decode()
    found = re.search(r'<origin xyz="0.5 0 0" quat_xyzw="([^"]*)"(.*)/>', new)
    assert found
    x, y, z, w = (float(number) for number in found[1].split())
    if counts:
        angle = (np.pi / 2 + 1e-3) / 2
        assert (x, y) == (0, 0)
        assert (z, w) == pytest.approx((-np.sin(angle), -np.cos(angle)), abs=1e-15)
        assert found[2] == ""
    else:
        assert (z, w) == (-half, -half)
        assert found[2] == ' rpy="0 0 0.001"'


def test_numbers_with_characters_by_number_are_written_whole_and_rounding_is_none_of_it():
    text = ARM.replace('xyz="0.25 0 0"', 'xyz="0.2&#53;&#32;0 0"')
    robot = read(text)
    origin = robot.joint("held").origin.copy()
    origin[:3, 3] = 0.25 + 2**-54, 1e-17, 1.0
    held = replace(robot.joint("held"), origin=origin)
    joints = [held if joint.name == "held" else joint for joint in robot.joints]
    new = urdf_in_place.edit(text, Robot(robot.name, robot.links, joints)).decode()
    assert new == text.replace('xyz="0.2&#53;&#32;0 0"', 'xyz="0.25 0 1"')


def test_numbers_apart_by_a_blank_that_is_none_of_ascii_s_are_written_whole():
    text = ARM.replace('xyz="0.25 0 0"', 'xyz="0.25\u2003 0 0"')
    robot = read(text)
    origin = robot.joint("held").origin.copy()
    origin[:3, 3] = 0.25, 0.0, 1.0
    held = replace(robot.joint("held"), origin=origin)
    joints = [held if joint.name == "held" else joint for joint in robot.joints]
    new = urdf_in_place.edit(text, Robot(robot.name, robot.links, joints)).decode()
    assert new == ARM.replace('xyz="0.25 0 0"', 'xyz="0.25 0 1"')


@pytest.mark.parametrize("kind", ["prismatic", "planar"])
def test_the_axis_of_any_joint_that_has_one_is_written(kind):
    text = ARM.replace('name="turn" type="revolute"', f'name="turn" type="{kind}"')
    robot = read(text)
    tilted = replace(robot.joint("turn"), axis=(0.0, 0.6, 0.8))
    joints = [tilted if joint.name == "turn" else joint for joint in robot.joints]
    new = urdf_in_place.edit(text, Robot(robot.name, robot.links, joints)).decode()
    assert new == text.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0.6 0.8"/>')


@pytest.mark.parametrize("first", ["  ", "        "])
def test_a_tool_link_comes_behind_all_else_as_the_last_joint_is_indented(first):
    given = ARM.replace('  <joint name="turn"', f'{first}<joint name="turn"')
    robot = read(given)
    chain = robot.chain(tip="two").retooled(pk.se3.pose(pk.so3.exp([0, 0, 0.5]), [0.25, 0, 0]))
    with pytest.warns(PoekinWarning, match="'two_tool'"):
        text = pk.to_urdf(chain, into=given.encode()).decode()
    more = """
  <link name="two_tool"/>
  <joint name="two_tool_joint" type="fixed">
    <parent link="two"/>
    <child link="two_tool"/>
    <origin xyz="0.25 0 0" rpy="0 0 0.5"/>
  </joint>
</robot>
"""
    assert text.startswith(given.removesuffix("\n</robot>\n") + "\n  <link name=")
    numbers = re.search(r'xyz="([^"]*)" rpy="([^"]*)"/>\n  </joint>\n</robot>\n$', text)
    assert numbers
    found = [float(x) for x in " ".join(numbers.groups()).split()]
    # a product of three poses of an arm of 0.9 m, and its inverse
    assert np.abs(np.subtract(found, [0.25, 0, 0, 0, 0, 0.5])).max() <= 2e-15
    assert re.sub(r"<origin [^>]*>", "", text[-len(more) - 60 :]).endswith(
        re.sub(r"<origin [^>]*>", "", more)
    )
    assert pose_error(text.encode(), chain, "two_tool") <= EXACT


def test_a_chain_that_is_compiled_is_put_in_as_it_is():
    chain = perturbed(read(ARM).chain(tip="hand"), np.random.default_rng(3))
    assert pk.to_urdf(chain.compile(), into=ARM.encode()) == pk.to_urdf(chain, into=ARM.encode())


@pytest.mark.parametrize(("far", "still"), [(0.3, 2e-15), (1000.0, 2e-12)])
def test_what_rounding_makes_of_a_joint_is_no_motion(far, still):
    text = ARM.replace('xyz="0  0 0.30"', f'xyz="0  0 {far}"')
    robot = read(text)
    flange = robot.joint("flange")
    for twist in np.eye(6)[2:4]:
        size = still if twist[3] else 2e-15
        for part, changes in ((0.9, False), (1.5, True)):
            moved = replace(flange, origin=flange.origin @ pk.se3.exp(part * size * twist))
            wanted = Robot(robot.name, robot.links, [*robot.joints[:-1], moved])
            assert (urdf_in_place.edit(text, wanted) != text.encode()) == changes


def test_of_an_unreadable_axis_or_limit_nothing_is_said_once_more():
    text = ARM.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 2"/>').replace('lower="-1" ', "")
    robot = quietly(read, text)
    assert urdf_in_place.edit(text, robot) == text.encode()
    tilted = replace(robot.joint("turn"), axis=(0.0, 0.6, 0.8))
    joints = [tilted if joint.name == "turn" else joint for joint in robot.joints]
    new = urdf_in_place.edit(text, Robot(robot.name, robot.links, joints)).decode()
    assert new == text.replace('<axis xyz="0 0 2"/>', '<axis xyz="0 0.6 0.8"/>')


ONE = '<robot name="r">\n  <link name="b"/>\n</robot>\n'


def test_a_camera_may_be_added_to_a_single_link():
    joint = Joint("h\u00f6lder", "fixed", "b", "ca&m", pk.se3.exp([0, 0, 0, 0, 0, 0.5]))
    text = urdf_in_place.edit(ONE, Robot("r", ["b", "ca&m"], [joint])).decode()
    assert text == ONE.replace(
        "\n</robot>",
        '<link name="ca&#38;m"/><joint name="h&#246;lder" type="fixed"><parent link="b"/>'
        '<child link="ca&#38;m"/><origin xyz="0 0 0.5" rpy="0 0 0"/></joint>\n</robot>',
    )
    with pytest.raises(InputError, match=r"^<text> has other links: 'a', 'b'$"):
        urdf_in_place.edit(ONE, Robot("r", ["a"], []))


def test_a_joint_is_added_on_one_line_where_others_stand_on_one():
    ends = '<parent link="{}"/><child link="{}"/>'
    lines = [
        '<robot name="r">',
        '  <link name="a"/>',
        '  <link name="b"/>',
        f'  <joint name="j" type="fixed">{ends.format("a", "b")}</joint>',
        "</robot>",
    ]
    text = "\n".join(lines)
    joints = [*read(text).joints, Joint("k", "fixed", "b", "c")]
    added = urdf_in_place.edit(text, Robot("r", ["a", "b", "c"], joints)).decode()
    origin = '<origin xyz="0 0 0" rpy="0 0 0"/>'
    assert added.splitlines() == [
        *lines[:-1],
        '  <link name="c"/>',
        f'  <joint name="k" type="fixed">{ends.format("b", "c")}{origin}</joint>',
        "</robot>",
    ]


ROBOT = read(ARM)
TURN = ROBOT.joint("turn")
ANY: Any = 7


def with_joint(joint: Joint) -> Robot:
    joints = [joint if old.name == joint.name else old for old in ROBOT.joints]
    return Robot("arm", ROBOT.links, joints)


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (
            with_joint(replace(TURN, limits=(-1, 1))),
            "joint 'turn': limits is (-1.0, 1.0), and in <text> it is (-2.9, 2.9): only origins and axes"
            " are written in place; a chain (on the command line with --tip) goes in by the names of its"
            " base and tip",
        ),
        (
            Robot("arm", ROBOT.links[:-1], ROBOT.joints[:-1]),
            "<text> has joints that the robot has not: 'flange'; a chain (on the command line with"
            " --tip) goes in by the names of its base and tip",
        ),
        (
            Robot("arm", [*ROBOT.links, "x"], [*ROBOT.joints, Joint("j", "revolute", "hand", "x")]),
            "<text> has no joint 'j': only a fixed one can be added, and it is revolute",
        ),
    ],
)
def test_a_robot_that_differs_in_more_is_refused(wanted, message):
    with pytest.raises(InputError) as caught:
        pk.to_urdf(wanted, into=ARM.encode())
    assert str(caught.value) == message


def test_a_robot_that_was_read_from_a_urdf_stands_for_its_text():
    chain = perturbed(ROBOT.chain(tip="hand"), np.random.default_rng(3))
    expected = pk.to_urdf(chain, into=ARM.encode())
    assert pk.to_urdf(chain, into=ROBOT) == expected
    calibrated = pk.relinked(ROBOT, chain, base="base", tip="hand")
    assert pk.to_urdf(calibrated, into=calibrated) == expected
    with pytest.raises(InputError, match=r"^into: the robot 'arm' was not read from a URDF$"):
        pk.to_urdf(chain, into=Robot("arm", ROBOT.links, ROBOT.joints))
    with pytest.raises(InputError, match=r"^into: the robot 'puma560' was not read from a URDF$"):
        pk.to_urdf(chain, into=pk.load("puma560"))


def test_what_cannot_go_together_is_refused():
    with pytest.raises(InputError, match=r"^to_urdf: expected name or into, got both"):
        pk.to_urdf(ROBOT, name="x", into=ARM.encode())  # pyright: ignore[reportCallIssue, reportArgumentType]
    with pytest.raises(InputError, match=r"^to_urdf: expected a Robot or a Chain, got int$"):
        pk.to_urdf(ANY, into=ARM.encode())
    with pytest.raises(InputError, match=r"^into: expected a path, bytes or a Robot, got 7$"):
        pk.to_urdf(ROBOT, into=ANY)
    with pytest.raises(pk.PoekinError, match="no base link 'floor'"):
        pk.to_urdf(ROBOT.chain(tip="hand").replace(base="floor"), into=ARM.encode())


def test_joints_that_only_a_namespace_tells_apart_are_refused():
    text = ARM.replace('<robot name="arm">', '<robot name="arm" xmlns="a" xmlns:u="a">')
    for name in ("parent", "child", "origin", "axis"):
        text = text.replace(f"<{name} ", f"<u:{name} ").replace(f"</{name}>", f"</u:{name}>")
    text = text.replace("<origin\n", "<u:origin\n")
    with pytest.raises(ModelError, match=r"the tags of its joints have different prefixes$"):
        urdf_in_place.edit(text, read(text))


def test_one_prefix_for_all_tags_is_kept():
    text = re.sub(r"<(/?)(?=[a-z])", r"<\1u:", ARM).replace("<u:robot ", '<u:robot xmlns:u="urdf" ')
    robot = read(text)
    chain = perturbed(robot.chain(tip="two"), np.random.default_rng(0))
    new: bytes = quietly(pk.to_urdf, chain, into=text.encode())
    assert pose_error(new, chain, "two_tool") <= EXACT
    assert b'<u:link name="two_tool"/>' in new


def test_a_text_that_does_not_read_as_the_robot_is_not_given_back(monkeypatch):
    moved = replace(TURN, origin=pk.se3.exp([0, 0, 0, 0, 0, 0.25]))
    tilted = replace(TURN, axis=(0.0, 0.6, 0.8))
    monkeypatch.setattr(in_place, "edits_of", lambda *_: [])
    for joint, off in ((moved, "5.0e-02"), (tilted, "6.0e-01")):
        with pytest.raises(ModelError) as caught:
            urdf_in_place.edit(ARM, with_joint(joint))
        assert str(caught.value) == (
            f"<text>: the text with joint 'turn' changed does not read as the robot, by {off}:"
            " nothing is written"
        )


XACRO = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="cell">
  <xacro:arg name="length" default="0.3"/>
  <xacro:property name="half_turn" value="${pi / 2}"/>
  <xacro:macro name="joint" params="name parent child xyz rpy *limit">
    <link name="${child}">
      <visual><geometry><mesh filename="package://cell/${child}.dae"/></geometry></visual>
      <inertial><mass value="${2 * 1.5}"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    </link>
    <joint name="${name}" type="revolute">
      <parent link="${parent}"/><child link="${child}"/>
      <origin rpy="${rpy}" xyz="${xyz}"/><axis xyz="0 0 1"/>
      <xacro:insert_block name="limit"/><dynamics damping="0.1"/>
    </joint>
    <transmission name="${name}_drive"><joint name="${name}"/></transmission>
  </xacro:macro>
  <link name="base"/>
  <xacro:joint name="a" parent="base" child="one" xyz="0 0 $(arg length)" rpy="0 0 0">
    <limit lower="-3" upper="3" effort="87" velocity="2"/></xacro:joint>
  <xacro:joint name="b" parent="one" child="two" xyz="0 ${0.1 * 2} 0" rpy="${half_turn} 0 0">
    <limit lower="-2" upper="2" effort="87" velocity="2"/></xacro:joint>
  <xacro:joint name="c" parent="two" child="three" xyz="0.4 0 0" rpy="0 ${-half_turn} 0">
    <limit lower="-1" upper="1" effort="12" velocity="2.5"/></xacro:joint>
  <joint name="mount" type="fixed"><parent link="three"/><child link="tool"/><origin xyz="0 0 0.1"/></joint>
  <link name="tool"/>
  <ros2_control name="system"><joint name="a"><param name="p">1</param></joint></ros2_control>
  <gazebo reference="one"><material>Gazebo/Grey</material></gazebo>
</robot>
"""


def test_what_xacro_makes_of_a_file_is_edited_as_any_other_urdf(tmp_path):
    pytest.importorskip("xacrodoc")
    path = tmp_path / "cell.urdf.xacro"
    path.write_text(XACRO, encoding="utf-8")
    robot = pk.xacro(path, length=0.5)
    assert robot.source is not None
    assert isinstance(robot.source.text, str)
    data = robot.source.text.encode()
    assert pk.to_urdf(robot, into=robot) == data
    chain = perturbed(robot.chain(tip="tool"), np.random.default_rng(0))
    result = pk.to_urdf(chain, into=robot)
    assert moved_joints(data, result) == {"a", "b", "c", "mount"}
    assert without(result, {"a", "b", "c", "mount"}) == without(data, {"a", "b", "c", "mount"})
    assert pose_error(result, chain, "tool") <= EXACT
    assert as_pinocchio_has_it(result) == as_pinocchio_has_it(data)
    assert b'rpy="0 -1.5707963267948966 0"' in result  # at gimbal lock


def test_a_compressed_urdf_is_edited_as_what_is_in_it(tmp_path):
    chain = ROBOT.chain(tip="hand").retooled(pk.se3.exp([0, 0, 0, 0.01, 0, 0]))
    expected = pk.to_urdf(chain, into=ARM.encode())
    content = gzip.compress(ARM.encode())
    (tmp_path / "arm.urdf.gz").write_bytes(content)
    with zipfile.ZipFile(tmp_path / "arms.zip", "w") as archive:
        archive.writestr("arm.urdf", ARM)
        archive.writestr("readme.txt", "no model")
    for into in ("arm.urdf.gz", "arms.zip", "arms.zip/arm.urdf"):
        assert pk.to_urdf(chain, into=tmp_path / into) == expected
    assert pk.to_urdf(chain, into=content) == expected
    assert (tmp_path / "arm.urdf.gz").read_bytes() == content
    with pytest.raises(FileError, match=r"arms\.zip has no file 'gone\.urdf'"):
        pk.to_urdf(chain, into=str(tmp_path / "arms.zip/gone.urdf"))
    with pytest.raises(FileError, match=r"^<text>: cannot be decompressed"):
        pk.to_urdf(chain, into=content[:40])


@pytest.mark.parametrize("at", [*np.ndindex(3, 4)])
@pytest.mark.parametrize(("off", "refused"), [(0.9, False), (1.1, True)])
def test_a_text_is_refused_where_any_number_of_a_pose_is_off_by_more_than_rounding(
    at, off, refused
):
    robot = pk.from_text(ARM, "arm.urdf")
    size = 3.0
    wanted = robot.fk(np.zeros(robot.dof))
    child = robot.joints[-1].child
    change = off * EXACT * (size if at[1] == 3 else 1)
    given: Any = SimpleNamespace(
        fk=lambda q: wanted | {child: wanted[child].copy()}, dof=robot.dof, joints=robot.joints
    )
    asked = dict(wanted)
    asked[child] = wanted[child].copy()
    asked[child][at] += change
    if refused:
        with pytest.raises(ModelError, match=r"does not read as the robot, by 1\.1e-13"):
            in_place._check(given, robot, asked, size, "arm.urdf")
    else:
        in_place._check(given, robot, asked, size, "arm.urdf")
