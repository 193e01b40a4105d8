"""Poses, Jacobians and velocities of a chain, for any q that a user may give.

The kernels are those of any chain, or, of a compiled chain, those made for its numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import REQUIRED, is_whole
from ...engine.kernels import chain_kernels
from ...errors import InputError, quote
from ...groups import se3, so3
from ...groups.arrays import Array, shaped
from ..chain_data import ChainData
from .configurations import broadcast_rows, configurations
from .outputs import checked_out, checked_pair

Frame = Literal["space", "body", "hybrid"]
AnyFrame = Frame | Literal["cheapest"] | int
FRAME_NAMES: tuple[Frame, ...] = get_args(Frame)
FRAME_CODES: dict[object, int] = {
    "space": chain_kernels.SPACE,
    "body": chain_kernels.BODY,
    "hybrid": chain_kernels.HYBRID,
}
_OF_PINOCCHIO = {"WORLD": "space", "LOCAL": "body", "LOCAL_WORLD_ALIGNED": "hybrid"}


Fill = Callable[[Array, int | None, Array | None, Array | None], None]
"""Writes the poses of configurations (N, m) into T (N, 4, 4), and their Jacobians in the frame of a
code into J (N, 6, m), where these are given.
"""


def _fill(
    chain: ChainData,
    rows: Array,
    code: int | None,
    T: Array | None,
    J: Array | None,
) -> None:
    """A `Fill` of Jacobians by the kernel of any chain."""
    if T is None:
        T = np.empty((1, 4, 4))  # scratch, used again and again
    chain_kernels.pose_jacobian_many.call(chain.kernel_table, rows, code, T, J)


def fk(
    chain: ChainData,
    q: Any,
    out: Array | None = None,
    fill: Fill | None = None,
) -> Array:
    """Poses T_sb (..., 4, 4) of the tip."""
    batch, rows = configurations(chain, q)
    shape = (*batch, 4, 4)
    T = np.empty(shape) if out is None else checked_out(out, shape, "out", q)
    T_rows = T.reshape(len(rows), 4, 4)
    if fill is None:
        chain_kernels.pose_many.call(chain.kernel_table, rows, T_rows)
    else:
        fill(rows, None, T_rows, None)
    return T


def fk_jacobian(
    chain: ChainData,
    q: Any,
    frame: AnyFrame,
    at: ArrayLike | None = None,
    out: tuple[Array, Array] | None = None,
    code: int | None = None,
    fill: Fill | None = None,
) -> tuple[Array, Array]:
    """Poses T_sb (..., 4, 4) and Jacobians J (..., 6, m) in one pass."""
    if code is None:
        code = frame_code(chain, frame)
    point = _point(frame, at)
    batch, rows = configurations(chain, q)
    T_shape = (*batch, 4, 4)
    J_shape = (*batch, 6, chain.dof)
    if out is None:
        T = np.empty(T_shape)
        J = np.empty(J_shape)
    else:
        T, J = checked_pair(out, T_shape, J_shape, q)
    fill = fill or partial(_fill, chain)
    fill(
        rows,
        code,
        T.reshape(len(rows), 4, 4),
        J.reshape(len(rows), 6, chain.dof),
    )
    if point is not None:
        _move(J, point, frame, T)
    return T, J


def jacobian(
    chain: ChainData,
    q: Any,
    frame: AnyFrame,
    at: ArrayLike | None = None,
    out: Array | None = None,
    code: int | None = None,
    fill: Fill | None = None,
) -> Array:
    """Jacobians J (..., 6, m) in a frame."""
    if code is None:
        code = frame_code(chain, frame)
    point = _point(frame, at)
    batch, rows = configurations(chain, q)
    shape = (*batch, 6, chain.dof)
    J = np.empty(shape) if out is None else checked_out(out, shape, "out", q)
    J_rows = J.reshape(len(rows), 6, chain.dof)
    fill = fill or partial(_fill, chain)
    if point is None:
        fill(rows, code, None, J_rows)
        return J
    T = np.empty((*batch, 4, 4))
    fill(rows, code, T.reshape(len(rows), 4, 4), J_rows)
    _move(J, point, frame, T)
    return J


def velocity(
    chain: ChainData,
    q: Any,
    dq: Any,
    frame: Frame | int,
) -> Array:
    """Twists V (..., 6) of the tool by the paper's recursion for the body velocity."""
    code = frame_code(chain, frame)
    batch, (rows, rates) = broadcast_rows(chain, q=q, dq=dq)
    V = np.zeros((len(rows), 6))
    if chain.kinds:
        chain_kernels.body_velocity.call(chain.kernel_table, rows, rates, V)
    if code != chain_kernels.BODY:
        V = _in_frame(chain, rows, code, V)
    return V.reshape(*batch, 6)


