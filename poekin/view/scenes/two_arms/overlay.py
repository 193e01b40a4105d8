"""A second arm in a scene: where it stands beside the first, and what of it is drawn."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import rotation_part
from ...kinematics import page_tips
from ...nodes import Attachment, Label, Node
from ...scene import SceneArm
from ...shapes import transformed
from ..arm import scene_arm
from ..arm_parts.axes import axis_nodes, frame_nodes
from ..arm_parts.geometry import ArmGeometry
from ..arm_parts.of_chain import chain_geometry
from ..arm_parts.skeleton import glyph_radii, skeleton_nodes
from .exaggerated import Exaggerated

FADED = 0.3
"""Opacity of the second arm."""
SHELL = 1.5
"""Thickness of the second arm by that of the first, which is seen inside it where the two coincide."""
COVER = 1.15
"""Likewise of its joints that differ, which cover those of the first."""


def second_arm(second: Exaggerated, base: Array, factors: Array) -> SceneArm:
    """The second arm, whose own coordinates are factors · q, q the sliders.

    Parameters: base (4, 4), its base in the world; factors (m, sliders), of its own coordinates but
    the last one k, which follows no slider.
    """
    chain = second.chain
    geometry = chain_geometry(chain)
    tips = page_tips(chain)
    arm = scene_arm(chain, geometry, tips, geometry.sliders)
    shift = np.zeros(len(factors))
    if second.factor > 1:
        no_coordinate = np.zeros(factors.shape[1])
        factors = np.vstack([factors, no_coordinate])
        shift = np.append(shift, second.factor)
    return replace(arm, base=base, factors=factors, shift=shift)


def second_nodes(
    second: Exaggerated,
    differing: dict[str, str],
    ends: Container[str],
    size: float,
) -> list[Node]:
    """Skeleton of the second arm; joints that differ with their axes and a label as the layer of
    differences.

    Parameters: differing, a sentence for each joint that is another one, by its name; ends, names
    of the frames to draw; size, of the arms.
    """
    geometry = chain_geometry(second.b)
    at_zero = np.zeros(len(geometry.sliders))
    radii = glyph_radii(geometry, at_zero, size)
    arm = _on_bodies(geometry, second)
    thicker = [COVER if joint.name in differing else SHELL for joint in arm.joints]
    drawn_frames = [frame for frame in arm.frames if frame.kind == "end"]
    frames = tuple(frame for frame in drawn_frames if frame.name in ends)
    nodes = [
        *skeleton_nodes(arm, radii * thicker, size),
        *frame_nodes(replace(arm, frames=frames), radii, size),
    ]
    drawn = [_of_second(node, differing) for node in nodes]
    for k, joint in enumerate(arm.joints):
        if joint.name not in differing:
            continue
        only = replace(arm, joints=(joint,))
        for node in axis_nodes(only, radii[k : k + 1], size):
            if not isinstance(node, Label):
                drawn.append(_differing(node, differing[joint.name]))
        words = differing[joint.name]
        attachment = Attachment("differences", "differs", joint.parent, 1, words)
        way = 2.5 * radii[k] * joint.direction
        drawn.append(Label(attachment, joint.point + way, joint.name))
    return drawn


def _on_bodies(geometry: ArmGeometry, second: Exaggerated) -> ArmGeometry:
    """Geometry of the chain as it is, attached to the bodies of the exaggerated one."""
    bodies = second.bodies
    back = se3.exp(-second.moves)
    joints = []
    for k, joint in enumerate(geometry.joints):
        moved = replace(
            joint,
            parent=second.axes[k],
            child=bodies[k + 1],
            point=transformed(joint.point, back[k]),
            direction=rotation_part(back[k]) @ joint.direction,
        )
        joints.append(moved)
    *frames, tool = [replace(frame, link=bodies[frame.link]) for frame in geometry.frames]
    frames.append(replace(tool, link=bodies[-1], pose=back[-1] @ tool.pose))
    names = [""] * (bodies[-1] + 1)
    for k, name in enumerate(geometry.links):
        names[bodies[k]] = name
    bones = [replace(bone, link=bodies[bone.link]) for bone in geometry.bones]
    return replace(
        geometry,
        links=tuple(names),
        joints=tuple(joints),
        bones=tuple(bones),
        frames=tuple(frames),
    )


def _of_second(node: Node, differing: dict[str, str]) -> Node:
    """A node of the first arm as one of the second."""
    attachment = node.attachment
    if attachment.layer != "skeleton":
        return replace(node, attachment=replace(attachment, arm=1))
    if attachment.role == "joint" and attachment.name in differing:
        return _differing(node, differing[attachment.name])
    faded = replace(attachment, arm=1, role="second", opacity=FADED)
    return replace(node, attachment=faded)


def _differing(node: Node, words: str) -> Node:
    """A node in the layer of differences, with the sentence on its joint."""
    attachment = replace(node.attachment, arm=1, layer="differences", role="differs", name=words)
    return replace(node, attachment=attachment)
