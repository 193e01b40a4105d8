"""URDF in, Robot out: only the text counts, no ROS, no xacro, and no mesh is opened.

Source: the URDF specification (elements <robot>, <link>, <joint>). Where files depart from it, as
real ones do:
- a missing <axis> is (1, 0, 0), but one that is there must have xyz; an axis that is not of unit
  length is normalised, with a warning above 1e-6;
- limits that are missing, equal, infinite, absurd (1e4 and more) or lower above upper mean
  "unlimited", with one warning for the file. A bound that is missing alone is unlimited on its side. Continuous joints
  have no limits;
- a velocity or effort that is missing, 0 or negative is not known, nor is a velocity of 1e4 or an
  effort of 1e16 and more; a number that <dynamics> or <safety_controller> leaves out is 0, as is a
  negative damping;
- of two <axis>, <origin>, <limit>, <dynamics> or <safety_controller> in a joint the first counts,
  with a warning;
- an <origin> may have quat_xyzw in place of rpy where <robot> says version="1.1" or later; before
  that, nobody reads it, and a warning says so;
- a joint that mimics one that does not exist stays independent, with a warning;
- a <mass> of 0 is none; where one is negative or absurd, none of the file is used, with a warning;
- only direct children of <robot> count: what <gazebo>, <transmission> and elements of other
  namespaces hold does not.
"""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any, NamedTuple, cast

import numpy as np

from ..errors import ModelError, quote
from ..formulas.lie import quaternion
from ..groups import se3
from ..groups.arrays import Array
from ..model.checks import LONGEST
from ..model.joint import FREE, KINDS, MOVING, Joint, JointKind, Mimic, SafetyController
from ..model.provenance import Source, warn
from ..model.robot import Robot
from . import rpy
from .common.inertial import link_masses
from .common.limits import (
    ABSURD,
    UNBOUNDED,
    Interval,
    known_effort,
    known_loss,
    known_velocity,
    without_absurd,
)
from .text import xml
from .text.atomic_write import FilePath
from .text.numbers import real
from .text.xml_reader import Fields

# An axis this far off unit length is a slip of the pen, not rounding.
AXIS_TOLERANCE = 1e-6
URDF_KINDS = tuple(kind for kind in KINDS if kind != "helical")
_ZERO = (0.0, 0.0, 0.0)
_OF_CONTROLLERS = ("k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit")


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
    doubles: list[Repair]
    quaternions: list[Repair]
    angles: list[Repair]


def read(path: FilePath) -> Robot:
    """The robot in a URDF file.

    Raises: FileError for a file that cannot be read, is empty, a directory or larger than 64 MiB;
    ModelError, with file and line, for everything in it that cannot be understood. Warns:
    PoekinWarning with file and line for what was repaired (see the top of this module).
    Accuracy: origins to rounding, rotations orthonormal to 1e-15.
    """
    return read_text(xml.read_bytes(path), os.fsdecode(path))


def read_text(
    text: str | bytes,
    name: str = "<text>",
    *,
    tell: bool = True,
) -> Robot:
    """The robot in the text of a URDF; `name` stands for the file in messages; tell, whether to
    warn of repairs.

    Raises and warns as `read`; InputError where text is neither str nor bytes, or name no str.
    """
    root = xml.parse(text, name, tell=tell)
    source = Source(name)
    top = Fields(root, source)
    if top.tag != "robot":
        raise ModelError(
            f"{source.place(top.line)}: expected the root element <robot>, got {quote(top.tag)}"
        )
    for element in root.iter("*"):
        if "xacro" in element.tag:
            what = f"<xacro:{Fields(element, source).tag}> is xacro that was not processed yet, which may hold joints"
            raise ModelError(
                f"{source.place(element.sourceline)}: {what}: pk.xacro(path) evaluates it, and --xacro, "
                "in a file that is not compressed"
            )
    links = top.all("link")
    if not links:
        raise top.fault("expected at least one <link>, there is none")
    repairs = Repairs([], [], [], [], [], [])
    quaternions = reads_quaternions(root.get("version"))
    elements = top.all("joint")
    joints = [_joint(fields, repairs, quaternions) for fields in elements]
    known = {joint.name for joint in joints}
    joints = [
        _with_known_master(joint, fields, known, repairs)
        for joint, fields in zip(joints, elements, strict=True)
    ]
    lines = Source(
        name,
        tuple(link.line for link in links),
        tuple(fields.line for fields in elements),
        text if isinstance(text, str) else bytes(text),
    )
    stem = os.path.splitext(os.path.basename(name))[0]
    names = [link.name("name") for link in links]
    masses = link_masses(links, source, tell)
    robot = Robot(root.get("name") or stem, names, joints, lines, masses=masses)
    if tell:
        _warn(repairs, source)
    return robot


def reads_quaternions(version: str | None) -> bool:
    """Whether quat_xyzw of an <origin> counts, by the version of <robot>."""
    return (real(version or "") or 1.0) >= 1.1


