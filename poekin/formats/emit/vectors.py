"""Configurations with poses and Jacobians from the chain's general kernels: what an emitted
self-test compares to.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...groups import se3
from ...groups.arrays import Array
from ...model.kinematics.compiled import CompiledChain
from ...model.kinematics.pose_jacobian import AnyFrame
from ...model.sampling import angle_mask
from .messages import jacobian_frame

COUNT = 8


class Vectors(NamedTuple):
    """Coordinates q (N, m), poses T, Jacobians J (N, 6, m), and the error allowed (m, 1 or m/rad)."""

    q: Array
    T: Array
    J: Array
    tolerance: float


def vectors(
    arm: CompiledChain,
    frame: AnyFrame,
    kind: type[np.floating],
) -> Vectors:
    """Test vectors at coordinates that numbers of that kind hold exactly: zero, and seven within
    half a turn (or 1 m).

    The tolerance is twice the bound of `Chain.fk` with the kind's own unit roundoff: once for what
    is computed, once for what is compared to, or, in single precision, for the arm's constants,
    which are rounded too.
    """
    chain = arm.chain
    size = np.where(angle_mask(chain), np.pi, 1.0)
    rng = np.random.default_rng(1994)
    q = rng.uniform(-size, size, (COUNT, chain.dof))
    q[0] = 0.0
    q = q.astype(kind).astype(float)
    if frame in ("space", "body", "hybrid"):
        T, J = chain.fk_jacobian(q, frame)
    else:
        k, T_k = jacobian_frame(arm, frame)
        T, J = chain.fk_jacobian(q, k)
        J = se3.adjoint(se3.inverse(T_k)) @ J
    moved = np.abs(q @ chain.coupling.T + chain.offset)
    x = moved.sum(axis=1).max()
    roundoff = float(np.finfo(kind).eps) / 2
    steps = 8 * (len(chain.kinds) + 1) + 4 * float(x)
    tolerance = 2 * roundoff * steps * chain.reach
    return Vectors(q, T, J, tolerance)
