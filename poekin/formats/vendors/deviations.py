"""Deviations of an arm's axes and tip from another's: whether a calibration is one of this arm."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...groups import se3, so3
from ...groups.arrays import Array
from ...groups.vectors import (
    angular_part,
    directions,
    linear_part,
    norm,
    rotation_part,
    translation_part,
)
from ...model.chain import Chain
from ...model.robot import Robot

FAR = 0.02
"""A calibration that moves an axis by more than this [m] is hardly one of that arm: 2 to 7 mm are
usual.
"""
FAR_ANGLE = math.radians(3.0)
"""Likewise one that turns an axis by more than this [rad]: up to 0.5° is usual."""


class Deviation(NamedTuple):
    """Distance [m] and angle [rad] of a joint's axis, or of the tip, from the nominal one."""

    name: str
    position: float
    angle: float

    @property
    def score(self) -> float:
        """The larger of both, in the largest that a calibration of the same arm is taken to have."""
        return max(self.position / FAR, self.angle / FAR_ANGLE)

    @property
    def far(self) -> bool:
        """Whether it is more than a calibration of the same arm has."""
        return not self.score <= 1.0

    def summary(self) -> str:
        """Distance and angle in mm and degrees."""
        return f"{_digits(self.position * 1e3)} mm and {_digits(math.degrees(self.angle))}°"


LARGEST = Deviation("any", FAR, FAR_ANGLE)
"""The largest deviation of a calibration of the same arm."""


def _digits(value: float) -> str:
    """A number to three digits or to a whole, 0 where it is less than half a thousandth."""
    if value < 5e-4:
        return "0"
    if value >= 999.5:
        return f"{value:.0f}"
    return f"{value:.3g}"


def origins(robot: Robot, nominal: Chain) -> Array:
    """Origins (n, 3) of the links that a chain's joints move, at zero, in its base frame, m."""
    poses = robot.fk(np.zeros(robot.dof))
    base = se3.inverse(poses[nominal.base])
    ends = [robot.joint(name) for name in nominal.joint_names]
    return np.array([translation_part(base @ poses[joint.child]) for joint in ends]).reshape(-1, 3)


def deviations(nominal: Chain, chain: Chain, places: Array) -> list[Deviation]:
    """Deviations of a chain's axes, as `axis_deviations`, and of its tip, at zero."""
    apart = norm(translation_part(chain.home) - translation_part(nominal.home))
    turn = so3.log(rotation_part(nominal.home).T @ rotation_part(chain.home))
    tip = Deviation(nominal.tip, apart, norm(turn))
    return [*axis_deviations(nominal, chain, places), tip]


def axis_deviations(nominal: Chain, chain: Chain, places: Array) -> list[Deviation]:
    """Deviations of a chain's axes, joint by joint, at zero.

    An axis is as far off as it passes from the nominal joint's place (n, 3), in the base frame, m;
    both chains have the same number of joints.
    Accuracy: 1e-14 reach.
    """
    found = []
    rows = zip(nominal.joint_names, nominal.screws, chain.screws, places, strict=True)
    for name, screw, other, place in rows:
        w = angular_part(other)
        turns = bool(w.any())
        axis = directions(screw)
        apart = 0.0
        if turns:
            off = place - np.cross(w, linear_part(other))
            apart = norm(off - w * (w @ off))
        else:
            w = linear_part(other)
        angle = math.atan2(norm(np.cross(axis, w)), float(axis @ w))
        found.append(Deviation(name, apart, angle))
    return found