def _joint(fields: Fields, repairs: Repairs, quaternions: bool) -> Joint:
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
    moving: dict[str, Any] = {}
    if kind in MOVING or kind == "planar":
        moving["axis"] = _axis(fields, repairs)
    limit = _first(fields, "limit", repairs)
    if kind in ("revolute", "prismatic"):
        moving["limits"] = _limits(fields, limit, name, repairs)
    if limit is not None:
        moving["velocity"] = known_velocity(limit.number("velocity", finite=False))
        moving["effort"] = known_effort(limit.number("effort", finite=False))
    return Joint(
        name,
        cast("JointKind", kind),
        ends[0],
        ends[1],
        origin_of(_first(fields, "origin", repairs), quaternions, repairs),
        mimic=_mimic(fields, kind),
        safety_controller=_safety_controller(fields, repairs),
        **moving,
        **_dynamics(fields, repairs),
    )


def _first(fields: Fields, tag: str, repairs: Repairs) -> Fields | None:
    """The first child of that tag, which counts; None where there is none."""
    found = fields.children(tag)
    for double in found[1:]:
        text = f"{double.what} stands there once more, and the first one counts"
        repairs.doubles.append(Repair(double.line, text))
    return next(iter(found), None)


def origin_of(
    element: Fields | None,
    quaternions: bool,
    repairs: Repairs | None = None,
) -> Array:
    """Pose of an <origin>, identity where there is none; quaternions, whether quat_xyzw counts."""
    if element is None:
        return np.eye(4)
    xyz = element.vector("xyz") or _ZERO
    if max(map(abs, xyz)) > LONGEST:
        raise element.fault(f"xyz: expected lengths of at most {LONGEST:g} m, got {xyz}")
    turns = element.vector("rpy")
    if repairs is not None and max(map(abs, turns or _ZERO)) > math.tau:
        text = f"{element.what}: rpy is more than a turn: degrees? Expected are rad"
        repairs.angles.append(Repair(element.line, text))
    turn = element.numbers("quat_xyzw", 4)
    if turn is not None and not quaternions:
        turn = None
        if repairs is not None:
            text = f'{element.what}: quat_xyzw is not read: it needs <robot version="1.1">'
            repairs.quaternions.append(Repair(element.line, text))
    if turn is None:
        return rpy.pose(xyz, turns or _ZERO)
    if turns is not None:
        raise element.fault("either rpy or quat_xyzw expected, got both")
    largest = max(map(abs, turn))
    if not largest:
        raise element.fault("quat_xyzw must not be zero")
    x, y, z, w = (part / largest for part in turn)  # whose squares are neither 0 nor infinite
    R = np.reshape(quaternion.rotation(w, x, y, z), (3, 3))
    return se3.pose(R, xyz)


def _axis(fields: Fields, repairs: Repairs) -> tuple[float, float, float]:
    element = _first(fields, "axis", repairs)
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


def _dynamics(fields: Fields, repairs: Repairs) -> dict[str, float]:
    element = _first(fields, "dynamics", repairs)
    if element is None:
        return {}
    return {key: known_loss(element.number(key)) for key in ("damping", "friction")}


def _safety_controller(fields: Fields, repairs: Repairs) -> SafetyController | None:
    element = _first(fields, "safety_controller", repairs)
    if element is None:
        return None
    given = {key: element.number(key) for key in _OF_CONTROLLERS}
    return SafetyController(**{key: value for key, value in given.items() if value is not None})


def _limits(
    fields: Fields,
    element: Fields | None,
    name: str,
    repairs: Repairs,
) -> Interval:
    if element is None:
        repairs.limits.append(Repair(fields.line, f"{quote(name)} (none; line {fields.line})"))
        return UNBOUNDED
    lower = element.number("lower", finite=False)
    upper = element.number("upper", finite=False)
    reason = _unusable(lower, upper)
    if reason:
        line = element.line
        repairs.limits.append(Repair(line, f"{quote(name)} ({reason}; line {line})"))
    if lower is not None and upper is not None and lower >= upper:
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
    if lower > upper:
        return f"lower {lower!r} above upper {upper!r}"
    if max(abs(lower), abs(upper)) >= ABSURD:
        return f"{lower!r} to {upper!r}"
    return ""


def _mimic(fields: Fields, kind: str) -> Mimic | None:
    """A <mimic> as data, which `model/tree/coupling.py` composes and `chain_between` puts in C."""
    element = fields.child("mimic")
    if element is None:
        return None
    if kind in FREE:
        raise element.fault(f"a {kind} joint has no single value and cannot mimic another joint")
    given = {key: element.number(key) for key in ("multiplier", "offset")}
    numbers = {key: value for key, value in given.items() if value is not None}
    return Mimic(element.name("joint"), **numbers)


def _with_known_master(
    joint: Joint,
    fields: Fields,
    known: set[str],
    repairs: Repairs,
) -> Joint:
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
    for found, end in (
        (repairs.mimics, ", and stays independent"),
        (repairs.doubles, ""),
        (repairs.quaternions, ""),
        (repairs.angles, ""),
    ):
        if found:
            first = found[0]
            others = _others(found, first, "the first of")
            warn(f"{source.place(first.line)}: {first.text}{end}{others}")
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
