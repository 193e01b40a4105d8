"""Roll, pitch, yaw as URDF means them: R = Rz(yaw) Ry(pitch) Rx(roll), turns about fixed axes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..formulas.lie import euler
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
    R = euler.zyx(
        math.sin(yaw),
        math.cos(yaw),
        math.sin(pitch),
        math.cos(pitch),
        math.sin(roll),
        math.cos(roll),
    )
    T = np.eye(4)
    T[:3, :3] = np.reshape(R, (3, 3))
    T[:3, 3] = xyz
    return T


def angles(R: Sequence[Sequence[float]] | np.ndarray) -> tuple[float, float, float]:
    """(roll, pitch, yaw) [rad] of a rotation (3, 3), as `poekin.groups.rpy.angles` finds them.

    Accuracy: as there. Source: the URDF specification, element <origin>.
    """
    roll, pitch, yaw = rpy.angles(np.asarray(R, float)).tolist()
    return roll, pitch, yaw


def nearest_angles(
    R: Sequence[Sequence[float]] | np.ndarray,
    near: Sequence[float],
) -> tuple[float, float, float]:
    """(roll, pitch, yaw) [rad] of a rotation (3, 3), of all that there are those nearest to others.

    (r, p, y) and (r + pi, pi - p, y + pi) are one rotation, and so is either with whole turns
    added. Accuracy: as `angles`, and 4e-16 for each turn. Source: the URDF specification, element
    <origin>.
    """
    r, p, y = angles(R)
    found = []
    for branch in ((r, p, y), (r + math.pi, math.pi - p, y + math.pi)):
        turned = [
            x + math.tau * round((x0 - x) / math.tau) for x, x0 in zip(branch, near, strict=True)
        ]
        found.append(turned)
    roll, pitch, yaw = min(found, key=lambda turned: math.dist(turned, near))
    return roll, pitch, yaw
