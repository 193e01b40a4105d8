"""Skeleton of an arm: its links as bones, its joints as glyphs that show their kind and sense."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from ....groups.arrays import Array
from ...nodes import Hung, Layer, Node, Triangles
from ...shapes import Surface, arc_arrow, box, capsule, cylinder, double_arrow, helix, merged
from .geometry import ArmGeometry, JointGeometry

LARGEST = 0.04
"""Radius of a joint's glyph as a share of the arm's size."""
SMALLEST = 0.006
"""The same, of joints that stand close together."""
COINCIDENT = 0.01
"""Distance, as a share of the arm's size, up to which joints are taken for one place."""
BONE = 0.3
"""Radius of a bone as a share of the glyph's at its joint."""


def glyph_radii(arm: ArmGeometry, q: Array, size: float) -> Array:
    """Radii (n,) of the joints' glyphs, m: those of fingers are smaller than those of arms."""
    T = arm.poses(q)
    if not arm.joints:
        return np.zeros(0)
    places = np.array([T[j.parent, :3, :3] @ j.point + T[j.parent, :3, 3] for j in arm.joints])
    gaps = np.linalg.norm(places[:, None] - places, axis=-1)
    gaps[gaps <= COINCIDENT * size] = np.inf
    room = 0.35 * gaps.min(axis=1)
    for k, joint in enumerate(arm.joints):
        if joint.kind == "prismatic":  # a slide is no longer than a few times its way
            room[k] = min(room[k], 0.5 * (joint.limits[1] - joint.limits[0]))
    largest = min(LARGEST * size, 1.5 * float(np.median(room)))
    return np.clip(room, SMALLEST * size, max(largest, SMALLEST * size))


def skeleton_nodes(arm: ArmGeometry, radii: Array, size: float) -> list[Node]:
    """Bones, one node a link, and glyphs, one a joint."""
    thickness = _bone_radii(arm, radii, size)
    links = [
        bone_node(arm, link, thickness[link], size, "skeleton") for link in range(len(arm.links))
    ]
    glyphs = [
        _glyph_node(joint, float(radius)) for joint, radius in zip(arm.joints, radii, strict=True)
    ]
    return [*(node for node in links if node is not None), *glyphs]


def bone_node(
    arm: ArmGeometry,
    link: int,
    radius: float,
    size: float,
    layer: Layer,
) -> Triangles | None:
    """Bones of a link and the rails of its prismatic joints; None where it has none."""
    bones = [
        capsule(bone.start, bone.end, radius)
        for bone in arm.bones
        if bone.link == link and np.linalg.norm(bone.end - bone.start) > 1e-6 * size
    ]
    rails = [
        capsule(*_rail(joint, size), 0.5 * radius)
        for joint in arm.joints
        if joint.parent == link and joint.kind == "prismatic"
    ]
    if not bones and not rails:
        return None
    return Triangles(Hung(layer, "first", link, name=arm.links[link]), *merged(*bones, *rails))


def _bone_radii(arm: ArmGeometry, radii: Array, size: float) -> Array:
    """Radii (L,) of the bones: by the largest glyph on the link, and SMALLEST where there is none."""
    found = np.full(len(arm.links), SMALLEST * size)
    for joint, radius in zip(arm.joints, radii, strict=True):
        for link in (joint.parent, joint.child):
            found[link] = max(found[link], radius)
    return BONE * found


def _rail(joint: JointGeometry, size: float) -> tuple[Array, Array]:
    """Ends of the way of a prismatic joint: within its limits, half the arm where it has none."""
    low, high = (
        limit if math.isfinite(limit) else math.copysign(0.5 * size, limit)
        for limit in joint.limits
    )
    start = joint.point + min(low, 0.0) * joint.direction
    end = joint.point + max(high, 0.0) * joint.direction
    return start, end


def _glyph_node(joint: JointGeometry, radius: float) -> Triangles:
    """Glyph of a joint, on the link that carries it; a slide is on the link that it moves."""
    if joint.kind == "prismatic":
        hung = Hung("skeleton", "joint", joint.child, name=joint.name)
        return Triangles(
            hung, *_slide().scaled(radius).placed(joint.child_point, joint.child_direction)
        )
    hung = Hung("skeleton", "joint", joint.parent, name=joint.name)
    glyph = _hinge() if joint.kind == "revolute" else _thread(joint.pitch < 0)
    return Triangles(hung, *glyph.scaled(radius).placed(joint.point, joint.direction))


@cache
def _hinge() -> Surface:
    """Revolute: a cylinder along the axis, and an arc that turns the positive way."""
    return merged(cylinder(0.5, 1.4), arc_arrow(1.0, 0.08))


@cache
def _thread(left_handed: bool) -> Surface:
    """Helical: a cylinder in a helix, right-handed where the pitch is positive."""
    return merged(cylinder(0.5, 2.4), helix(0.75, 0.12, -2.0 if left_handed else 2.0))


@cache
def _slide() -> Surface:
    """Prismatic: a box with an arrow both ways along the axis."""
    return merged(box([1.2, 1.2, 1.6]), double_arrow(4.0, 0.15, 0.4, 0.7))
