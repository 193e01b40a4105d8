"""Pinocchio, from Python: a compiled library with bindings; twists (v; omega)."""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST, PinocchioOracle, pinocchio

from .peer import Arm, Array, Arrays, Group, Kinematics, Peer


def group() -> Group:
    """exp6 takes an array; log6 takes a matrix and returns a Motion."""
    pin = pinocchio()
    return Group(
        lambda xi: pin.exp6(xi).homogeneous, lambda T: pin.log6(T).vector, linear_first=True
    )


def kinematics(arm: Arm) -> Kinematics:
    """`computeJointJacobians`, then frame placement and Jacobian: the faster of the two usual ways.

    The case panda_hand measures both ways. A continuous joint is (cos q, sin q) here, which
    `native` makes of q.
    """
    pin, oracle = pinocchio(), PinocchioOracle(arm.urdf)
    model, data, axes = oracle.model, oracle.data, pin.LOCAL_WORLD_ALIGNED
    tip = model.getFrameId(arm.chain.tip, pin.FrameType.BODY)
    order = [model.joints[model.getJointId(name)].idx_v for name in arm.chain.q_names]

    def fk(q: Array) -> Array:
        pin.forwardKinematics(model, data, q)
        return pin.updateFramePlacement(model, data, tip).homogeneous

    def fk_jacobian(q: Array) -> Arrays:
        pin.computeJointJacobians(model, data, q)
        T = pin.updateFramePlacement(model, data, tip).homogeneous
        return T, pin.getFrameJacobian(model, data, tip, axes)

    def native(q: Array) -> list[Array]:
        return list(oracle.configurations(dict(zip(arm.chain.q_names, q.T, strict=True))))

    def arrays(T: Array, J: Any) -> Arrays:
        # With one degree of freedom Pinocchio's Python hands out a vector.
        return T, np.reshape(J, (6, model.nv))[np.ix_(ANGULAR_FIRST, order)]

    return Kinematics("hybrid", fk, fk_jacobian, arrays=arrays, native=native)


PEER = Peer("Pinocchio", "pin", "pinocchio", group, kinematics)
