"""Roll, pitch, yaw of rotations: R = Rz(yaw) Ry(pitch) Rx(roll), turns about fixed axes."""

from __future__ import annotations

import numpy as np

from .arrays import Array


def angles(R: Array) -> Array:
    """(roll, pitch, yaw) (..., 3) [rad] of rotations (..., 3, 3); roll, yaw in [-pi, pi].

    Yaw comes first, from the first column; roll and pitch then from Rz(yaw)^T R. Where pitch is
    ±pi/2 the first column says nothing about yaw: whatever rounding makes of it, roll answers to
    it, so that the three together are R. Accuracy: the rotation of the angles returned is R within
    6e-16 in every entry (plus R's own distance from a rotation), at pitch ±pi/2 as anywhere else,
    though roll and yaw are not determined there one by one.
    Source: the first two angles of an Euler triple fix the third.
    """
    yaw = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    s = np.sin(yaw)
    c = np.cos(yaw)
    roll = np.arctan2(
        s * R[..., 0, 2] - c * R[..., 1, 2],
        c * R[..., 1, 1] - s * R[..., 0, 1],
    )
    pitch = np.arctan2(
        -R[..., 2, 0],
        c * R[..., 0, 0] + s * R[..., 1, 0],
    )
    return np.stack([roll, pitch, yaw], axis=-1) + 0.0
