"""Roll, pitch, yaw as URDF means them: R = Rz(yaw) Ry(pitch) Rx(roll), turns about fixed axes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np


def pose(xyz: Sequence[float], rpy: Sequence[float]) -> np.ndarray:
    """The pose (4, 4) of a frame at xyz [m], turned by rpy = (roll, pitch, yaw) [rad], in its parent's frame.

    Accuracy: every entry of R to 3 units in the last place of 1; R is orthonormal to the same.
    Source: the URDF specification, element <origin>.
    """
    roll, pitch, yaw = rpy
    sr, cr, sp, cp, sy, cy = (f(a) for a in (roll, pitch, yaw) for f in (math.sin, math.cos))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz[0]],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz[1]],
            [-sp, cp * sr, cp * cr, xyz[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def angles(R: Sequence[Sequence[float]] | np.ndarray) -> tuple[float, float, float]:
    """(roll, pitch, yaw) [rad] of a rotation (3, 3): R = Rz(yaw) Ry(pitch) Rx(roll); roll, yaw in [-π, π].

    Yaw comes first, from the first column; roll and pitch then from Rz(yaw)^T R. Where pitch is ±π/2 the first column
    says nothing about yaw: whatever rounding makes of it, roll answers to it, so that the three together are R.
    Accuracy: the rotation of the angles returned is R within 6e-16 in every entry (plus R's own distance from a
    rotation), at pitch ±π/2 as anywhere else, though roll and yaw are not determined there one by one.
    Source: the URDF specification, element <origin>; the first two angles of an Euler triple fix the third.
    """
    (a, d, g), (b, e, h), (c, _, _) = (map(float, row) for row in R)
    yaw = math.atan2(b, a)
    s, c_yaw = math.sin(yaw), math.cos(yaw)
    roll = math.atan2(s * g - c_yaw * h, c_yaw * e - s * d)
    pitch = math.atan2(-c, c_yaw * a + s * b)
    return roll + 0.0, pitch + 0.0, yaw + 0.0
