"""Comments of the emitted texts; names out of files stand in comments only, and cannot end one."""

from __future__ import annotations

import math
import re
import string
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...checks import choice
from ...engine.straight_line.program import Program
from ...errors import InputError, safe_repr
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, compiled
from ...model.kinematics.compiled import CompiledChain
from ...model.kinematics.pose_jacobian import FRAME_NAMES, AnyFrame
from ...model.readings.coupled import own_readings
from ...model.readings.statements import make_statements
from ...model.robot import Robot
from ...version import __version__

_PLAIN = set(string.ascii_letters + string.digits + string.punctuation + " ") - set("*?\\\"'`<")
_LONGEST = 80


def identifier(name: str) -> str:
    """Identifier of C and C++ made from a name: a ... z, 0 ... 9 and single _, at most 40. Raises: InputError."""
    if not isinstance(name, str):
        raise InputError(f"name: expected a text, got {safe_repr(name)}")
    word = re.sub("[^a-z0-9]+", "_", name.lower()).strip("_")[:40].strip("_")
    if not word[:1].isalpha():
        word = f"arm_{word}".strip("_")
    return word


def quote_ascii(name: str) -> str:
    """Name in ASCII for a comment of C, a docstring, or a script of a page; a character that could end
    one as <U+002A>.
    """
    if len(name) > _LONGEST:
        name = name[: _LONGEST - 3] + "..."
    return f"'{_plain(name)}'"


def _plain(text: str) -> str:
    return "".join(c if c in _PLAIN else f"<U+{ord(c):04X}>" for c in text)


def made_by(origin: str) -> list[str]:
    """Lines on the version of poekin, and where the arm is from."""
    if not isinstance(origin, str):
        raise InputError(f"origin: expected a text, got {safe_repr(origin)}")
    words = f"Made by poekin {__version__}"
    if origin:
        words += f" from {origin}"
    return textwrap.wrap(_plain(words), 110)


@dataclass(frozen=True)
class EmittedFunction:
    """One function to write: its name, its program, how many poses it writes, and whether a
    Jacobian, or what else stands in its place, of so many rows.
    """

    name: str
    poses: int
    jacobian: bool
    program: Program
    rows: int = 6

    @property
    def cost(self) -> str:
        """Operations of the program, in words."""
        count = self.program.count
        return (
            f"{self.name}: {count.multiplications} multiplications, {count.additions} additions or subtractions, "
            f"{count.sines} pairs of sine and cosine"
        )

    @property
    def results(self) -> list[str]:
        """Arrays that the function writes, of "T" and "J"."""
        return ["T"] * bool(self.poses) + ["J"] * self.jacobian

    @property
    def sizes(self) -> dict[str, int]:
        """Numbers of the arrays T and J."""
        return {"T": 16 * self.poses, "J": len(self.program.outputs) - 12 * self.poses}

    @property
    def columns(self) -> int:
        """Numbers of a row of J."""
        return self.sizes["J"] // self.rows

    @property
    def arguments(self) -> str:
        """The arrays behind the other arguments of a call."""
        return "".join(f", {result}" for result in self.results)


def compile_checked(chain: Arm, frame: AnyFrame) -> CompiledChain:
    """The chain with its programs. Raises: InputError where the frame is neither a name nor a number."""
    fast = compiled(chain)
    if not isinstance(frame, (str, int, np.integer)):
        choice(frame, (*FRAME_NAMES, "cheapest"), "frame", " (or the index of a joint)")
    return fast


def make_tasks(
    arm: CompiledChain, frame: AnyFrame
) -> tuple[EmittedFunction, EmittedFunction, EmittedFunction]:
    """Pose, Jacobian, and both in one pass. Raises: InputError, UnknownName for a frame that there is not."""
    which = frame
    if not isinstance(frame, str):
        which = f"joint{int(frame)}"
    return (
        EmittedFunction("fk", 1, False, arm.program(None)),
        EmittedFunction(f"jacobian_{which}", 0, True, arm.program(frame)),
        EmittedFunction(f"fk_jacobian_{which}", 1, True, arm.program(frame, pose=True)),
    )


def header_lines(arm: CompiledChain, frame: AnyFrame) -> list[str]:
    """Lines about the arm, its coordinates, its frames and the layout of the arrays."""
    chain = arm.chain
    lines = [
        f"Base frame {quote_ascii(chain.base)}, tip frame {quote_ascii(chain.tip)};"
        f" {_many(len(chain.kinds), 'joint')}, {_many(chain.dof, 'coordinate')}. Units: rad, m.",
        "",
        *coordinate_lines(chain),
        *_readings(chain),
        *[""] * bool(chain.dof),
        "T = (R, p; 0, 1), 4 x 4 row by row: the pose of the tip in the base frame; p in m.",
        f"J, 6 x {chain.dof} row by row: V = J dq. Rows omega x, y, z (rad/s), then v x, y, z (m/s), per unit of dq.",
    ]
    return [*lines, *_frame(arm, frame)]


