"""Pinocchio as an oracle of derivatives: rate and Hessian of the Jacobian, and acceleration, of a
chain of a URDF.

What `PinocchioOracle` is for poses and Jacobians, by functions of the same model and under the same
names.
Source: Pinocchio, https://github.com/stack-of-tasks/pinocchio, release 4.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from poekin.errors import InputError
from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST, PinocchioOracle, pinocchio

FREE_OF = 1e-12  # entries of a Jacobian below it are rounding


class Derivatives(NamedTuple):
    """Derivatives at N configurations and rates of all m coordinates, by "space", "body", "hybrid".

    Attributes
    ----------
    rate : dict
        Rate of the Jacobian (N, 6, m), in each frame.
    hessian : dict
        Hessian (N, 6, m, m), column, then coordinate, in each frame.
    acceleration : dict
        Acceleration (N, 6), rad/s² and m/s², in each frame.
    """

    rate: dict[str, np.ndarray]
    hessian: dict[str, np.ndarray]
    acceleration: dict[str, np.ndarray]


def derivatives(
    oracle: PinocchioOracle,
    q: Mapping[str, np.ndarray],
    dq: np.ndarray,
    ddq: np.ndarray,
    tip: str,
    base: str | None = None,
) -> Derivatives:
    """Derivatives of the motion of `tip` in `base` at N configurations, rates and accelerations.

    The rate is getFrameJacobianTimeVariation and the Hessian getFrameKinematicHessian, in WORLD,
    LOCAL and LOCAL_WORLD_ALIGNED. The acceleration is getFrameAcceleration in WORLD and LOCAL, and
    for hybrid getFrameClassicalAcceleration.

    Parameters
    ----------
    oracle : PinocchioOracle
        The robot.
    q : dict
        Values (N,) for each of the coordinates of the oracle, rad or m.
    dq, ddq : (N, m) ndarray
        Rates and accelerations in the order of these, rad or m per s, and per s².
    tip : str
        Name of the link that moves.
    base : str, optional
        Link in whose frame it does, the root by default. It must stand still in the root: a
        coordinate that moves it gets a column of zeros.

    Returns
    -------
    derivatives : Derivatives
        The derivatives, to Pinocchio's own rounding.

    Raises
    ------
    UnknownName
        For a name that is no coordinate, or no link.
    InputError
        If the base moves, and as `PinocchioOracle.configurations`.
    """
    pin = pinocchio()
    model = oracle.model
    data = oracle.data
    configurations = oracle.configurations(q)
    count, m = dq.shape
    velocity = [model.joints[i].idx_v for i in oracle.simple_joints.values()]
    C = np.zeros((model.nv, m))
    C[velocity] = oracle.coupling
    tip_id = oracle.frame_id(tip)
    result = Derivatives(
        {f: np.zeros((count, 6, m)) for f in _REFERENCES},
        {f: np.zeros((count, 6, m, m)) for f in _REFERENCES},
        {f: np.zeros((count, 6)) for f in _REFERENCES},
    )
    if model.nv == 0:
        return result
    for k, configuration in enumerate(configurations):
        v = C @ dq[k]
        a = C @ ddq[k]
        pin.computeJointJacobians(model, data, configuration)
        T_0b, still = _base(oracle, base, C, dq[k], ddq[k])
        pin.computeJointKinematicHessians(model, data, configuration)
        pin.computeJointJacobiansTimeVariation(model, data, configuration, v)
        pin.forwardKinematics(model, data, configuration, v, a)
        pin.updateFramePlacements(model, data)
        for name, reference in _REFERENCES.items():
            frame = reference(pin)
            turn = _turn(name, T_0b)[ANGULAR_FIRST]
            dJ = pin.getFrameJacobianTimeVariation(model, data, tip_id, frame).reshape(6, model.nv)
            result.rate[name][k] = (turn @ dJ @ C) * still
            H = _tensor(pin.getFrameKinematicHessian(model, data, tip_id, frame))
            turned = np.tensordot(turn, C.T @ H @ C, 1)
            result.hessian[name][k] = turned * still[:, None] * still
            rate_of = pin.getFrameAcceleration
            if name == "hybrid":
                rate_of = pin.getFrameClassicalAcceleration
            result.acceleration[name][k] = turn @ rate_of(model, data, tip_id, frame).vector
    return result


_REFERENCES = {
    "space": lambda pin: pin.WORLD,
    "body": lambda pin: pin.LOCAL,
    "hybrid": lambda pin: pin.LOCAL_WORLD_ALIGNED,
}


def _tensor(X: np.ndarray) -> np.ndarray:
    """Pinocchio's tensor: its Python hands out the numbers column by column, with the strides of an
    array by rows.
    """
    return X.ravel(order="K").reshape(X.shape, order="F")


def _turn(frame: str, T_0b: Any) -> np.ndarray:
    """Matrix from twists (v; omega) seen from the root to those seen from a base at rest."""
    if T_0b is None or frame == "body":
        return np.eye(6)
    if frame == "space":
        return T_0b.toActionMatrixInverse()
    return np.kron(np.eye(2), T_0b.rotation.T)


def _base(
    oracle: PinocchioOracle,
    base: str | None,
    C: np.ndarray,
    dq: np.ndarray,
    ddq: np.ndarray,
) -> tuple[Any, np.ndarray]:
    """The pose of the base, and 1 for each coordinate that leaves it where it is, 0 for others
    (m,).
    """
    pin = pinocchio()
    model = oracle.model
    data = oracle.data
    if base is None:
        return None, np.ones(len(dq))
    base_id = oracle.frame_id(base)
    T_0b = pin.updateFramePlacement(model, data, base_id).copy()
    drag = pin.getFrameJacobian(model, data, base_id, pin.LOCAL).reshape(6, model.nv) @ C
    moves = np.abs(drag).max(axis=0, initial=0.0) > FREE_OF
    if np.any(dq[moves]) or np.any(ddq[moves]):
        raise InputError(f"the base {base!r} moves: rates of 0 expected for what moves it")
    return T_0b, np.where(moves, 0.0, 1.0)
