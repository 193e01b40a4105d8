"""Joints of a branch with the screws of a chain: where each link's frame goes, and its axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from ...groups import se3, so3
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, norm, rotation_part, translation_part
from ...model.chain import Chain
from ...model.joint import Joint

ON_AXIS = 1e-11
"""Distance [rad, and in reaches] of a tip from the axis that moves it, below which it is rounding."""
LOCKED = 0.05
"""Cosine of the pitch of a joint's origin below which a small turn may change roll and yaw by 20
times as much, and at 0 by any amount.
"""
Turn = Literal["auto", "frames", "axes"]


class Branch(NamedTuple):
    """Joints of a way down the tree; pose of the chain's tip in the last link where that is not it."""

    joints: list[Joint]
    tool: Array | None


class JointAxis(NamedTuple):
    """Axis of a joint in the top link's frame: direction, point nearest to the origin, None of a
    prismatic joint; pitch.
    """

    direction: Array
    foot: Array | None
    pitch: float


def branch_of(
    joints: Sequence[Joint],
    chain: Chain,
    turn: Turn,
) -> Branch:
    """Joints of a way down the tree with new origins: in the top link they move as the chain does.
    See `relinked` for `turn`.

    H and G are the poses of a link in the top link's frame at x = 0: the nominal one and the new
    one.
    """
    last = max(k for k, joint in enumerate(joints) if joint.kind != "fixed")
    H = G = above = np.eye(4)
    axes = _axes(chain)
    result: list[Joint] = []
    for joint in joints[: last + 1]:
        H = H @ joint.origin
        above = G
        if joint.kind == "fixed":
            G = G @ joint.origin
            result.append(joint)
            continue
        joint, G = _moved(joint, axes.pop(0), H, above, turn)
        result.append(replace(joint, origin=se3.inverse(above) @ G))
    behind = joints[last + 1 :]
    if behind:
        rest = np.eye(4)
        for joint in behind[1:]:
            rest = rest @ joint.origin
        first = replace(behind[0], origin=se3.inverse(G) @ chain.home @ se3.inverse(rest))
        return Branch([*result, first, *behind[1:]], None)
    joint = _pointing(joints[last], _axes(chain)[-1], chain.home)
    if tip_off_axis(chain, joint.axis) > ON_AXIS:
        return Branch(result, se3.inverse(G) @ chain.home)
    result[last] = replace(joint, origin=se3.inverse(above) @ chain.home)
    return Branch(result, None)


def _axes(chain: Chain) -> list[JointAxis]:
    """Axes of a chain's joints, in order."""
    axes = []
    for screw, turns, slides in zip(
        chain.screws,
        chain.local.rotates,
        chain.local.slides,
        strict=True,
    ):
        if turns:
            w = angular_part(screw)
            axes.append(JointAxis(w, np.cross(w, linear_part(screw)), float(slides)))
        else:
            axes.append(JointAxis(linear_part(screw), None, 0.0))
    return axes


def _moved(
    joint: Joint,
    axis: JointAxis,
    H: Array,
    above: Array,
    turn: Turn,
) -> tuple[Joint, Array]:
    """Joint with its new axis, and the pose of the link that it moves; above is that of the link
    before it.
    """
    w = axis.direction
    G = H.copy()
    if axis.foot is not None:
        G[:3, 3] = axis.foot + w * (w @ (translation_part(H) - axis.foot))
    cosine = float(np.hypot(*joint.origin[:2, 0]))
    if turn == "axes" or (turn == "auto" and cosine < LOCKED):
        G[:3, :3] = rotation_part(above) @ rotation_part(joint.origin)
        direction = (rotation_part(G).T @ w).tolist()
        return replace(joint, axis=direction, pitch=axis.pitch), G
    joint = _pointing(joint, axis, G)
    z = rotation_part(G) @ joint.axis
    off = np.cross(z, w)
    sine = norm(off)
    if sine:
        angle = math.atan2(sine, float(z @ w))
        G[:3, :3] = so3.exp(off / sine * angle) @ rotation_part(G)
    return joint, G


def _pointing(
    joint: Joint,
    axis: JointAxis,
    G: Array,
) -> Joint:
    """Joint whose axis, in a link at G, points as the new one does, not against it."""
    direction = joint.axis
    if (rotation_part(G) @ direction) @ axis.direction < 0:
        direction = tuple(-a for a in direction)
    return replace(joint, axis=direction, pitch=axis.pitch)


def tip_off_axis(chain: Chain, direction: Sequence[float]) -> float:
    """Distance [rad, and in reaches] of a chain's tip from the axis of its last joint, which has this
    direction in the tip's frame.
    """
    axis = _axes(chain)[-1]
    w = axis.direction
    sine = norm(np.cross(rotation_part(chain.home) @ direction, w))
    if axis.foot is None:
        return sine
    aside = np.cross(translation_part(chain.home) - axis.foot, w)
    return max(sine, norm(aside) / chain.reach)
