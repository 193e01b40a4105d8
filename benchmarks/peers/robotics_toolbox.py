"""Robotics Toolbox for Python, with the exp and log of its spatialmath; twists (v; omega)."""

from __future__ import annotations

import numpy as np

from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST

from . import links
from .peer import Arm, Array, Arrays, Group, Kinematics, Peer, module


def group() -> Group:
    """Functions on arrays, which is faster than the class SE3; `check` would only judge what goes
    in.
    """
    base = module("spatialmath.base")
    return Group(
        lambda xi: base.trexp(xi, check=False),
        lambda T: base.trlog(T, check=False, twist=True),
        linear_first=True,
    )


def kinematics(arm: Arm) -> Kinematics:
    """An elementary transform sequence, whose C code computes; `eval` returns the matrix without a
    wrapper.

    It is built from the links' numbers: the library's own reader of URDFs wants files, meshes and
    xacro.
    """
    rtb = module("roboticstoolbox")
    sequence = rtb.ETS()
    fixed, last = links.z_aligned(arm.chain)
    for T, turns in fixed:
        sequence = sequence * rtb.ET.SE3(T) * (rtb.ET.Rz() if turns else rtb.ET.tz())
    sequence = sequence * rtb.ET.SE3(last)

    def fk_jacobian(q: Array) -> Arrays:
        return sequence.eval(q), sequence.jacob0(q)

    return Kinematics(
        "hybrid", sequence.eval, fk_jacobian, arrays=lambda T, J: (T, np.asarray(J)[ANGULAR_FIRST])
    )


PEER = Peer("Robotics Toolbox", "roboticstoolbox-python", "roboticstoolbox", group, kinematics)
