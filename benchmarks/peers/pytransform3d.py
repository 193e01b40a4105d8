"""pytransform3d: exp and log of whole arrays, twists (omega; v); poses of a URDF's frames, and no Jacobian."""

from __future__ import annotations

import numpy as np

from .peer import Arm, Array, Group, Kinematics, Peer, module


def group() -> Group:
    """Its functions for trajectories, which take batches."""
    trajectories = module("pytransform3d.trajectories")
    return Group(
        trajectories.transforms_from_exponential_coordinates,
        trajectories.exponential_coordinates_from_transforms,
        linear_first=False,
        batch=True,
    )


def kinematics(arm: Arm) -> Kinematics:
    """A transform manager with the URDF's joints, which it keeps within their limits."""
    manager = module("pytransform3d.urdf").UrdfTransformManager(check=False)
    manager.load_urdf(arm.urdf)
    names, tip, base = arm.chain.q_names, arm.chain.tip, arm.chain.base

    def fk(q: Array) -> Array:
        for name, value in zip(names, q, strict=True):
            manager.set_joint(name, value)
        return manager.get_transform(tip, base)

    return Kinematics("hybrid", fk, None, pose=np.asarray)


PEER = Peer("pytransform3d", "pytransform3d", "pytransform3d", group, kinematics)
