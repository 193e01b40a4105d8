"""Axes of an arm as lines with their numbers, the table of their screws, frames and joints' names."""

from __future__ import annotations

import numpy as np

from ....errors import escape_unprintable
from ....groups.arrays import Array
from ....groups.vectors import angular_part, linear_part
from ....model.screw import axis_of
from ...nodes import Attachment, Label, Node, Polyline, Role, Triangles
from ...scene import PageTable
from ...shapes import cone, frame_axes
from .geometry import ArmGeometry, JointGeometry
from .skeleton import LARGEST

HALF_LINE = 4.0
"""Half an axis line as a multiple of the radius of the joint's glyph."""
CROWD = 20
"""Joints up to which lines are as long as that; of more they are shorter by the root of their number."""
COVERED = 1.6
"""Factor by which lines and frames are longer where bodies cover them."""
END_FRAME = 3.0
"""Length of the arrows of the base's and the first tip's frame, by the radius of the largest glyph."""
LINK_FRAME = 1.2
"""Length of the arrows of other frames, by the radius of the glyph above them."""
HEADS = ("axis", "joint", "kind", "ω", "point nearest to the origin, m", "v", "pitch, m/rad")
XYZ: tuple[Role, Role, Role] = ("x", "y", "z")


def axis_nodes(
    arm: ArmGeometry,
    radii: Array,
    size: float,
    covered: bool = False,
) -> list[Node]:
    """For each joint its axis A_k, a head at the positive end, and its number; lines are longer where
    bodies cover them.
    """
    line = HALF_LINE * (COVERED if covered else 1.0)
    few = CROWD / max(len(radii), 1)
    half = line * min(1.0, few**0.5)
    nodes: list[Node] = []
    joints = zip(arm.joints, radii, strict=True)
    for k, (joint, radius) in enumerate(joints):
        title = f"A{k + 1}"
        attachment = Attachment("axes", "joint", joint.parent, name=f"{title} {joint.name}")
        way = radius * joint.direction
        end = joint.point + half * way
        head = cone(0.15 * radius, 0.5 * radius)
        head = head.placed(end, joint.direction)
        start = joint.point - half * way
        nodes += [
            Polyline(attachment, np.array([start, end]), 0.0025 * size),
            Triangles(attachment, *head),
            Label(attachment, end + way, title),
        ]
    return nodes


def label_nodes(arm: ArmGeometry, radii: Array) -> list[Node]:
    """Names of the joints, beside them."""
    return [
        Label(
            Attachment("labels", "joint", joint.parent, name=joint.name),
            joint.point - 1.5 * radius * joint.direction,
            escape_unprintable(joint.name),
        )
        for joint, radius in zip(arm.joints, radii, strict=True)
    ]


def frame_nodes(
    arm: ArmGeometry,
    radii: Array,
    size: float,
    covered: bool = False,
) -> list[Node]:
    """Frames as three arrows; those of the base and of the first tip are larger, and longer still where
    bodies cover them; tips have their names.
    """
    nodes: list[Node] = []
    largest = float(radii.max(initial=0.0)) or LARGEST * size
    lengths = {
        joint.child: LINK_FRAME * float(radius)
        for joint, radius in zip(arm.joints, radii, strict=True)
    }
    for frame in arm.frames:
        length = lengths.get(frame.link, LINK_FRAME * largest)
        if frame.kind == "end":
            length = END_FRAME * largest * (COVERED if covered else 1.0)
        for role, axis in zip(XYZ, frame_axes(frame.pose, length), strict=True):
            attachment = Attachment("frames", role, frame.link, name=frame.name)
            nodes.append(Triangles(attachment, *axis))
        if frame.kind != "link":
            attachment = Attachment("frames", "first", frame.link, name=frame.name)
            beside = [0.6 * length, 0.6 * length, 0.0, 1.0]
            place = frame.pose[:3] @ beside
            nodes.append(Label(attachment, place, escape_unprintable(frame.name)))
    return nodes


def screw_table(arm: ArmGeometry) -> PageTable:
    """The screws (ω; v) in the base frame at q = 0, with the points and pitches of their axes."""
    rows = [_screw_row(joint, k) for k, joint in enumerate(arm.joints)]
    return PageTable("Screws at q = 0, in the base frame", HEADS, tuple(rows))


def _screw_row(joint: JointGeometry, k: int) -> tuple[str, ...]:
    place = "none"
    pitch = "∞"
    if joint.kind != "prismatic":
        place = _vector(axis_of(joint.screw).point)
        pitch = _vector([joint.pitch])
    name = escape_unprintable(joint.name)
    w = _vector(angular_part(joint.screw))
    v = _vector(linear_part(joint.screw))
    return f"A{k + 1}", name, joint.kind, w, place, v, pitch


def _vector(values: Array | list[float] | None) -> str:
    """Numbers to five digits and six decimals."""
    row = np.round(np.asarray(values, float), 6)
    return ", ".join(f"{x:.5g}" for x in row + 0.0)
