"""What emitted texts say about an arm: sizes, units, limits, frames, angles, and names that cannot
end a comment.
"""

from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

import poekin as pk
from poekin.engine.straight_line.program import Angle
from poekin.errors import InputError
from poekin.formats.emit import messages
from poekin.formats.emit.messages import (
    angle_lines,
    header_lines,
    made_by,
    make_tasks,
    quote_ascii,
    robot_lines,
)
from poekin.formats.emit.python import stack
from poekin.formats.emit.statements import by_outputs, double, single, statements
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
        pk.Joint("wheel", "continuous", "b", "d"),
    ]
    robot = pk.Robot("crane", ["w", "a", "b", "c", "d"], joints)
    lines = robot_lines(robot)
    assert lines == [
        "Robot 'crane': 5 links, 3 coordinates. Units: rad, m.",
        "",
        "  q[0]  m  'lift', 0 ... 0.5",
        "  q[1]  rad  'turn'",
        "  q[2]  rad  'wheel'",
        "",
        "T, 5 x 4 x 4 row by row: (R, p; 0, 1), the poses of the links in the frame of",
        "'w'; p in m. Floating and planar joints are at their zero pose.",
        "  T[0]  'w'",
        "  T[16]  'a'",
        "  T[32]  'b'",
        "  T[48]  'c'",
        "  T[64]  'd'",
    ]
    assert robot_lines(robot.coupled("turn = turn + lift"))[5:8] == [
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


def test_where_an_arm_is_from_is_wrapped_at_110_characters():
    # 37 k - 1 is 110 for three words; 28 k - 1 is 111 for four
    for word, count in (("x" * 36, 3), ("x" * 27, 3)):
        first, *rest = made_by(" ".join([word] * 12))
        assert first.startswith(f"Made by poekin {pk.__version__} from {word}")
        assert rest[0] == " ".join([word] * count)
    assert made_by("") == [f"Made by poekin {pk.__version__}"]


def test_a_stack_has_as_many_parts_on_a_line_as_110_characters_hold_and_breaks_none():
    rng = np.random.default_rng(0)
    parts = ["x" * size for size in rng.integers(1, 9, 2000)]
    head, *lines, end = stack("T =", parts)
    assert (head, end) == ("    T = xp.stack([", "    ], -1)")
    assert " ".join(line.removeprefix(" " * 8) for line in lines) == ", ".join(parts)
    assert max(map(len, lines)) == 110
    room = [110 - len(line) for line in lines[:-1]]
    needed = [1 + len(line.split()[0]) for line in lines[1:]]
    assert min(n - r for n, r in zip(needed, room, strict=True)) == 1
    odd = ["x" * 120, *["left-right"] * 20]
    assert " ".join(stack("T =", odd)[1:-1]).replace(",", "").split() == odd


def steps_of(*nodes: tuple, outputs=(), angles=()):
    """Statements of a program made of these nodes by hand."""
    steps = [(k, Made(*node)) for k, node in enumerate(nodes)]
    program: Any = SimpleNamespace(steps=steps, outputs=outputs, angles=angles)
    return statements(program, double)


class Made(NamedTuple):
    """A node as the writer of statements sees it."""

    kind: str
    first: float
    second: int = -1
    sign: int = 1


def test_each_kind_of_node_is_a_statement_and_each_output_has_its_sign():
    found = steps_of(
        ("input", 0), ("input", 3), ("input", -1), ("input", -12), ("constant", 0.5),
        ("product", 0, 1), ("sum", 5, 2), ("sum", 5, 3, -1), ("scaled", -2.5, 6),
        ("reciprocal", 0, 8), ("product", 9, 9),
        outputs=[(10, 1), (7, -1), (4, -1), (4, 1), (None, 0.75)],
    )  # fmt: skip
    assert found.reads == (("c1", "c", 1), ("q0", "q", 0), ("q11", "q", 11), ("s0", "s", 0))
    assert found.lines == (
        ("v0", "s0 * c1"), ("v1", "v0 + q0"), ("v2", "v0 - q11"), ("v3", "-2.5 * v1"),
        ("v4", "1.0 / v3"), ("v5", "v4 * v4"),
    )  # fmt: skip
    assert found.outputs == ("v5", "-v2", -0.5, 0.5, 0.75)
    many = steps_of(*(("input", -1 - k) for k in (10, 2, 0, 9)))
    assert [name for name, _, _ in many.reads] == ["q0", "q2", "q9", "q10"]


def test_an_angle_is_a_sum_with_the_factors_that_are_not_one():
    angles = [
        Angle(None, ((3, 1.0), (10, -1.0)), 0.0),
        Angle(None, ((2, 0.25), (4, -0.5), (5, -3.0)), 0.5),
        Angle(1, ((0, 2.0),), -0.125),
    ]
    found = steps_of(angles=angles)
    assert found.angles == (
        "q3 - q10",
        "0.25 * q2 - 0.5 * q4 - 3.0 * q5 + 0.5",
        "x1 + 2.0 * q0 + -0.125",
    )
    assert [k for _, _, k in found.angle_reads] == [0, 2, 3, 4, 5, 10]
    assert found.angle_reads[-1] == ("q10", "q", 10)


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan, 1e39])
def test_a_number_that_a_precision_cannot_hold_is_refused_by_its_name(value):
    for write, words in ((double, "double"), (single, "single")):
        if write is double and value == 1e39:
            assert write(value) == "1e+39"
            continue
        with pytest.raises(InputError) as caught:
            write(value)
        assert str(caught.value) == (
            f"emit: the arm needs the number {value!r}, which {words} precision cannot hold"
        )
    assert (single(0.1), double(0.1)) == ("0.1f", "0.1")


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
