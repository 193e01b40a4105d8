"""Poses, Jacobians and velocities of a chain: what `Chain` offers as methods, over the engine's
kernels.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ...engine.kernels import chain_kernels
from ...errors import InputError, ShapeError, UnknownName, quote
from ...groups import se3, so3
from ...groups.arrays import Array, shaped
from ..coordinates import coordinates

if TYPE_CHECKING:
    from ..chain import Chain
    from .compiled import CompiledChain

FRAME_NAMES = ("space", "body", "hybrid")
_FRAMES: dict[object, int] = {
    "space": chain_kernels.SPACE,
    "body": chain_kernels.BODY,
    "hybrid": chain_kernels.HYBRID,
}
# Names looked up once: one call for a pose and a Jacobian takes about a microsecond in all.
_ndarray, _float64, _empty, _POSE_SHAPE = np.ndarray, np.dtype(np.float64), np.empty, (4, 4)
_pose_jacobian_one, _pose_one = chain_kernels.pose_jacobian_one, chain_kernels.pose_one


def fk(self: Chain, q: Any, *, out: Array | None = None) -> Array:
    """Forward kinematics: T_sb = f(q) = e^{A_1 x_1} ... e^{A_n x_n} M with x = C q + c.

    Parameters: q (..., m) in the order of `q_names`, rad or m, or a dict name -> value; out, a
    C-contiguous float64 array of the result's shape to write into. Returns: T_sb (..., 4, 4), the
    pose of the tip in the base frame, m.
    NaN in a configuration gives NaN in its pose. Raises: ShapeError, UnknownName, InputError.
    Accuracy: for up to 20 joints, a turn and 1 m each, within 2e-14 reach
    (tests/analysis/test_validate.py, against Pinocchio); in general within u (8 (n + 1) + 4 sum
    |x|) (reach + sum |s|), u = 2^-53, s what a prismatic or
    helical joint slides (tests/model/test_chain_laws.py, tests/model/test_pitches.py).
    Source: Park 1994, eq. (1), by the local form of Section IV.
    """
    if type(q) is _ndarray and q.dtype is _float64 and q.shape == self._one:
        T = _empty(_POSE_SHAPE) if out is None else _checked_out(out, _POSE_SHAPE, "out", q)
        _pose_one.call(self._table, q, T)
        return T
    return fk_of_many(self, q, out)


def fk_jacobian(
    self: Chain,
    q: Any,
    frame: str | int,
    *,
    at: ArrayLike | None = None,
    out: tuple[Array, Array] | None = None,
) -> tuple[Array, Array]:
    """Pose and Jacobian in one pass: those of `fk` and `jacobian`.

    Parameters: as `jacobian`; out = (T, J), arrays to write into. Returns: T_sb (..., 4, 4), J
    (..., 6, m).
    Raises, accuracy, source: as `fk` and `jacobian`.
    """
    plain = type(q) is _ndarray and q.dtype is _float64 and q.shape == self._one
    if plain and at is None and type(frame) is str and frame in _FRAMES:
        if out is None:
            T, J = _empty(_POSE_SHAPE), _empty(self._jacobian_shape)
        else:
            T, J = _checked_pair(out, _POSE_SHAPE, self._jacobian_shape, q)
        _pose_jacobian_one.call(self._table, q, _FRAMES[frame], T, J)
        return T, J
    return fk_jacobian_of_many(self, q, frame, at, out)


def jacobian(
    self: Chain, q: Any, frame: str | int, *, at: ArrayLike | None = None, out: Array | None = None
) -> Array:
    """Jacobian J(q) with V = J dq, rows (omega; v), in the frame that is named at every call.

    - "space": V_s = f' f^-1, base axes, velocity of the tool's point that passes the base origin
    - "body": V_b = f^-1 f', tool axes, velocity of the tool's origin
    - "hybrid": base axes, velocity of the tool's origin (Pinocchio's LOCAL_WORLD_ALIGNED)
    - k: the twist of the tool in the z-aligned frame of joint k (0 ... n - 1, see `joint_poses`),
      which moves with it

    Parameters: q (..., m) or a dict, as `fk`; frame; at, a point (3,) of the tool in its own frame
    (m), whose velocity is meant instead of its origin's ("body" and "hybrid" only); out, an array
    to write into.
    Returns: J (..., 6, m): rad/s and m/s per unit of dq. Raises: ShapeError, UnknownName,
    InputError.
    Accuracy: as `fk` (tests/analysis/test_validate.py, tests/model/test_chain_laws.py).
    Source: Park 1994, Section III, "The Jacobian".
    """
    if out is None and (at is not None or (type(q) is _ndarray and q.ndim == 1)):
        return fk_jacobian(self, q, frame, at=at)[1]  # the shorter way in for one configuration
    return jacobian_of_many(self, q, frame, at, out)


def velocity(self: Chain, q: Any, dq: Any, frame: str | int) -> Array:
    """Twist V = J(q) dq of the tool by the paper's V recursion, without forming J.

    Parameters: q, dq (..., m), broadcast against each other; frame as in `jacobian`. Returns: V
    (..., 6), rad/s, m/s. Raises: ShapeError, UnknownName, InputError.
    Accuracy: that of `fk` times (n + 1) |C dq|, n the joints (tests/model/test_chain_laws.py).
    Source: Park 1994, Section IV; the recursion yields the body velocity, the other frames are
    reached from it.
    """
    code = self._frame_code(frame)
    q, dq = coordinates(q, self.q_names), coordinates(dq, self.q_names, "dq")
    try:
        batch = np.broadcast_shapes(q.shape, dq.shape)
    except ValueError as error:
        raise ShapeError(f"q and dq do not broadcast: shapes {q.shape} and {dq.shape}") from error
    q, dq = np.broadcast_to(q, batch), np.broadcast_to(dq, batch)
    batch, rows = _rows(self, q)
    V = np.empty((len(rows), 6))
    chain_kernels.body_velocity.call(self._table, rows, dq.reshape(len(rows), self.dof), V)
    V = V.reshape(*batch, 6)
    if code == chain_kernels.BODY:
        return V
    T = self.fk(q)
    if code == chain_kernels.HYBRID:
        R = T[..., :3, :3]
        return np.concatenate(
            [(R @ V[..., :3, None])[..., 0], (R @ V[..., 3:, None])[..., 0]], axis=-1
        )
    if code != chain_kernels.SPACE:
        T = se3.inverse(self.joint_poses(q)[..., code, :, :]) @ T
    return (se3.adjoint(T) @ V[..., None])[..., 0]


def joint_poses(self: Chain, q: Any) -> Array:
    """Poses of the joints' z-aligned frames in the base frame, moved: f_k = M_1 e^{S x_1} ... M_k
    e^{S x_k}.

    Parameters: q (..., m) or a dict, as `fk`. Returns: (..., n, 4, 4), m. Raises: ShapeError,
    UnknownName, InputError. Accuracy: as `fk`. Source: Park 1994, Section IV; the frames are those
    of `Chain.local`.
    """
    batch, rows = _rows(self, q)
    T = np.empty((len(rows), len(self.joint_names), 4, 4))
    chain_kernels.joint_poses.call(self._table, rows, T)
    return T.reshape(*batch, len(self.joint_names), 4, 4)


def fk_of_many(arm: Chain | CompiledChain, q: Any, out: Array | None) -> Array:
    """`fk` of whatever a user may give as q."""
    batch, rows = _rows(arm, q)
    T = _empty((*batch, 4, 4)) if out is None else _checked_out(out, (*batch, 4, 4), "out", q)
    arm._fill_poses(rows, T.reshape(len(rows), 4, 4))
    return T


def fk_jacobian_of_many(
    arm: Chain | CompiledChain,
    q: Any,
    frame: str | int,
    at: ArrayLike | None,
    out: tuple[Array, Array] | None,
) -> tuple[Array, Array]:
    """`fk_jacobian` of whatever a user may give as q."""
    code, point, (batch, rows) = arm._frame_code(frame), _point(frame, at), _rows(arm, q)
    shapes = (*batch, 4, 4), (*batch, 6, arm.dof)
    T, J = (_empty(shapes[0]), _empty(shapes[1])) if out is None else _checked_pair(out, *shapes, q)
    arm._fill_both(rows, code, T.reshape(len(rows), 4, 4), J.reshape(len(rows), 6, arm.dof))
    if point is not None:
        _move(J, point, None if frame == "body" else T)
    return T, J


def jacobian_of_many(
    arm: Chain | CompiledChain, q: Any, frame: str | int, at: ArrayLike | None, out: Array | None
) -> Array:
    """`jacobian` of whatever a user may give as q."""
    code, point, (batch, rows) = arm._frame_code(frame), _point(frame, at), _rows(arm, q)
    shape = (*batch, 6, arm.dof)
    J = _empty(shape) if out is None else _checked_out(out, shape, "out", q)
    if point is None:
        arm._fill_jacobians(rows, code, J.reshape(len(rows), 6, arm.dof))
    else:
        fk_jacobian_of_many(
            arm, rows.reshape(*batch, arm.dof), frame, at, (_empty((*batch, 4, 4)), J)
        )
    return J


def fill_poses(self: Chain, rows: Array, T: Array) -> None:
    """The poses of configurations (N, m) into T (N, 4, 4)."""
    chain_kernels.pose_many.call(self._table, rows, T)


def fill_both(self: Chain, rows: Array, code: int, T: Array, J: Array) -> None:
    """The poses into T, and the Jacobians in the frame of that code into J (N, 6, m)."""
    chain_kernels.pose_jacobian_many.call(self._table, rows, code, T, J)


def fill_jacobians(self: Chain, rows: Array, code: int, J: Array) -> None:
    """The Jacobians in the frame of that code into J (N, 6, m)."""
    chain_kernels.pose_jacobian_many.call(self._table, rows, code, _empty((1, *_POSE_SHAPE)), J)


def _rows(chain: Chain | CompiledChain, q: Any) -> tuple[tuple[int, ...], Array]:
    """The batch shape of q and its configurations as rows."""
    q = coordinates(q, chain.q_names)
    return q.shape[:-1], q.reshape(math.prod(q.shape[:-1]), chain.dof)


def frame_code(self: Chain, frame: object) -> int:
    """What a frame is to the kernels."""
    return (
        _FRAMES[frame] if isinstance(frame, str) and frame in _FRAMES else joint_index(self, frame)
    )


def _point(frame: str | int, at: ArrayLike | None) -> Array | None:
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


def _move(J: Array, p: Array, T: Array | None) -> None:
    """v += omega x p in the tool's axes, or omega x R p in those of the base with T = (R, .), of
    every column.
    """
    arm = p if T is None else T[..., :3, :3] @ p
    J[..., 3:, :] -= so3.hat(arm) @ J[..., :3, :]


def joint_index(chain: Chain, frame: object) -> int:
    """The index of the joint whose frame is meant."""
    n = len(chain.joint_names)
    if isinstance(frame, str):
        raise UnknownName(
            f"frame: expected 'space', 'body', 'hybrid' or the index of a joint, got {quote(frame)}"
        )
    if not isinstance(frame, (int, np.integer)) or isinstance(frame, bool) or not 0 <= frame < n:
        raise InputError(
            f"frame: expected 'space', 'body', 'hybrid' or the index of a joint, 0 to {n - 1}, got {frame!r}"
            if n
            else f"frame: expected 'space', 'body' or 'hybrid' (the chain has no joint), got {frame!r}"
        )
    return int(frame)


def _checked_out(out: Any, shape: tuple[int, ...], what: str, q: Any) -> Array:
    """`out` itself where a kernel can write into it while it reads q."""
    if type(out) is not _ndarray or out.dtype != _float64 or out.shape != shape:
        got = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise ShapeError(f"{what}: expected a float64 array of shape {shape}, got {got}")
    if not (out.flags.carray and out.dtype.isnative):
        raise InputError(f"{what}: expected a C-contiguous, writable, aligned array")
    if _overlap(out, q):
        raise InputError(
            f"{what}: it shares memory with q, which would be overwritten while it is read"
        )
    return out


def _checked_pair(
    out: Any, T_shape: tuple[int, ...], J_shape: tuple[int, ...], q: Any
) -> tuple[Array, Array]:
    if not isinstance(out, (tuple, list)) or len(out) != 2:
        raise InputError(f"out: expected a pair of arrays (T, J), got {type(out).__name__}")
    T, J = _checked_out(out[0], T_shape, "out[0]", q), _checked_out(out[1], J_shape, "out[1]", q)
    if _overlap(T, J):
        raise InputError("out: T and J share memory")
    return T, J


def _overlap(a: Array, b: Any) -> bool:
    """Whether two arrays may share memory; at once for one that has its own and that the other is
    no view of.
    """
    return (
        isinstance(b, np.ndarray)
        and not (a.base is None and b.base is not a)
        and np.may_share_memory(a, b)
    )
