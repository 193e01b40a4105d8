"""Derivatives of a chain's kinematics, over the engine's kernels.

All are with respect to q and in one of the three frames in which `jacobian` gives J: "space",
"body", "hybrid". A coupled chain is differentiated through x = C q + c.
"""

from __future__ import annotations

import math
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from ...checks import choice
from ...engine.jit.kernel import Kernel
from ...engine.kernels import derivative_kernels
from ...groups import se3
from ...groups.arrays import Array
from ..chain_data import ChainData
from .configurations import broadcast_rows, configurations
from .pose_jacobian import FRAME_CODES, FRAME_NAMES, Frame

Parameters = Literal["twist", "components"]
"""Parameters of a screw: the twist that moves it, or its six numbers."""


class PoseChanges(NamedTuple):
    """Change of the pose with the model: df f^-1, a space twist (ω; v), per unit of a parameter.

    Attributes
    ----------
    screws : (..., 6, n, 6) ndarray
        Change [..., :, i, e] with component e of joint i's six, in base axes, rad and m.
    home : (..., 6, 6) ndarray
        Change [..., :, e] with component e of the home pose's eta, M <- M e^eta.
    """

    screws: Array
    home: Array


class JacobianChanges(NamedTuple):
    """Change of the Jacobian with the model, per unit of each parameter of `PoseChanges`.

    Attributes
    ----------
    screws : (..., 6, m, n, 6) ndarray
        Change [..., :, k, i, e] of column k with component e of joint i's twist: rows (ω; v), rad/s
        and m/s, in the frame of that Jacobian.
    home : (..., 6, m, 6) ndarray
        Change [..., :, k, e] of column k with component e of the home pose's eta.
    """

    screws: Array
    home: Array


def jacobian_rate(chain: ChainData, q: Any, dq: Any, frame: Frame) -> Array:
    """dJ/dt (..., 6, m) along the rates dq."""
    code = _code(frame)
    batch, rows = broadcast_rows(chain, q=q, dq=dq)
    kernel = derivative_kernels.jacobian_rates
    return _results(kernel, chain, batch, (6, chain.dof), *rows, code)


def hessian(chain: ChainData, q: Any, frame: Frame) -> Array:
    """dJ/dq (..., 6, m, m), the column first, then the coordinate."""
    code = _code(frame)
    batch, rows = configurations(chain, q)
    kernel = derivative_kernels.hessians
    return _results(kernel, chain, batch, (6, chain.dof, chain.dof), rows, code)


def acceleration(
    chain: ChainData,
    q: Any,
    dq: Any,
    ddq: Any,
    frame: Frame,
) -> Array:
    """dV/dt (..., 6) = J ddq + (dJ/dt) dq."""
    code = _code(frame)
    batch, rows = broadcast_rows(chain, q=q, dq=dq, ddq=ddq)
    return _results(derivative_kernels.accelerations, chain, batch, (6,), *rows, code)


def joint_velocities(chain: ChainData, q: Any, dq: Any, frame: Frame) -> Array:
    """Twists (..., n, 6) of the joints' z-aligned frames."""
    code = _code(frame)
    batch, rows = broadcast_rows(chain, q=q, dq=dq)
    kernel = derivative_kernels.joint_velocities
    return _results(kernel, chain, batch, (len(chain.kinds), 6), *rows, code)


def _results(
    kernel: Kernel,
    chain: ChainData,
    batch: tuple[int, ...],
    shape: tuple[int, ...],
    *arguments: object,
) -> Array:
    """Results (*batch, *shape) of a kernel over rows; zeros of a chain without joints."""
    results = np.zeros((math.prod(batch), *shape))
    if chain.kinds:
        kernel.call(chain.kernel_table, *arguments, results)
    return results.reshape(*batch, *shape)


def screw_derivatives(chain: ChainData, q: Any, wrt: Parameters) -> PoseChanges:
    """Change of the pose with each screw and the home pose."""
    choice(wrt, get_args(Parameters), "wrt")
    batch, rows = configurations(chain, q)
    n = len(chain.kinds)
    D = np.zeros((len(rows), 6, n + 1, 6))
    kernel = derivative_kernels.pose_changes
    kernel.call(chain.kernel_table, chain.screws, _home_row(chain), rows, D)
    D = D.reshape(*batch, 6, n + 1, 6)
    motions = D[..., :n, :]
    home = D[..., n, :]
    if wrt == "twist" or not n:
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


def jacobian_screw_derivatives(chain: ChainData, q: Any, frame: Frame) -> JacobianChanges:
    """Change of the Jacobian with each screw and the home pose, each moved."""
    code = _code(frame)
    batch, rows = configurations(chain, q)
    n = len(chain.kinds)
    kernel = derivative_kernels.jacobian_changes
    shape = (6, chain.dof, n + 1, 6)
    D = _results(kernel, chain, batch, shape, chain.screws, _home_row(chain), rows, code)
    return JacobianChanges(
        D[..., :n, :].copy(),
        D[..., n, :].copy(),
    )


def _home_row(chain: ChainData) -> Array:
    """The twelve numbers of the home pose, as the kernels order them."""
    return np.concatenate(
        [
            chain.home[:3, :3].ravel(),
            chain.home[:3, 3],
        ]
    )


def _code(frame: object) -> int:
    choice(frame, FRAME_NAMES, "frame")
    return FRAME_CODES[frame]
