"""Roll, pitch, yaw of rotations: R = Rz(yaw) Ry(pitch) Rx(roll), turns about fixed axes."""

from __future__ import annotations

from . import euler
from .arrays import Array


def angles(R: Array) -> Array:
    """(roll, pitch, yaw) (..., 3) [rad] of rotations (..., 3, 3); roll, yaw in [-pi, pi].

    Yaw comes first, from the first column; roll and pitch then from Rz(yaw)^T R. Where pitch is
    ±pi/2 the first column says nothing about yaw, and roll is 0.
    Accuracy: the rotation of the angles returned is R within 8 u in every entry (plus R's own
    distance from a rotation), u = 2^-53, at pitch ±pi/2 as anywhere else.
    Source: `formulas.lie.euler`, R = Rz(A) Ry(B) Rx(C) with A = yaw, C = roll.
    """
    return euler.angles(R, "zyx")[..., ::-1]
