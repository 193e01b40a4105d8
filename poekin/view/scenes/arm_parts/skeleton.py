"""Skeleton of an arm: its links as bones, its joints as glyphs that show their kind and sense."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms
from ....model.chain_data import ScrewKind
from ...nodes import Attachment, Layer, Triangles
from ...shapes import (
    Surface,
    arc_arrow,
    box,
    capsule,
    cylinder,
    double_arrow,
    helix,
    merged,
    transformed,
)
from .geometry import ArmGeometry, JointGeometry

LARGEST = 0.04
"""Radius of a joint's glyph as a share of the arm's size."""
SMALLEST = 0.006
"""Likewise of joints that stand close together."""
COINCIDENT = 0.01
"""Distance, as a share of the arm's size, up to which joints are taken for one place."""
LONGEST_RAIL = 20.0
"""Limit of a prismatic joint, in sizes of the arm, beyond which it is taken for none."""
BONE = 0.3
"""Radius of a bone as a share of the glyph's at its joint."""


def glyph_radii(arm: ArmGeometry, q: Array, size: float) -> Array:
    """Radii (n,) of the joints' glyphs, m: those of fingers are smaller than those of arms."""
    T = arm.poses(q)
    if not arm.joints:
        return np.zeros(0)
    places = np.array([transformed(joint.point, T[joint.parent]) for joint in arm.joints])
    room = np.array([_room(place, places, COINCIDENT * size) for place in places])
    for k, joint in enumerate(arm.joints):
        if joint.kind == "prismatic":  # a slide is no longer than a few times its way
            room[k] = min(room[k], 0.5 * (joint.limits[1] - joint.limits[0]))
    largest = min(LARGEST * size, 1.5 * float(np.median(room)))
    return np.clip(room, SMALLEST * size, max(largest, SMALLEST * size))


def _room(place: Array, places: Array, coincident: float) -> float:
    """Largest radius that leaves the next place free, of those that are not here."""
    gaps = norms(places - place)
    return 0.35 * float(gaps[gaps > coincident].min(initial=np.inf))


def skeleton_nodes(arm: ArmGeometry, radii: Array, size: float) -> list[Triangles]:
    """Bones, one node a link, and glyphs, one a joint."""
    thickness = dict.fromkeys(range(len(arm.links)), BONE * SMALLEST * size)
    glyphs = []
    for joint, radius in zip(arm.joints, radii.tolist(), strict=True):
        glyphs.append(_glyph_node(joint, radius))
        for link in (joint.parent, joint.child):
            thickness[link] = max(thickness[link], BONE * radius)
    return [*bone_nodes(arm, thickness, size, "skeleton"), *glyphs]


def bone_nodes(
    arm: ArmGeometry,
    thickness: Mapping[int, float],
    size: float,
    layer: Layer,
) -> list[Triangles]:
    """Bones, and rails of prismatic joints, of the links for which a radius is given."""
    pieces: dict[int, list[Surface]] = {}
    for bone in arm.bones:
        long = np.linalg.norm(bone.end - bone.start) > 1e-6 * size
        if long and bone.link in thickness:
            made = capsule(bone.start, bone.end, thickness[bone.link])
            pieces.setdefault(bone.link, []).append(made)
    for joint in arm.joints:
        if joint.kind == "prismatic" and joint.parent in thickness:
            rail = capsule(*_rail(joint, size), 0.5 * thickness[joint.parent])
            pieces.setdefault(joint.parent, []).append(rail)
    return [
        Triangles(Attachment(layer, "first", link, name=arm.links[link]), *merged(*surfaces))
        for link, surfaces in pieces.items()
    ]


def _rail(joint: JointGeometry, size: float) -> tuple[Array, Array]:
    """Ends of the way of a prismatic joint: within its limits, half the arm where it has none that a
    page could show.
    """
    low, high = (
        limit if abs(limit) <= LONGEST_RAIL * size else math.copysign(0.5 * size, limit)
        for limit in joint.limits
    )
    start = joint.point + min(low, 0.0) * joint.direction
    end = joint.point + max(high, 0.0) * joint.direction
    return start, end


def _glyph_node(joint: JointGeometry, radius: float) -> Triangles:
    """Glyph of a joint, on the link that carries it; a slide is on the link that it moves."""
    glyph = _glyph(joint.kind, joint.pitch < 0).scaled(radius)
    if joint.kind == "prismatic":
        link = joint.child
        placed = glyph.placed(joint.child_point, joint.child_direction)
    else:
        link = joint.parent
        placed = glyph.placed(joint.point, joint.direction)
    return Triangles(Attachment("skeleton", "joint", link, name=joint.name), *placed)


@cache
def _glyph(kind: ScrewKind, left_handed: bool) -> Surface:
    """Revolute: a cylinder and an arc that turns the positive way; prismatic: a box with an arrow both
    ways; helical: a cylinder in a helix, right-handed where the pitch is positive.
    """
    if kind == "revolute":
        return merged(cylinder(0.5, 1.4), arc_arrow(1.0, 0.08))
    if kind == "prismatic":
        return merged(box([1.2, 1.2, 1.6]), double_arrow(4.0, 0.15, 0.4, 0.7))
    return merged(cylinder(0.5, 2.4), helix(0.75, 0.12, -2.0 if left_handed else 2.0))