def _in_frame(chain: ChainData, rows: Array, code: int, V: Array) -> Array:
    """Body twists (N, 6) in another frame, at configurations (N, m)."""
    T = np.empty((len(rows), 4, 4))
    chain_kernels.pose_many.call(chain.kernel_table, rows, T)
    if code == chain_kernels.HYBRID:
        R = T[:, :3, :3]
        return (R[:, None] @ V.reshape(-1, 2, 3, 1)).reshape(V.shape)
    if code != chain_kernels.SPACE:
        T = se3.inverse(joint_poses(chain, rows)[:, code]) @ T
    return (se3.adjoint(T) @ V[..., None])[..., 0]


def joint_poses(chain: ChainData, q: Any) -> Array:
    """Poses (..., n, 4, 4) of the joints' z-aligned frames, moved."""
    batch, rows = configurations(chain, q)
    n = len(chain.joint_names)
    T = np.empty((len(rows), n, 4, 4))
    chain_kernels.joint_poses.call(chain.kernel_table, rows, T)
    return T.reshape(*batch, n, 4, 4)


def frame_code(chain: ChainData, frame: object) -> int:
    """Code of a frame in the kernels; a joint's is its index."""
    if isinstance(frame, str) and frame in FRAME_CODES:
        return FRAME_CODES[frame]
    n = len(chain.joint_names)
    if isinstance(frame, str):
        own = _OF_PINOCCHIO.get(frame.upper())
        hint = f" (Pinocchio's {frame.upper()} is {own!r})" if own else ""
        raise InputError(
            f"frame: expected 'space', 'body', 'hybrid' or the index of a joint, got {quote(frame)}{hint}"
        )
    if is_whole(frame, 0) and frame < n:
        return int(frame)
    expected = "'space', 'body' or 'hybrid' (the chain has no joint)"
    if n:
        expected = f"'space', 'body', 'hybrid' or the index of a joint, 0 to {n - 1}"
    got = "it was left out" if frame is REQUIRED else f"got {frame!r}"
    raise InputError(f"frame: expected {expected}, {got}")


def _point(frame: AnyFrame, at: ArrayLike | None) -> Array | None:
    """The point of the tool whose velocity is meant, or None for its origin."""
    if at is None:
        return None
    if not isinstance(frame, str) or frame not in ("body", "hybrid"):
        raise InputError(
            f"at: a point of the tool matters in the frames 'body' and 'hybrid' only, got frame {frame!r}"
        )
    p = shaped(at, (3,), "at")
    if p.ndim != 1 or not np.isfinite(p).all():
        raise InputError(f"at: expected one finite point (3,), got {at!r:.80}")
    return p


def _move(J: Array, p: Array, frame: AnyFrame, T: Array) -> None:
    """v += omega x p of every column, with p in the axes of the frame, tool ("body") or base."""
    if frame != "body":
        p = T[..., :3, :3] @ p
    J[..., 3:, :] -= so3.hat(p) @ J[..., :3, :]
