"""What emitted texts say about an arm: sizes, units, limits, frames, angles, and names that cannot
end a comment.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.formats.emit import messages
from poekin.formats.emit.messages import (
    angle_lines,
    header_lines,
    make_tasks,
    quote_ascii,
    robot_lines,
)
from poekin.formats.emit.statements import by_outputs
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

from .emitted import arm

LIMITS = [[-1, 2.5], [-np.inf, np.inf], [0.12345678, np.inf]]
CRANE = pk.Chain.from_space(
    [[0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 1], [0, 0, 1, 0, -2, 0]],
    np.eye(4),
    limits=LIMITS,
    joint_names=["a", "b", "c"],
    base="w",
    tip="t",
)


def test_the_arm_is_told_line_by_line():
    assert header_lines(CRANE.compile(), "space") == [
        "Base frame 'w', tip frame 't'; 3 joints, 3 coordinates. Units: rad, m.",
        "",
        "  q[0]  rad  'a', -1 ... 2.5",
        "  q[1]  m  'b'",
        "  q[2]  rad  'c', 0.123457 ... inf",
        "",
        "T = (R, p; 0, 1), 4 x 4 row by row: the pose of the tip in the base frame; p in m.",
        "J, 6 x 3 row by row: V = J dq. Rows omega x, y, z (rad/s), then v x, y, z (m/s), per unit of dq.",
        "J is the space Jacobian: axes of the base, v of the tip's point that passes the origin of the base.",
    ]
    none, one = (
        header_lines(arm("no joint").compile(), "body"),
        header_lines(arm("one joint").compile(), "body"),
    )
    assert none[0] == "Base frame 'base', tip frame 'tool'; 0 joints, 0 coordinates. Units: rad, m."
    assert none[1:3] == ["", one[4]]
    assert one[0] == "Base frame 'base', tip frame 'tool'; 1 joint, 1 coordinate. Units: rad, m."
    assert one[1:4] == ["", "  q[0]  rad  'joint1'", ""]


def test_a_robot_is_told_line_by_line():
    joints = [
        pk.Joint("lift", "prismatic", "w", "a", limits=(0, 0.5)),
        pk.Joint("turn", "revolute", "a", "b"),
        pk.Joint("free", "floating", "w", "c"),
    ]
    robot = pk.Robot("crane", ["w", "a", "b", "c"], joints)
    lines = robot_lines(robot)
    assert lines == [
        "Robot 'crane': 4 links, 2 coordinates. Units: rad, m.",
        "",
        "  q[0]  m  'lift', 0 ... 0.5",
        "  q[1]  rad  'turn'",
        "",
        "T, 4 x 4 x 4 row by row: (R, p; 0, 1), the poses of the links in the frame of",
        "'w'; p in m. Floating and planar joints are at their zero pose.",
        "  T[0]  'w'",
        "  T[16]  'a'",
        "  T[32]  'b'",
        "  T[48]  'c'",
    ]
    assert robot_lines(robot.coupled("turn = turn + lift"))[4:7] == [
        "",
        "Joints that follow sums of coordinates:",
        "  'turn = lift + turn'",
    ]


@pytest.mark.parametrize("frame, says", [
    ("body", ["J is the body Jacobian: axes of the tip, v of the origin of the tip."]),
    ("hybrid", ["J is the hybrid Jacobian: axes of the base, v of the origin of the tip."]),
    (2, ["J is the Jacobian in a frame that moves with joint 2 (counted from 0), 'c', and",
         "has its z axis along that joint's: axes of that frame, v of the tip's point that passes its origin.",
         "The frame's pose in the base frame at q = 0, (R, p):",
         "   1   0   0   2", "   0   1   0   0", "   0   0   1   0"]),
])  # fmt: skip
def test_the_frame_of_the_jacobian_is_told(frame, says):
    assert header_lines(CRANE.compile(), frame)[8:] == says


def test_angles_are_sums_of_a_base_coordinates_and_an_offset():
    coupled = make_tasks(arm("coupled").compile(), "body")
    assert angle_lines(coupled[0]) == [
        "x[0] = q[0] + 0.626388",
        "x[1] = 2 q[0] + -1 q[1] + 0.0267391",
    ]
    assert [task.name for task in coupled] == ["fk", "jacobian_body", "fk_jacobian_body"]
    assert [(task.poses, task.jacobian) for task in coupled] == [
        (1, False),
        (0, True),
        (1, True),
    ]
    assert [task.sizes for task in coupled] == [
        {"T": 16, "J": 0},
        {"T": 0, "J": 12},
        {"T": 16, "J": 12},
    ]
    assert [task.name for task in make_tasks(CRANE.compile(), 1)] == [
        "fk",
        "jacobian_joint1",
        "fk_jacobian_joint1",
    ]
    ur = make_tasks(pk.load("ur5e").chain().compile(), "body")[0]
    assert angle_lines(ur)[4:] == ["x[4] = q[1] + q[2]", "x[5] = x[4] + q[3]"]


def test_a_name_is_cut_after_eighty_characters_and_cannot_end_a_comment():
    assert quote_ascii("x" * 80) == f"'{'x' * 80}'"
    assert quote_ascii("x" * 81) == f"'{'x' * 77}...'"
    assert quote_ascii("a b_~!<*?\\\"'`\n\u00fc") == (
        "'a b_~!<U+003C><U+002A><U+003F><U+005C><U+0022><U+0027><U+0060><U+000A><U+00FC>'"
    )


def test_the_pose_is_written_row_by_row_and_the_jacobian_after_it():
    outputs = list("abcdefghijklmn")
    last_row = [0.0, 0.0, 0.0, 1.0]
    assert by_outputs(outputs, 1) == ([*"abcjdefkghil", *last_row], ["m", "n"])
    assert by_outputs(outputs, 0) == ([], outputs)
    two = [*"abcjdefkghil", *last_row, *"ABCJDEFKGHIL", *last_row]
    assert by_outputs(list("abcdefghijklABCDEFGHIJKL"), 2) == (two, [])


def test_the_cheapest_frame_has_its_pose_in_the_frame_of_its_joint():
    fast = arm("panda").compile()
    k, T = messages.jacobian_frame(fast, "cheapest")
    assert k == fast.cheapest.joint
    np.testing.assert_array_equal(T, fast.cheapest.T_km)
    k, T = messages.jacobian_frame(fast, 3)
    assert k == 3
    np.testing.assert_array_equal(T, np.eye(4))


def test_a_program_of_vectors_says_what_it_allows_and_how_it_ends():
    program = pk.emit.c(arm("one joint"), "body", name="a").selftest
    (allowed,) = re.findall(r"#define ALLOWED (\S+)", program)
    said = " ".join(program.partition("*/")[0].replace("\n *", " ").split())
    assert f"allowed, which is {allowed} (1, m or m per rad), and exits with 0 if that is" in said
    assert "if that is kept, else with 1." in said


@pytest.mark.parametrize("kind", dataclasses_of("poekin.formats.emit", "messages statements c"))
def test_what_is_emitted_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
