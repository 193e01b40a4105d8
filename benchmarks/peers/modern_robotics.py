"""Modern Robotics' Python: the book's functions, written to be read; twists (omega; v), space
Jacobian.
"""

from __future__ import annotations

import numpy as np

from .links import serial
from .peer import Arm, Array, Arrays, Group, Kinematics, Peer, module


def group() -> Group:
    """One matrix at a time, by way of se(3) matrices."""
    mr = module("modern_robotics")
    return Group(
        lambda xi: mr.MatrixExp6(mr.VecTose3(xi)),
        lambda T: mr.se3ToVec(mr.MatrixLog6(T)),
        linear_first=False,
    )


def kinematics(arm: Arm) -> Kinematics:
    """Its only way."""
    mr = module("modern_robotics")
    serial(arm.chain)
    home, screws = np.array(arm.chain.home), np.array(arm.chain.screws.T)

    def fk(q: Array) -> Array:
        return mr.FKinSpace(home, screws, q)

    def fk_jacobian(q: Array) -> Arrays:
        return mr.FKinSpace(home, screws, q), mr.JacobianSpace(screws, q)

    return Kinematics("space", fk, fk_jacobian)


PEER = Peer("Modern Robotics", "modern-robotics", "modern_robotics", group, kinematics)
