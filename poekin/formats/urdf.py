"""URDF in, Robot out: only the text counts, no mesh, no ROS, no xacro.

Source: the URDF specification (elements <robot>, <link>, <joint>). Where files depart from it, as
real ones do:
- a missing <axis> is (1, 0, 0), but one that is there must have xyz; an axis that is not of unit
  length is normalised, with a warning above 1e-6;
- limits that are missing, equal, infinite or absurd (1e4 and more) mean "unlimited", with one
  warning for the file. A bound that is missing alone is unlimited on its side. Continuous joints
  have no limits;
- a joint that mimics one that does not exist stays independent, with a warning;
- only direct children of <robot> count: what <gazebo>, <transmission> and elements of other
  namespaces hold does not.
"""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any, NamedTuple, cast

from ..errors import ModelError, quote
from ..model.checks import LONGEST
from ..model.joint import FREE, KINDS, MOVING, Joint, JointKind, Mimic
from ..model.provenance import Source, warn
from ..model.robot import Robot
from . import rpy
from .common.limits import ABSURD, UNBOUNDED, Interval, without_absurd
from .text import xml
from .text.atomic_write import FilePath
from .text.xml_reader import Fields

# An axis this far off unit length is a slip of the pen, not rounding.
AXIS_TOLERANCE = 1e-6
URDF_KINDS = tuple(kind for kind in KINDS if kind != "helical")
_ZERO = (0.0, 0.0, 0.0)


class Repair(NamedTuple):
    """Repair of a joint: the line, the words for it, and the size of the fault."""

    line: int
    text: str
    size: float = 0.0


class Repairs(NamedTuple):
    """The repairs of one file, by kind: one warning each."""

    axes: list[Repair]
    limits: list[Repair]
    mimics: list[Repair]


def read(path: FilePath) -> Robot:
    """The robot in a URDF file.

    Raises: FileError for a file that cannot be read, is empty, a directory or larger than 64 MiB;
    ModelError, with file and line, for everything in it that cannot be understood. Warns:
    PoekinWarning with file and line for what was repaired (see the top of this module).
    Accuracy: origins to rounding, rotations orthonormal to 1e-15.
    """
    return read_text(xml.read_bytes(path), os.fsdecode(path), os.path.abspath(os.fsdecode(path)))


def read_text(text: str | bytes, name: str = "<text>", origin: str = "") -> Robot:
    """The robot in the text of a URDF; `name` stands for the file in messages; origin as in
    `Source`.

    Raises and warns as `read`; InputError where text is neither str nor bytes, or name no str.
    """
    root = xml.parse(text, name)
    source = Source(name)
    top = Fields(root, source)
    if top.tag != "robot":
        raise ModelError(
            f"{source.place(top.line)}: expected the root element <robot>, got {quote(top.tag)}"
        )
    for element in root:
        if "xacro" in element.tag:
            what = f"<xacro:{Fields(element, source).tag}> is xacro that was not processed yet, which may hold joints"
            raise ModelError(
                f"{source.place(element.sourceline)}: {what}: pk.xacro(path) evaluates it, and --xacro"
            )
    links = top.all("link")
    if not links:
        raise top.fault("expected at least one <link>, there is none")
    repairs = Repairs([], [], [])
    elements = top.all("joint")
    joints = [_joint(fields, repairs) for fields in elements]
    known = {joint.name for joint in joints}
    joints = [
        _with_known_master(joint, fields, known, repairs)
        for joint, fields in zip(joints, elements, strict=True)
    ]
    lines = Source(
        name,
        tuple(link.line for link in links),
        tuple(fields.line for fields in elements),
        origin,
    )
    stem = os.path.splitext(os.path.basename(name))[0]
    robot = Robot(root.get("name") or stem, [link.name("name") for link in links], joints, lines)
    _warn(repairs, source)
    return robot


def _joint(fields: Fields, repairs: Repairs) -> Joint:
    name = fields.name("name")
    kind = fields.name("type")
    if kind not in URDF_KINDS:
        raise fields.fault(f"type must be one of {', '.join(URDF_KINDS)}, got {quote(kind)}")
    ends = []
    for role in ("parent", "child"):
        end = fields.child(role)
        if end is None:
            raise fields.fault(f'expected an element <{role} link="..."/>, there is none')
        ends.append(end.name("link"))
    origin = fields.child("origin")
    pose = rpy.pose(_ZERO, _ZERO)
    if origin:
        xyz = origin.vector("xyz") or _ZERO
        angles = origin.vector("rpy") or _ZERO
        if max(map(abs, xyz)) > LONGEST:
            raise origin.fault(f"xyz: expected lengths of at most {LONGEST:g} m, got {xyz}")
        pose = rpy.pose(xyz, angles)
    moving: dict[str, Any] = {}
    if kind in MOVING or kind == "planar":
        moving["axis"] = _axis(fields, repairs)
    if kind in ("revolute", "prismatic"):
        moving["limits"] = _limits(fields, name, repairs)
    return Joint(
        name,
        cast("JointKind", kind),
        ends[0],
        ends[1],
        pose,
        mimic=_mimic(fields, kind),
        **moving,
    )


