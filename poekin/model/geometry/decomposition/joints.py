"""Joints as lines: which axes meet in a point, which are parallel."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import angular_part, directions, linear_part, norm
from ...chain_data import ChainData
from ..other_frames import without_offset

SLANT = 0.01
"""The sine of the angle below which two axes are not taken to meet: their point would be too far to
be known well.
"""

ADDED = -1
"""The column of a joint that the arm does not have and that stays at 0."""


class LoopJoint(NamedTuple):
    """A joint at zero: unit direction of its axis, a point of it, whether it is prismatic, and the
    column of its coordinate.
    """

    direction: Array
    point: Array
    slides: bool
    column: int = ADDED


class Tolerance(NamedTuple):
    """The sine of an angle (rad) and the distance (m) that count as none."""

    angle: float
    distance: float


def joints_of(chain: ChainData) -> list[LoopJoint]:
    """The joints of a chain without coupling, its offset taken into the zero."""
    chain = without_offset(chain)
    joints: list[LoopJoint] = []
    point = np.zeros(3)
    for i, S in enumerate(chain.screws):
        slides = chain.kinds[i] == "prismatic"
        if not slides:
            point = np.cross(angular_part(S), linear_part(S))
        joints.append(LoopJoint(directions(S), point, slides, i))
    return joints


def sine(a: LoopJoint, b: LoopJoint) -> float:
    """Sine of the angle between two axes."""
    return norm(np.cross(a.direction, b.direction))


def meeting_point(joints: Sequence[LoopJoint], tolerance: Tolerance) -> Array | None:
    """The point in which revolute axes meet, no neighbours parallel; None where they do not."""
    if any(joint.slides for joint in joints):
        return None
    if any(sine(a, b) < SLANT for a, b in pairwise(joints)):
        return None
    H = np.array([joint.direction for joint in joints])
    C = np.array([joint.point for joint in joints])
    identity = np.eye(3)
    across = identity - H[:, :, None] * H[:, None, :]
    start = C.mean(axis=0)
    away = np.einsum("nij,nj->i", across, C - start)
    shift = np.linalg.solve(across.sum(axis=0), away)
    point = start + shift
    distances = np.linalg.norm(np.cross(H, point - C), axis=1)
    return point if distances.max() <= tolerance.distance else None


def parallel(joints: Sequence[LoopJoint], tolerance: Tolerance) -> bool:
    """Whether revolute axes are parallel, and no neighbours coaxial."""
    if any(joint.slides for joint in joints):
        return False
    first = joints[0]
    if any(sine(first, other) > tolerance.angle for other in joints[1:]):
        return False
    return all(
        norm(np.cross(a.direction, b.point - a.point)) > tolerance.distance
        for a, b in pairwise(joints)
    )


def planar(joints: Sequence[LoopJoint], tolerance: Tolerance) -> bool:
    """Whether joints move in one plane, some of them prismatic: revolute axes are parallel, and
    prismatic ones across them.
    """
    normals = [joint.direction for joint in joints if not joint.slides]
    ways = [joint.direction for joint in joints if joint.slides]
    if not normals or not ways:
        return False
    first = normals[0]
    if any(norm(np.cross(first, h)) > tolerance.angle for h in normals):
        return False
    return all(abs(float(first @ way)) <= tolerance.angle for way in ways)


def across(direction: Array) -> Array:
    """A unit vector across a unit vector."""
    smallest = int(np.argmin(np.abs(direction)))
    v = np.asarray(np.cross(direction, np.eye(3)[smallest]), float)
    return v / norm(v)
