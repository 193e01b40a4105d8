"""Geometry of a robot: its links, each in its own frame, and its joints in their parents' frames."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....analysis.amounts import joint_unit
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import rotation_part, translation_part
from ....model.chain_data import ScrewKind
from ....model.joint import MOVING, Joint
from ....model.robot import Robot
from ...scene import Slider
from .geometry import ArmGeometry, Bone, FrameKind, JointGeometry, LinkFrame

KINDS: dict[str, ScrewKind] = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "helical": "helical",
}
"""Kind of the screw of each kind of joint that moves."""


def robot_geometry(robot: Robot, tips: Sequence[str]) -> ArmGeometry:
    """Geometry of a robot, some of whose links are tips."""
    numbers = {link: number for number, link in enumerate(robot.links)}

    def poses(q: Array) -> Array:
        return np.array(list(robot.fk(q).values()))

    rest = poses(np.zeros(robot.dof))
    moving = [joint for joint in robot.joints if joint.kind in MOVING]
    return ArmGeometry(
        name=robot.name,
        links=robot.links,
        sliders=_sliders(robot),
        joints=tuple(_joint(joint, numbers, rest) for joint in moving),
        bones=tuple(
            Bone(numbers[joint.parent], np.zeros(3), translation_part(joint.origin))
            for joint in robot.joints
        ),
        frames=_frames(robot, moving, tips, numbers),
        poses=poses,
    )


def _joint(joint: Joint, numbers: dict[str, int], rest: Array) -> JointGeometry:
    parent = numbers[joint.parent]
    axis = np.array(joint.axis)
    return JointGeometry(
        name=joint.name,
        kind=KINDS[joint.kind],
        parent=parent,
        child=numbers[joint.child],
        point=translation_part(joint.origin),
        direction=rotation_part(joint.origin) @ axis,
        child_point=np.zeros(3),
        child_direction=axis,
        pitch=joint.pitch,
        limits=joint.limits,
        screw=se3.adjoint(rest[parent] @ joint.origin) @ np.array(joint.screw),
    )


def _sliders(robot: Robot) -> tuple[Slider, ...]:
    bounds = robot.limits.tolist()
    return tuple(
        Slider(name, joint_unit(robot.joint(name).kind), *bounds[k])
        for k, name in enumerate(robot.q_names)
    )


def _frames(
    robot: Robot,
    moving: Sequence[Joint],
    tips: Sequence[str],
    numbers: dict[str, int],
) -> tuple[LinkFrame, ...]:
    """Frames of the root, of the links that joints move, and of the tips."""
    kinds: dict[str, FrameKind] = {joint.child: "link" for joint in moving}
    kinds.update(dict.fromkeys(tips, "tip"))
    kinds.update(dict.fromkeys([robot.root, *tips[:1]], "end"))
    return tuple(LinkFrame(numbers[link], np.eye(4), link, kind) for link, kind in kinds.items())
