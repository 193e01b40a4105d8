"""URDF: what it means, and what is repaired with a warning."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from poekin.errors import PoekinWarning
from poekin.formats import urdf
from poekin.model.checks import LONGEST
from poekin.model.joint import SafetyController
from poekin.model.robot import Robot
from tests.formats.texts import LIMIT, chain_of, one_joint


def read(inside: str = LIMIT, kind: str = "revolute") -> Robot:
    return urdf.read_text(one_joint(inside, kind), "x.urdf")


def Rx(a: float) -> np.ndarray:
    return np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])


def Ry(a: float) -> np.ndarray:
    return np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])


def Rz(a: float) -> np.ndarray:
    return np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])


@given(
    *[st.floats(-math.tau, math.tau)] * 3, st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3)
)
def test_an_origin_is_a_place_and_turns_about_fixed_axes(roll, pitch, yaw, xyz):
    place = " ".join(map(repr, xyz))
    T = read(f'<origin xyz="{place}" rpy="{roll!r} {pitch!r} {yaw!r}"/>{LIMIT}').joints[0].origin
    assert T[:3, 3].tolist() == xyz
    assert np.abs(T[:3, :3] - Rz(yaw) @ Ry(pitch) @ Rx(roll)).max() <= 4e-16
    assert np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() <= 1e-15


@pytest.mark.parametrize(
    "origin", ["", "<origin/>", '<origin xyz="0 0 0"/>', '<origin rpy="0 0 0"/>']
)
def test_what_an_origin_leaves_out_is_zero(origin):
    assert (read(origin + LIMIT).joints[0].origin == np.eye(4)).all()


def test_degrees_in_rpy_are_warned_of_with_their_line():
    with pytest.warns(PoekinWarning) as caught:
        read(f'<origin rpy="0 -90 0"/>{LIMIT}')
    [said] = caught
    assert str(said.message).endswith(
        "<origin>: rpy is more than a turn: degrees? Expected are rad"
    ), said.message


def test_a_missing_axis_is_x():
    assert read(LIMIT).joints[0].axis == (1, 0, 0)


def test_an_oblique_axis_stays_oblique():
    assert read('<axis xyz="0.6 0 -0.8"/>' + LIMIT).joints[0].axis == (0.6, 0, -0.8)


def test_numbers_may_be_apart_by_any_blanks():
    T = read(f'<origin xyz="  1\t2\n 3e-1 "/>{LIMIT}').joints[0].origin
    assert T[:3, 3].tolist() == [1, 2, 0.3]


@pytest.mark.parametrize("off", [1e-9, 9e-7])
def test_an_axis_off_by_rounding_is_normalised_in_silence(off):
    assert read(f'<axis xyz="0 0 {1 + off!r}"/>{LIMIT}').joints[0].axis == (0, 0, 1)


@pytest.mark.parametrize("length", [0.5, 1 - 1.1e-6, 1 + 1.1e-6, 1e-12])
def test_an_axis_shorter_or_longer_than_that_is_normalised_and_said(length):
    with pytest.warns(
        PoekinWarning, match=rf"the axis of joint 'j' has length {length:.9g} and was normalised$"
    ):
        assert read(f'<axis xyz="0 0 {length!r}"/>{LIMIT}').joints[0].axis == (0, 0, 1)


@pytest.mark.parametrize(
    "others, listed",
    [(10, "3, 4, 5, 6, 7, 8, 9, 10, 11, 12"), (11, "3, 4, 5, 6, 7, 8, 9, 10, 11, 12, ...")],
)
def test_of_many_axes_the_worst_is_named_and_the_lines_of_ten_others(others, listed):
    joints = "".join(
        f'\n<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<axis xyz="0 {0.5 if i == 0 else 0.9} 0"/></joint>'
        for i in range(others + 1)
    )
    text = (
        "<robot>" + "".join(f'<link name="l{i}"/>' for i in range(others + 2)) + joints + "</robot>"
    )
    with pytest.warns(PoekinWarning) as caught:
        urdf.read_text(text, "f")
    assert str(caught[0].message) == (
        "f:2: the axis of joint 'j0' has length 0.5 and was normalised"
        f" (the worst of {others + 1}; the others on line {listed})"
    )


@pytest.mark.parametrize("unlimited, more", [(4, ""), (6, " and 2 more")])
def test_of_many_joints_without_limits_four_are_named(unlimited, more):
    joints = "".join(
        f'\n<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(unlimited)
    )
    text = (
        "<robot>"
        + "".join(f'<link name="l{i}"/>' for i in range(unlimited + 1))
        + joints
        + "</robot>"
    )
    with pytest.warns(PoekinWarning) as caught:
        urdf.read_text(text, "f")
    named = ", ".join(f"'j{i}' (none; line {i + 2})" for i in range(4))
    assert (
        str(caught[0].message)
        == f"f:2: joints without usable limits are taken as unlimited: {named}{more}"
    )


def test_limits_below_ten_thousand_and_axes_of_nearly_unit_length_are_taken_as_they_are():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        robot = urdf.read_text(
            one_joint('<axis xyz="0 0 1.0000009"/><limit lower="-9999.5" upper="9999.5"/>'), "f"
        )
        assert robot.joints[0].limits == (-9999.5, 9999.5)
    with pytest.warns(
        PoekinWarning,
        match=r"^f:4: the axis of joint 'j' has length 1\.0000011 and was normalised$",
    ):
        urdf.read_text(one_joint('<axis xyz="0 0 1.0000011"/><limit lower="-1" upper="1"/>'), "f")


@pytest.mark.parametrize("limit, reason, limits", [
    ("", "none; line 3", (-math.inf, math.inf)),
    ("<limit/>", "none; line 4", (-math.inf, math.inf)),
    ('<limit lower="0.5" upper="0.5"/>', "equal, 0.5; line 4", (-math.inf, math.inf)),
    ('<limit lower="1" upper="-1"/>', "lower 1.0 above upper -1.0; line 4", (-math.inf, math.inf)),
    ('<limit upper="0.5"/>', "no lower bound; line 4", (-math.inf, 0.5)),
    ('<limit lower="0.5"/>', "no upper bound; line 4", (0.5, math.inf)),
    ('<limit lower="-1e9" upper="0.5"/>', "-1000000000.0 to 0.5; line 4", (-math.inf, 0.5)),
    ('<limit lower="-0.5" upper="inf"/>', "-0.5 to inf; line 4", (-0.5, math.inf)),
    ('<limit lower="-1e4" upper="0.5"/>', "-10000.0 to 0.5; line 4", (-math.inf, 0.5)),
    ('<limit lower="-0.5" upper="1e4"/>', "-0.5 to 10000.0; line 4", (-0.5, math.inf)),
    ('<limit lower="-1e4" upper="9999.5"/>', "-10000.0 to 9999.5; line 4", (-math.inf, 9999.5)),
])  # fmt: skip
def test_limits_that_are_none_are_told_with_what_they_are(limit, reason, limits):
    with pytest.warns(PoekinWarning) as caught:
        robot = urdf.read_text(one_joint(limit), "f")
    line = reason[-1]
    assert (
        str(caught[0].message)
        == f"f:{line}: joints without usable limits are taken as unlimited: 'j' ({reason})"
    )
    assert robot.joints[0].limits == limits


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_length_is_taken(sign):
    robot = read(f'<origin xyz="0 {sign * LONGEST!r} 0"/>{LIMIT}')
    assert robot.joints[0].origin[1, 3] == sign * LONGEST


def test_an_axis_that_is_not_unit_is_normalised_with_one_warning():
    joints = "\n".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<axis xyz="0 {length} 0"/></joint>'
        for i, length in enumerate([1, 1.001, 3, 0.1])
    )
    text = "<robot>" + "".join(f'<link name="l{i}"/>' for i in range(5)) + joints + "</robot>"
    with pytest.warns(
        PoekinWarning,
        match=(
            r"^f:3: the axis of joint 'j2' has length 3 and was normalised \(the worst of 3; the "
            r"others on line 2, 4\)$"
        ),
    ) as w:
        robot = urdf.read_text(text, "f")
    assert len(w) == 1
    assert w[0].filename == __file__
    assert {joint.axis for joint in robot.joints} == {(0, 1, 0)}


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_the_axis_of_a_joint_that_has_none_is_not_looked_at(kind):
    read('<axis xyz="0 0 0"/><limit lower="2" upper="1"/>', kind)


@pytest.mark.parametrize(
    "kind", ["revolute", "prismatic", "continuous", "fixed", "floating", "planar"]
)
def test_every_kind_is_read(kind):
    robot = read(LIMIT, kind)
    assert robot.joints[0].kind == kind
    assert robot.dof == (kind in ("revolute", "prismatic", "continuous"))


def test_proper_limits_are_kept():
    assert read('<limit lower="-0.5" upper="2.5"/>').limits.tolist() == [[-0.5, 2.5]]
    assert read('<limit lower="-0.5" upper="2.5"/>', "prismatic").limits.tolist() == [[-0.5, 2.5]]


INF = math.inf
LIMITS = {
    "": (-INF, INF),
    '<limit effort="1" velocity="1"/>': (-INF, INF),
    '<limit lower="0" upper="0"/>': (-INF, INF),
    '<limit lower="0.3" upper="0.3"/>': (-INF, INF),
    '<limit lower="-inf" upper="inf"/>': (-INF, INF),
    '<limit lower="-1e16" upper="1e16"/>': (-INF, INF),
    '<limit lower="-1e999" upper="2"/>': (-INF, 2),
    '<limit lower="-2" upper="1e4"/>': (-2, INF),
    '<limit upper="2"/>': (-INF, 2),
    '<limit lower="2"/>': (2, INF),
    '<limit lower="inf" upper="inf"/>': (-INF, INF),
    '<limit lower="0.1" upper="0"/>': (-INF, INF),
}


@pytest.mark.parametrize("limit, expected", LIMITS.items())
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_limits_missing_equal_infinite_or_absurd_mean_unlimited_with_a_warning(
    limit, expected, kind
):
    with pytest.warns(PoekinWarning, match=r"^x\.urdf:[34]: .* unlimited: 'j' \(.*line [34]\)$"):
        robot = read(limit, kind)
    assert tuple(robot.limits[0]) == expected


def test_all_unusable_limits_of_a_file_make_one_warning():
    joints = "\n".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(9)
    )
    text = "<robot>" + "".join(f'<link name="l{i}"/>' for i in range(10)) + joints + "</robot>"
    with pytest.warns(
        PoekinWarning,
        match=(
            r"^<text>:1: joints without usable limits are taken as unlimited: 'j0' \(none; line 1\), "
            r"'j1' \(none; line 2\), 'j2' \(none; line 3\), 'j3' \(none; line 4\) and 5 more$"
        ),
    ) as caught:
        urdf.read_text(text)
    assert len(caught) == 1


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 1 0"/>'),
        ('<origin xyz="1 0 0"/>', '<origin xyz="2 0 0"/>'),
        (LIMIT, '<limit lower="-2" upper="2"/>'),
    ],
)
def test_of_two_elements_the_first_counts_as_with_other_readers(first, second):
    rest = "" if first == LIMIT else LIMIT
    tag = first[1 : first.index(" ")]
    words = rf"^x\.urdf:5: joint 'j': <{tag}> stands there once more, and the first one counts$"
    with pytest.warns(PoekinWarning, match=words):
        robot = read(f"{first}\n{second}\n{rest}")
    assert robot.joints == read(first + rest).joints
    more = "\n".join([first, second, second, rest])
    with pytest.warns(PoekinWarning, match=r"counts \(the first of 2; the others on line 6\)$"):
        read(more)
    beside = "\n".join([first, second + second, rest])
    with pytest.warns(PoekinWarning, match=r"counts \(the first of 2; the others on line 5\)$"):
        read(beside)


@pytest.mark.parametrize("size", ["1e308", "5e-324", "1"])
def test_a_quaternion_of_any_length_is_a_turn(size):
    text = one_joint(f'<origin quat_xyzw="{size} {size} {size} {size}"/>{LIMIT}')
    turned = urdf.read_text(text.replace('name="r"', 'name="r" version="1.1"'))
    third = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    np.testing.assert_allclose(turned.joints[0].origin[:3, :3], third, rtol=0, atol=1e-15)


@given(st.lists(st.floats(-2, 2), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1))
@example([0.0, 0.0, 3.6669690912645006e-156, -1.0])  # whose squares are 0 or have few digits
@example([3.6669690912645006e-156, 0.0, 0.0, 2.0])
def test_a_quaternion_turns_an_origin_where_the_robot_says_version_1_1(quaternion):
    values = " ".join(map(repr, quaternion))
    text = one_joint(f'<origin xyz="1 2 3" quat_xyzw="{values}"/>{LIMIT}')
    for version in ("1.1", "1.2"):
        said = text.replace('<robot name="r"', f'<robot name="r" version="{version}"')
        T = urdf.read_text(said).joints[0].origin
        assert T[:3, 3].tolist() == [1, 2, 3]
        np.testing.assert_allclose(
            T[:3, :3], Rotation.from_quat(quaternion).as_matrix(), rtol=0, atol=2e-15
        )


@pytest.mark.parametrize("version", ["", ' version="1.0"', ' version="1.0.0"', ' version="abc"'])
def test_a_quaternion_that_nobody_reads_is_told(version):
    text = one_joint(f'<origin quat_xyzw="0 0 1 0"/>{LIMIT}').replace(
        'name="r"', f'name="r"{version}'
    )
    words = (
        r"""^f:4: joint 'j': <origin>: quat_xyzw is not read: it needs <robot version="1\.1">$"""
    )
    with pytest.warns(PoekinWarning, match=words):
        robot = urdf.read_text(text, "f")
    assert (robot.joints[0].origin == np.eye(4)).all()


KNOWN = [
    ('velocity="2.5"', (2.5, math.inf)),
    ('velocity="9999.5" effort="1e7"', (9999.5, 1e7)),
    ('effort="87"', (math.inf, 87)),
    ('velocity="0" effort="0"', (math.inf, math.inf)),
    ('velocity="-1" effort="-3"', (math.inf, math.inf)),
    ('velocity="10000" effort="inf"', (math.inf, math.inf)),
    ('effort="1e16"', (math.inf, math.inf)),
    ('effort="9.9e15"', (math.inf, 9.9e15)),
    ("", (math.inf, math.inf)),
]


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "continuous", "fixed"])
@pytest.mark.parametrize("written, known", KNOWN)
def test_velocity_and_effort_are_read_where_they_are_known(kind, written, known):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (joint,) = read(f'<limit lower="-1" upper="1" {written}/>', kind).joints
    assert (joint.velocity, joint.effort) == known


@pytest.mark.parametrize(
    "written, losses",
    [
        ('<dynamics damping="0.5" friction="0.25"/>', (0.5, 0.25)),
        ('<dynamics friction="0.25"/>', (0, 0.25)),
        ('<dynamics damping="-1"/>', (0, 0)),
        ("<dynamics/>", (0, 0)),
        ("", (0, 0)),
    ],
)
def test_damping_and_friction_are_read(written, losses):
    (joint,) = read(LIMIT + written).joints
    assert (joint.damping, joint.friction) == losses


def test_a_safety_controller_is_read():
    whole = 'k_velocity="40" k_position="100" soft_lower_limit="-2.8" soft_upper_limit="2.7"'
    for written, expected in (
        (f"<safety_controller {whole}/>", SafetyController(40, 100, -2.8, 2.7)),
        ('<safety_controller k_velocity="10"/>', SafetyController(10, 0, 0, 0)),
        ("", None),
    ):
        (joint,) = read(LIMIT + written).joints
        assert joint.safety_controller == expected


@pytest.mark.parametrize(
    "first, second",
    [
        ('<dynamics damping="1"/>', '<dynamics damping="2"/>'),
        ('<safety_controller k_velocity="1"/>', '<safety_controller k_velocity="2"/>'),
    ],
)
def test_of_two_elements_of_a_drive_the_first_counts(first, second):
    with pytest.warns(PoekinWarning, match=r"stands there once more, and the first one counts$"):
        both = read(LIMIT + first + second)
    assert both == read(LIMIT + first)


def test_the_velocity_limits_of_a_chain_are_those_of_its_file():
    text = chain_of(
        '<limit velocity="3"/>', "", '<limit velocity="1"/><mimic joint="j0" multiplier="-2"/>'
    )
    chain = urdf.read_text(text, "x.urdf").chain()
    assert chain.q_names == ("j0", "j1")
    assert chain.velocity_limits.tolist() == [0.5, math.inf]
    back = urdf.read_text(text, "x.urdf").chain(base="l3", tip="l1")
    assert back.velocity_limits.tolist() == [0.5, math.inf]


def test_a_continuous_joint_has_no_limits_and_no_warning():
    for limit in ("", '<limit lower="0" upper="0"/>', '<limit lower="1" upper="-1"/>'):
        assert read(limit, "continuous").limits.tolist() == [[-INF, INF]]


def test_mimic_joints_follow_their_masters():
    both, slope, shift = 'multiplier="-2" offset="0.5"', 'multiplier="3"', 'offset="0.25"'
    followers = [
        f'<mimic joint="j{k}" {rest}/>' for k, rest in ((1, both), (0, slope), (1, shift), (1, ""))
    ]
    chain = urdf.read_text(chain_of(followers[0], "", *followers[1:])).chain()
    assert chain.q_names == ("j1",)
    assert chain.coupling.tolist() == [[-2], [1], [-6], [1], [1]]
    assert chain.offset.tolist() == [0.5, 0, 1.5, 0.25, 0]


def test_a_mimic_of_a_missing_joint_stays_independent_with_a_warning():
    text = chain_of('<mimic joint="gone"/>', "", '<mimic joint="j0"/>', '<mimic joint="lost"/>')
    message = r"^f:2: joint 'j0' mimics 'gone', which does not exist, and stays independent \(.* 2; .* on line 5\)$"
    with pytest.warns(PoekinWarning, match=message):
        robot = urdf.read_text(text, "f")
    assert robot.q_names == ("j0", "j1", "j3")


def test_joints_may_come_in_any_order_and_before_links():
    text = """<robot name="r"><joint name="low" type="fixed"><child link="c"/><parent link="b"/></joint>
    <link name="c"/><link name="b"/>
    <joint name="high" type="fixed"><parent link="a"/><child link="b"/></joint><link name="a"/></robot>"""
    robot = urdf.read_text(text)
    assert (robot.root, robot.leaves) == ("a", ("c",))
    assert [joint.name for joint in robot.joints] == ["low", "high"]


def test_only_the_robots_own_links_and_joints_count():
    extra = """<material name="m"/><transmission name="t"><joint name="j"><hardwareInterface/></joint></transmission>
    <gazebo reference="a"><link name="z"/><joint name="y" type="ball"/></gazebo><!-- <link name="c"/> -->
    <?xml-stylesheet href="x"?><ros2_control><joint name="j"/></ros2_control>
    <x:link xmlns:x="http://example.invalid/x" name="v"/>
    <visual><geometry><mesh filename="/nowhere"/></geometry></visual>"""
    robot = urdf.read_text(one_joint().replace("</robot>", extra + "</robot>"))
    assert robot == urdf.read_text(one_joint())


def test_a_namespace_of_the_whole_file_is_accepted():
    assert (
        urdf.read_text(
            one_joint().replace("<robot", '<robot xmlns="http://example.invalid/urdf"')
        ).dof
        == 1
    )


def test_a_robot_without_a_name_is_called_after_its_file(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(one_joint().replace(' name="r"', ""), encoding="utf-8")
    assert urdf.read(path).name == "arm"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32", "iso-8859-1"])
def test_any_encoding_that_the_file_declares_is_read(tmp_path, encoding):
    path = tmp_path / "x.urdf"
    declared = encoding.removesuffix("-sig")
    text = f'<?xml version="1.0" encoding="{declared}"?>\n' + one_joint().replace('"a"', '"é"')
    path.write_bytes(text.encode(encoding))
    assert urdf.read(path).root == "é"
    assert (
        urdf.read_text(text).root == "é"
    )  # text that is decoded already, whatever its first line says


def test_a_robot_knows_where_it_was_read_from():
    source = urdf.read_text(chain_of("", "", ""), "f").source
    assert source is not None
    assert (source.name, source.link_lines, source.joint_lines) == ("f", (1, 1, 1, 1), (2, 3, 4))


def test_a_chain_of_twenty_thousand_links_is_read():
    count = 20_000
    parts = [f'<link name="l{i}"/>' for i in range(count)]
    parts += [
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/><child link="l{i + 1}"/><origin xyz="0 0 1e-3"/></joint>'
        for i in range(count - 1)
    ]
    np.random.default_rng(0).shuffle(parts)
    robot = urdf.read_text("<robot>" + "\n".join(parts) + "</robot>")
    assert (robot.root, robot.leaves) == ("l0", (f"l{count - 1}",))
    assert abs(robot.chain().home[2, 3] - (count - 1) * 1e-3) <= 1e-9
