"""Roll, pitch, yaw as URDF means them: R = Rz(yaw) Ry(pitch) Rx(roll), turns about fixed axes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..groups import rpy


def pose(
    xyz: Sequence[float],
    turns: Sequence[float],
) -> np.ndarray:
    """The pose (4, 4) of a frame at xyz [m], turned by (roll, pitch, yaw) [rad], in its parent's
    frame.

    Accuracy: every entry of R to 3 units in the last place of 1; R is orthonormal to the same.
    Source: the URDF specification, element <origin>.
    """
    roll, pitch, yaw = turns
    sr = math.sin(roll)
    cr = math.cos(roll)
    sp = math.sin(pitch)
    cp = math.cos(pitch)
    sy = math.sin(yaw)
    cy = math.cos(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz[0]],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz[1]],
            [-sp, cp * sr, cp * cr, xyz[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def angles(R: Sequence[Sequence[float]] | np.ndarray) -> tuple[float, float, float]:
    """(roll, pitch, yaw) [rad] of a rotation (3, 3), as `poekin.groups.rpy.angles` finds them.

    Accuracy: as there. Source: the URDF specification, element <origin>.
    """
    roll, pitch, yaw = rpy.angles(np.asarray(R, float)).tolist()
    return roll, pitch, yaw
