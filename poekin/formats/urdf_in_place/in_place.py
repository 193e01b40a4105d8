"""A robot put into the text of a URDF: what moved is changed, and the result is read again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from ...errors import InputError, ModelError, escape_unprintable, join_names, quote
from ...groups.arrays import Array
from ...groups.vectors import norm, rotation_part, translation_part
from ...model.joint import MOVING, Joint
from ...model.provenance import Source
from ...model.robot import Robot
from .. import rpy, urdf
from ..common.xml_attribute import quote_attribute
from ..text.numbers import shortest
from .edits import Edit, JointText, Still, apply_edits, edits_of
from .encoding import decode
from .spans import Spans, find, indent_before

STILL = 2e-15
"""Change [rad, and in the robot's size] that rounding makes of a joint that did not move."""
EXACT = 1e-13
"""Largest error [rad, and in the robot's size] of a link's pose in the text that is written."""
_EDITED = ("name", "origin", "axis")
_INSTEAD = "a chain (on the command line with --tip) goes in by the names of its base and tip"


def edit(
    data: str | bytes,
    robot: Robot,
    name: str = "<text>",
) -> bytes:
    """Text of a URDF with the origins and axes of a robot's joints: every other byte stays.

    Parameters: data, the URDF; robot, one with its links and joints, and maybe fixed joints more,
    which are added at the end; name, what to call the URDF in messages. Raises: ModelError where
    the URDF cannot be understood or edited, or its text would not be that robot; InputError where
    the robot differs in more than origins and axes. A joint that moved by no more than rounding
    stays as it is. Accuracy: poses of links at q = 0, and axes, within 1e-13 of the robot's size;
    they are read again before the text is returned.
    """
    before = urdf.read_text(data, name, tell=False)
    place = Source(name).place()
    added = _added(before, robot, place)
    text = decode(data, place)
    spans = find(text.content, place)
    found = [span.name for span in spans.joints if "parent" in span.tags]
    if found != [joint.name for joint in before.joints]:
        raise ModelError(
            f"{place}: cannot be edited in place: the tags of its joints have different prefixes"
        )
    poses = robot.fk(np.zeros(robot.dof))
    size = max(1.0, *(norm(translation_part(T)) for T in poses.values()))
    still = Still(STILL, STILL * size)
    quaternions = urdf.reads_quaternions(spans.version)
    wanted = {joint.name: joint for joint in robot.joints}
    edits: list[Edit] = []
    for span, joint in zip(spans.joints, before.joints, strict=True):
        written = JointText(text.content, span, joint, spans.prefix, quaternions)
        edits += edits_of(written, wanted[joint.name], still)
    if added:
        edits.append(_addition(text.content, spans, added))
    result = text.encoded(apply_edits(text.content, edits))
    _check(urdf.read_text(result, name, tell=False), robot, poses, size, place)
    return result


def _added(
    before: Robot,
    robot: Robot,
    place: str,
) -> list[Joint]:
    """Fixed joints that the robot has and the URDF has not. Raises: InputError for any other
    difference that is none of origins and axes.
    """
    mine = {joint.name: joint for joint in robot.joints}
    theirs = {joint.name: joint for joint in before.joints}
    lost = [name for name in theirs if name not in mine]
    if lost:
        raise InputError(
            f"{place} has joints that the robot has not: {join_names(lost)}; {_INSTEAD}"
        )
    for name, joint in theirs.items():
        for field in fields(Joint):
            a = getattr(mine[name], field.name)
            b = getattr(joint, field.name)
            if field.name not in _EDITED and a != b:
                raise InputError(
                    f"joint {quote(name)}: {field.name} is {escape_unprintable(a, 80)}, and in {place} it is"
                    f" {escape_unprintable(b, 80)}: only origins and axes are written in place; {_INSTEAD}"
                )
    added = [joint for name, joint in mine.items() if name not in theirs]
    for joint in added:
        if joint.kind != "fixed":
            raise InputError(
                f"{place} has no joint {quote(joint.name)}: only a fixed one can be added, and it is {joint.kind}"
            )
    links = {*before.links, *(joint.child for joint in added), *(joint.parent for joint in added)}
    if links != set(robot.links):
        raise InputError(f"{place} has other links: {join_names(sorted(links ^ set(robot.links)))}")
    return added


def _addition(
    content: bytes,
    spans: Spans,
    added: Sequence[Joint],
) -> Edit:
    """New links with the fixed joints that hold them, behind all else, indented as other joints."""
    outer = inner = b""
    if spans.joints:
        last = spans.joints[-1]
        outer = indent_before(content, last.start)
        inner = indent_before(content, last.tags["parent"].start)
    p = spans.prefix
    new = b""
    for joint in added:
        T = joint.origin
        name, parent, child = (
            quote_attribute(each, "name").encode("ascii", "xmlcharrefreplace").decode()
            for each in (joint.name, joint.parent, joint.child)
        )
        xyz = shortest(translation_part(T))
        turns = shortest(rpy.angles(rotation_part(T)))
        lines = [
            (outer, f"<{p}link name={child}/>"),
            (outer, f'<{p}joint name={name} type="fixed">'),
            (inner, f"<{p}parent link={parent}/>"),
            (inner, f"<{p}child link={child}/>"),
            (inner, f'<{p}origin xyz="{xyz}" rpy="{turns}"/>'),
            (inner and outer, f"</{p}joint>"),
        ]
        new += b"".join(indent + line.encode() for indent, line in lines)
    at = len(content[: spans.end].rstrip())
    return Edit(at, at, new)


def _check(
    written: Robot,
    robot: Robot,
    wanted: dict[str, Array],
    size: float,
    place: str,
) -> None:
    """Refuse a text that does not read as the wanted robot. Raises: ModelError."""
    found = written.fk(np.zeros(written.dof))
    axes = {joint.name: joint.axis for joint in written.joints}
    scale = np.array([1.0, 1.0, 1.0, size])
    for joint in robot.joints:
        T = wanted[joint.child]
        off = (np.abs(found[joint.child] - T) / scale).max()
        if joint.kind in (*MOVING, "planar"):
            axis = rotation_part(found[joint.child]) @ axes[joint.name]
            off = max(off, np.abs(axis - rotation_part(T) @ joint.axis).max())
        if not off <= EXACT:
            raise ModelError(
                f"{place}: the text with joint {quote(joint.name)} changed does not read as the robot, by"
                f" {off:.1e}: nothing is written"
            )
