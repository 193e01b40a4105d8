"""pytransform3d: exp and log of one pose, twists (omega; v); poses of a URDF's frames, and no
Jacobian.
"""

from __future__ import annotations

import numpy as np

from .peer import Arm, Array, Group, Kinematics, Peer, module


def group() -> Group:
    """Its functions of one argument; those for batches, in `trajectories`, have other formulas and
    lose digits.
    """
    transformations = module("pytransform3d.transformations")
    return Group(
        transformations.transform_from_exponential_coordinates,
        transformations.exponential_coordinates_from_transform,
        linear_first=False,
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