def _axis(fields: Fields, repairs: Repairs) -> tuple[float, float, float]:
    element = fields.child("axis")
    if element is None:
        return 1.0, 0.0, 0.0
    axis = element.vector("xyz")
    if axis is None:
        raise element.fault('expected an attribute xyz="...", there is none')
    if not any(axis):
        raise element.fault("xyz must not be zero")
    length = math.hypot(*axis)
    if abs(length - 1.0) > AXIS_TOLERANCE:
        text = f"the axis of {fields.what} has length {length:.9g} and was normalised"
        repairs.axes.append(Repair(element.line, text, abs(length - 1.0)))
    return axis


def _limits(fields: Fields, name: str, repairs: Repairs) -> Interval:
    element = fields.child("limit")
    if element is None:
        repairs.limits.append(Repair(fields.line, f"{quote(name)} (none; line {fields.line})"))
        return UNBOUNDED
    lower = element.number("lower", finite=False)
    upper = element.number("upper", finite=False)
    if lower is not None and upper is not None and lower > upper:
        raise element.fault(
            f"lower must not be above upper, got lower = {lower!r}, upper = {upper!r}"
        )
    reason = _unusable(lower, upper)
    if reason:
        line = element.line
        repairs.limits.append(Repair(line, f"{quote(name)} ({reason}; line {line})"))
    if lower == upper:
        return UNBOUNDED
    return without_absurd(lower, upper)


def _unusable(lower: float | None, upper: float | None) -> str:
    """Reason why limits do not bound a joint on both sides; none where they do."""
    if lower is None and upper is None:
        return "none"
    if lower is None:
        return "no lower bound"
    if upper is None:
        return "no upper bound"
    if lower == upper:
        return f"equal, {lower!r}"
    if max(abs(lower), abs(upper)) >= ABSURD:
        return f"{lower!r} to {upper!r}"
    return ""


def _mimic(fields: Fields, kind: str) -> Mimic | None:
    element = fields.child("mimic")
    if element is None:
        return None
    if kind in FREE:
        raise element.fault(f"a {kind} joint has no single value and cannot mimic another joint")
    given = {key: element.number(key) for key in ("multiplier", "offset")}
    numbers = {key: value for key, value in given.items() if value is not None}
    return Mimic(element.name("joint"), **numbers)


def _with_known_master(joint: Joint, fields: Fields, known: set[str], repairs: Repairs) -> Joint:
    if joint.mimic is None or joint.mimic.joint in known:
        return joint
    element = fields.child("mimic") or fields
    text = f"{fields.what} mimics {quote(joint.mimic.joint)}, which does not exist"
    repairs.mimics.append(Repair(element.line, text))
    return replace(joint, mimic=None)


def _warn(repairs: Repairs, source: Source) -> None:
    if repairs.axes:
        worst = max(repairs.axes, key=lambda repair: repair.size)
        warn(
            f"{source.place(worst.line)}: {worst.text}{_others(repairs.axes, worst, 'the worst of')}"
        )
    if repairs.mimics:
        first = repairs.mimics[0]
        others = _others(repairs.mimics, first, "the first of")
        warn(f"{source.place(first.line)}: {first.text}, and stays independent{others}")
    if repairs.limits:
        joints = ", ".join(repair.text for repair in repairs.limits[:4])
        if len(repairs.limits) > 4:
            joints += f" and {len(repairs.limits) - 4} more"
        place = source.place(repairs.limits[0].line)
        warn(f"{place}: joints without usable limits are taken as unlimited: {joints}")


def _others(repairs: list[Repair], named: Repair, rank: str) -> str:
    lines = [str(repair.line) for repair in repairs if repair is not named]
    if not lines:
        return ""
    if len(lines) > 10:
        lines[10:] = ["..."]
    return f" ({rank} {len(repairs)}; the others on line {', '.join(lines)})"
