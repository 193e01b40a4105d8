"""Array of a completed arm, as `engine.kernels.branches.closed_arm` lays it out."""

from __future__ import annotations

import numpy as np

from ....engine.kernels.branches import closed_arm
from ....groups import se3
from ....groups.arrays import Array
from .completions import Completion
from .joints import ADDED, across

# places of the three axes among six that are solved: the last ones, and the second to the fourth
_PLACE = {closed_arm.WRIST: 3, closed_arm.PARALLEL: 1}


def arm_array(completion: Completion, home: Array) -> Array:
    """The array (10, 8) of six joints and the pose (4, 4) of the tip at zero."""
    family = completion.family
    place = _PLACE[family]
    turned = (completion.first - place) % 6
    joints = [*completion.joints[turned:], *completion.joints[:turned]]
    arm = np.zeros(closed_arm.SHAPE)
    for row, joint in zip(arm, joints, strict=False):
        row[closed_arm.DIRECTION : closed_arm.DIRECTION + 3] = joint.direction
        row[closed_arm.POINT : closed_arm.POINT + 3] = joint.point
        row[closed_arm.SLIDES] = joint.slides
        row[closed_arm.COLUMN] = joint.column
    arm[closed_arm.HOME : closed_arm.HOME + 3, :4] = se3.inverse(home)[:3]
    rule = arm[closed_arm.RULE]
    rule[closed_arm.FAMILY] = family
    rule[closed_arm.TURNED] = turned
    rule[closed_arm.ADDED] = sum(joint.column == ADDED for joint in joints)
    named = joints[5] if family == closed_arm.WRIST else joints[1]
    rule[closed_arm.ACROSS : closed_arm.ACROSS + 3] = across(named.direction)
    return arm