def robot_lines(robot: Robot) -> list[str]:
    """Lines about a robot, its coordinates, and the layout of the poses of its links."""
    kinds = {joint.name: joint.kind for joint in robot.joints}
    return [
        f"Robot {quote_ascii(robot.name)}: {_many(len(robot.links), 'link')},"
        f" {_many(robot.dof, 'coordinate')}. Units: rad, m.",
        "",
        *(
            _coordinate_line(k, name, kinds[name] != "prismatic", robot.limits[k])
            for k, name in enumerate(robot.q_names)
        ),
        *_coupling_lines(robot.coupling),
        *[""] * bool(robot.dof),
        f"T, {len(robot.links)} x 4 x 4 row by row: (R, p; 0, 1), the poses of the links in the frame of",
        f"{quote_ascii(robot.root)}; p in m. Floating and planar joints are at their zero pose.",
        *(f"  T[{16 * k}]  {quote_ascii(link)}" for k, link in enumerate(robot.links)),
    ]


def _readings(chain: Chain) -> list[str]:
    """Lines on joints that follow several readings."""
    readings = own_readings(chain)
    if readings is None:
        return []
    return _coupling_lines(make_statements(readings, chain.joint_names))


def _coupling_lines(statements: Sequence[str]) -> list[str]:
    """Lines of statements of joints that follow several readings."""
    if not statements:
        return []
    return [
        "",
        "Joints that follow sums of coordinates:",
        *(f"  {quote_ascii(s)}" for s in statements),
    ]


def coordinate_lines(chain: Chain) -> list[str]:
    """Lines on the coordinates of a chain."""
    return [
        _coordinate_line(k, name, chain.is_angle(k), chain.limits[k])
        for k, name in enumerate(chain.q_names)
    ]


def _coordinate_line(k: int, name: str, angle: bool, limits: np.ndarray) -> str:
    """Line on a coordinate: its unit, its name, and its limits where it has any."""
    words = f"  q[{k}]  {'rad' if angle else 'm'}  {quote_ascii(name)}"
    lower, upper = limits
    if math.isfinite(lower) or math.isfinite(upper):
        words += f", {lower:.6g} ... {upper:.6g}"
    return words


def angle_lines(task: EmittedFunction) -> list[str]:
    """Angles whose sines and cosines a function takes, line by line."""
    lines = []
    for j, angle in enumerate(task.program.angles):
        parts = []
        if angle.base is not None:
            parts.append(f"x[{angle.base}]")
        parts += [f"q[{k}]" if f == 1 else f"{f:.6g} q[{k}]" for k, f in angle.terms]
        if angle.offset:
            parts.append(f"{angle.offset:.6g}")
        lines.append(f"x[{j}] = {' + '.join(parts)}")
    return lines


def _frame(arm: CompiledChain, frame: AnyFrame) -> list[str]:
    """The frame of the Jacobian."""
    chain = arm.chain
    if frame == "space":
        return [
            "J is the space Jacobian: axes of the base, v of the tip's point that passes the origin of the base."
        ]
    if frame == "body":
        return ["J is the body Jacobian: axes of the tip, v of the origin of the tip."]
    if frame == "hybrid":
        return ["J is the hybrid Jacobian: axes of the base, v of the origin of the tip."]
    k, T_k = jacobian_frame(arm, frame)
    T = chain.joint_poses(np.zeros(chain.dof))[k] @ T_k
    return [
        f"J is the Jacobian in a frame that moves with joint {k} (counted from 0),"
        f" {quote_ascii(chain.joint_names[k])}, and",
        "has its z axis along that joint's: axes of that frame, v of the tip's point that passes its origin.",
        "The frame's pose in the base frame at q = 0, (R, p):",
        *("  " + "  ".join(f"{x + 0.0: .17g}" for x in row) for row in T[:3].tolist()),
    ]


def jacobian_frame(arm: CompiledChain, frame: AnyFrame) -> tuple[int, np.ndarray]:
    """Joint k with which the frame moves, and its pose in that joint's frame."""
    if frame == "cheapest":
        return arm.cheapest.joint, arm.cheapest.T_km
    return int(frame), np.eye(4)


def _many(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"
