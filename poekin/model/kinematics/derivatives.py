"""Derivatives of a chain's kinematics, over the engine's kernels.

All are with respect to q and in one of the three frames in which `jacobian` gives J: "space",
"body", "hybrid". A coupled chain is differentiated through x = C q + c.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...engine.kernels import derivative_kernels
from ...errors import InputError, ShapeError, safe_repr
from ...groups import se3
from ...groups.arrays import Array
from ..chain_data import ChainData
from ..coordinates import coordinates
from .pose_jacobian import FRAME_CODES


class PoseChanges(NamedTuple):
    """Change of the pose with the model: df f^-1, a space twist (omega; v), per unit of each
    parameter.

    Rows in base axes, rad and m.
    screws (..., 6, n, 6): [..., :, i, e] of component e of joint i's six; home (..., 6, 6): of
    component e of the home pose's eta, M <- M e^eta.
    """

    screws: Array
    home: Array


class JacobianChanges(NamedTuple):
    """Change of the Jacobian with the model, per unit of each parameter of `PoseChanges`.

    Rows (omega; v), rad/s and m/s, in the frame of that Jacobian.
    screws (..., 6, m, n, 6): [..., :, k, i, e] is the change of column k; home (..., 6, m, 6).
    """

    screws: Array
    home: Array


def jacobian_rate(chain: ChainData, q: Any, dq: Any, frame: str) -> Array:
    """dJ/dt (..., 6, m) along the rates dq."""
    code = _code(frame)
    batch, (rows, rates) = _together(chain, q=q, dq=dq)
    dJ = np.zeros((len(rows), 6, chain.dof))
    if chain.joint_names:
        derivative_kernels.jacobian_rates.call(chain.kernel_table, rows, rates, code, dJ)
    return dJ.reshape(*batch, 6, chain.dof)


def hessian(chain: ChainData, q: Any, frame: str) -> Array:
    """dJ/dq (..., 6, m, m), the column first, then the coordinate."""
    code = _code(frame)
    batch, (rows,) = _together(chain, q=q)
    H = np.zeros((len(rows), 6, chain.dof, chain.dof))
    if chain.joint_names:
        derivative_kernels.hessians.call(chain.kernel_table, rows, code, H)
    return H.reshape(*batch, 6, chain.dof, chain.dof)


def acceleration(chain: ChainData, q: Any, dq: Any, ddq: Any, frame: str) -> Array:
    """dV/dt (..., 6) = J ddq + (dJ/dt) dq."""
    code = _code(frame)
    batch, (rows, rates, accelerations) = _together(chain, q=q, dq=dq, ddq=ddq)
    A = np.zeros((len(rows), 6))
    if chain.joint_names:
        derivative_kernels.accelerations.call(
            chain.kernel_table, rows, rates, accelerations, code, A
        )
    return A.reshape(*batch, 6)


def joint_velocities(chain: ChainData, q: Any, dq: Any, frame: str) -> Array:
    """Twists (..., n, 6) of the joints' z-aligned frames."""
    code = _code(frame)
    batch, (rows, rates) = _together(chain, q=q, dq=dq)
    n = len(chain.joint_names)
    V = np.zeros((len(rows), n, 6))
    if n:
        derivative_kernels.joint_velocities.call(chain.kernel_table, rows, rates, code, V)
    return V.reshape(*batch, n, 6)


def screw_derivatives(chain: ChainData, q: Any, by: str = "motion") -> PoseChanges:
    """Change of the pose with each screw and the home pose."""
    if not isinstance(by, str) or by not in ("motion", "entries"):
        raise InputError(f"by: expected 'motion' or 'entries', got {safe_repr(by)}")
    batch, (rows,) = _together(chain, q=q)
    n = len(chain.joint_names)
    D = np.zeros((len(rows), 6, n + 1, 6))
    derivative_kernels.pose_changes.call(
        chain.kernel_table, chain.screws, _home_row(chain), rows, D
    )
    D = D.reshape(*batch, 6, n + 1, 6)
    motions = D[..., :n, :]
    home = D[..., n, :]
    if by == "motion" or not n:
        return PoseChanges(motions.copy(), home.copy())
    # Ad(P_{i-1}) is what is left of the space twist of the home pose when the joints from i on are
    # taken back.
    C = chain.nontrivial_coupling
    x = rows if C is None else rows @ C.T
    x = (x + chain.offset).reshape(*batch, n, 1)
    by_joint = np.moveaxis(motions, -2, -3)
    before = np.eye(6) - np.cumsum(by_joint, axis=-3) + by_joint
    entries = before @ (se3.left_jacobian(chain.screws * x) * x[..., None])
    return PoseChanges(np.moveaxis(entries, -3, -2).copy(), home.copy())


def jacobian_screw_derivatives(chain: ChainData, q: Any, frame: str) -> JacobianChanges:
    """Change of the Jacobian with each screw and the home pose, each moved."""
    code = _code(frame)
    batch, (rows,) = _together(chain, q=q)
    n = len(chain.joint_names)
    m = chain.dof
    D = np.zeros((len(rows), 6, m, n + 1, 6))
    if n:
        derivative_kernels.jacobian_changes.call(
            chain.kernel_table, chain.screws, _home_row(chain), rows, code, D
        )
    D = D.reshape(*batch, 6, m, n + 1, 6)
    return JacobianChanges(D[..., :n, :].copy(), D[..., n, :].copy())


def _home_row(chain: ChainData) -> Array:
    """The twelve numbers of the home pose, as the kernels order them."""
    return np.concatenate([chain.home[:3, :3].ravel(), chain.home[:3, 3]])


def _code(frame: object) -> int:
    if isinstance(frame, str) and frame in FRAME_CODES:
        return FRAME_CODES[frame]
    raise InputError(f"frame: expected 'space', 'body' or 'hybrid', got {safe_repr(frame)}")


def _together(chain: ChainData, **given: Any) -> tuple[tuple[int, ...], list[Array]]:
    """The common batch shape of configurations, rates, ... and each as rows (N, m)."""
    arrays = [coordinates(value, chain.q_names, name) for name, value in given.items()]
    try:
        shape = np.broadcast_shapes(*(a.shape for a in arrays))
    except ValueError as error:
        shapes = ", ".join(str(a.shape) for a in arrays)
        raise ShapeError(f"{', '.join(given)} do not broadcast: shapes {shapes}") from error
    batch = shape[:-1]
    rows = [np.broadcast_to(a, shape).reshape(math.prod(batch), chain.dof) for a in arrays]
    return batch, rows
