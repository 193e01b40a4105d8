"""MuJoCo: the kinematics at the head of its simulator; its Jacobian is two arrays. It has no exp
and log of poses.
"""

from __future__ import annotations

import numpy as np

from poekin import Chain

from .links import serial
from .peer import Arm, Array, Arrays, Kinematics, Peer, module


def kinematics(arm: Arm) -> Kinematics:
    """`mj_kinematics`, `mj_comPos` (which the Jacobian needs) and `mj_jacSite`, on a site at the
    tip.

    The results are those that its users have: position and rotation of the site as views of the
    data, and the two halves of the Jacobian in arrays that are reused.
    """
    mujoco = module("mujoco")
    serial(arm.chain)
    model = mujoco.MjModel.from_xml_string(_text(arm.chain))
    data = mujoco.MjData(model)
    site, linear, angular = 0, np.zeros((3, model.nv)), np.zeros((3, model.nv))
    position, rotation, qpos = data.site_xpos[site], data.site_xmat[site], data.qpos

    def fk(q: Array) -> Arrays:
        qpos[:] = q
        mujoco.mj_kinematics(model, data)
        return position, rotation

    def fk_jacobian(q: Array) -> tuple[Arrays, Arrays]:
        qpos[:] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, linear, angular, site)
        return (position, rotation), (angular, linear)

    def pose(parts: Arrays) -> Array:
        T = np.eye(4)
        T[:3, 3], T[:3, :3] = parts[0], parts[1].reshape(3, 3)
        return T

    return Kinematics(
        "hybrid", fk, fk_jacobian, pose=pose, arrays=lambda T, J: (pose(T), np.concatenate(J)),
        note="position, rotation and the Jacobian's halves in arrays that are reused, no 4×4 and 6×n",
    )  # fmt: skip


def _text(chain: Chain) -> str:
    """The arm as MJCF: bodies that all stand in the base frame, so that joints are lines there, as
    screws are.
    """
    bodies = ""
    for screw in chain.screws:
        w, v = screw[:3], screw[3:]
        kind, axis, place = ("hinge", w, np.cross(w, v)) if np.any(w) else ("slide", v, np.zeros(3))
        bodies += '<body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        bodies += f'<joint type="{kind}" axis="{_numbers(axis)}" pos="{_numbers(place)}"/>'
    T = chain.home
    site = f'<site pos="{_numbers(T[:3, 3])}" xyaxes="{_numbers(T[:3, 0])} {_numbers(T[:3, 1])}"/>'
    return f"<mujoco><worldbody>{bodies}{site}{'</body>' * len(chain.screws)}</worldbody></mujoco>"


def _numbers(x: np.ndarray) -> str:
    return " ".join(f"{value:.17g}" for value in x)


PEER = Peer("MuJoCo", "mujoco", "mujoco", None, kinematics)
