"""Derivatives of a chain's kinematics: what `Chain` offers as methods, over the engine's kernels.

All are with respect to q and in one of the three frames in which `jacobian` gives J: "space",
"body", "hybrid". A coupled chain is differentiated through x = C q + c.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...engine.kernels import chain_kernels, derivative_kernels
from ...errors import InputError, ShapeError, safe_repr
from ...groups import se3
from ...groups.arrays import Array
from ..coordinates import coordinates
from .pose_jacobian import FRAME_NAMES

if TYPE_CHECKING:
    from ..chain import Chain

_CODES = dict(
    zip(FRAME_NAMES, (chain_kernels.SPACE, chain_kernels.BODY, chain_kernels.HYBRID), strict=True),
)


class PoseChanges(NamedTuple):
    """What a change of the model does to the pose: df f^-1, a space twist (omega; v), per unit of
    each parameter.

    Rows in base axes, rad and m.
    screws (..., 6, n, 6): [..., :, i, e] of component e of joint i's six; home (..., 6, 6): of
    component e of the home pose's eta, M <- M e^eta.
    """

    screws: Array
    home: Array


class JacobianChanges(NamedTuple):
    """What a change of the model does to the Jacobian, per unit of each parameter of `PoseChanges`.

    Rows (omega; v), rad/s and m/s, in the frame of that Jacobian.
    screws (..., 6, m, n, 6): [..., :, k, i, e] is the change of column k; home (..., 6, m, 6).
    """

    screws: Array
    home: Array


def jacobian_rate(self: Chain, q: Any, dq: Any, frame: str) -> Array:
    """dJ/dt along the rates dq: dV/dt = J ddq + (dJ/dt) dq. Column k is the sum over j of dJ_k/dq_j
    dq_j.

    Parameters: q, dq (..., m) or dicts, rad or m and rad/s or m/s, broadcast against each other;
    frame "space", "body" or "hybrid", as `jacobian`, and what is differentiated is that Jacobian as
    it stands: in "body" and "space" its entries in moving and in fixed axes, in "hybrid" with the
    moving reference point. It is what Pinocchio calls the time variation in LOCAL, WORLD and
    LOCAL_WORLD_ALIGNED.
    Returns: (..., 6, m), rows (omega; v). Raises: ShapeError, UnknownName, InputError.
    Accuracy: within 1e-13 reach for |dq_k| <= 1 on real robots
    (tests/model/kinematics/test_derivatives_pinocchio.py), in general within 4 n u (8 (n + 1) + 4
    sum |x|) reach sum |dx|, u = 2^-53 (tests/model/kinematics/test_derivatives.py).
    Source: Park 1994, Section III, J differentiated; each column's rate is one bracket.
    """
    code = _code(frame)
    batch, (rows, rates) = _together(self, (q, dq), ("q", "dq"))
    dJ = np.zeros((len(rows), 6, self.dof))
    if self.joint_names:
        derivative_kernels.jacobian_rates.call(self._table, rows, rates, code, dJ)
    return dJ.reshape(*batch, 6, self.dof)


def hessian(self: Chain, q: Any, frame: str) -> Array:
    """The kinematic Hessian H = dJ/dq: H[..., r, i, j] = d J[..., r, i] / d q_j, the column first,
    then the coordinate.

    So dJ/dt = H dq over the last axis. In "hybrid" the linear rows are the second derivatives of
    the tool's origin and symmetric in i and j; no other rows are.

    Parameters: q (..., m) or a dict; frame "space", "body" or "hybrid". Returns: (..., 6, m, m),
    rows (omega; v). Raises: ShapeError, UnknownName, InputError. Accuracy: that of `jacobian_rate`
    with one rate of 1.
    Source: Park 1994, Section III, J differentiated: ds_i/dx_j = [s_j, s_i] for j < i, else 0, and
    so on.
    """
    code = _code(frame)
    batch, (rows,) = _together(self, (q,), ("q",))
    H = np.zeros((len(rows), 6, self.dof, self.dof))
    if self.joint_names:
        derivative_kernels.hessians.call(self._table, rows, code, H)
    return H.reshape(*batch, 6, self.dof, self.dof)


def acceleration(self: Chain, q: Any, dq: Any, ddq: Any, frame: str) -> Array:
    """dV/dt = J ddq + (dJ/dt) dq, the rate of the tool's twist `velocity(q, dq, frame)` as its six
    numbers stand.

    - "hybrid": (alpha; p''), base axes: angular acceleration, and the acceleration of the tool's
      origin as an accelerometer without gravity would have it (the classical one; Pinocchio's
      getFrameClassicalAcceleration in LOCAL_WORLD_ALIGNED, not its getFrameAcceleration there,
      which is less by omega x p')
    - "body": d/dt (f^-1 f'), the spatial acceleration in tool axes; its linear part is R^T p'' -
      omega_b x v_b (Pinocchio's getFrameAcceleration in LOCAL)
    - "space": d/dt (f' f^-1), the spatial acceleration in base axes about the base origin (the same
      in WORLD)

    Parameters: q, dq, ddq (..., m) or dicts, broadcast against each other; frame. Returns: (...,
    6), rad/s^2, m/s^2. Raises: ShapeError, UnknownName, InputError. Accuracy: as `jacobian` for ddq
    and `jacobian_rate` for dq dq.
    Source: Park 1994, Section IV, V differentiated.
    """
    code = _code(frame)
    batch, (rows, rates, more) = _together(self, (q, dq, ddq), ("q", "dq", "ddq"))
    A = np.zeros((len(rows), 6))
    if self.joint_names:
        derivative_kernels.accelerations.call(self._table, rows, rates, more, code, A)
    return A.reshape(*batch, 6)


def joint_velocities(self: Chain, q: Any, dq: Any, frame: str) -> Array:
    """Twists of the joints' z-aligned frames, those of `joint_poses`, relative to the base: V_k of
    each f_k, moved.

    Parameters: q, dq (..., m) or dicts, broadcast against each other; frame: "space" f_k' f_k^-1,
    "body" f_k^-1 f_k' (in each frame's own axes, velocity of its origin), "hybrid" (base axes,
    velocity of each frame's origin).
    Returns: (..., n, 6), (omega; v) in rad/s and m/s; the tool, which stands still in the last of
    them, is not in it. Raises: ShapeError, UnknownName, InputError. Accuracy: that of `velocity`
    (tests/model/kinematics/test_derivatives.py).
    Source: Park 1994, Section IV, the V recursion, summed in the base frame.
    """
    code = _code(frame)
    batch, (rows, rates) = _together(self, (q, dq), ("q", "dq"))
    V = np.zeros((len(rows), len(self.joint_names), 6))
    if self.joint_names:
        derivative_kernels.joint_velocities.call(self._table, rows, rates, code, V)
    return V.reshape(*batch, len(self.joint_names), 6)


def screw_derivatives(self: Chain, q: Any, by: str = "motion") -> PoseChanges:
    """The derivative of the pose with respect to each screw and the home pose: df f^-1, a space
    twist.

    by="motion": A_i <- Ad(e^eta_i) A_i, M <- M e^eta, which moves an axis and leaves it a unit
    screw of its own pitch: df f^-1 = sum (Ad(P_{i-1}) - Ad(P_i)) eta_i + Ad(f) eta, P_i = e^{A_1
    x_1} ... e^{A_i x_i}. Of the six directions
    of eta_i two leave a revolute or helical joint as it is, A_i itself and the shift along its
    axis, and four a prismatic one, all shifts and the turn about its axis.
    by="entries": with respect to the six numbers of A_i as they stand, off the unit screws too:
    df f^-1 = sum Ad(P_{i-1}) J_l(A_i x_i) x_i dA_i + Ad(f) eta, J_l the left Jacobian of exp. A
    pitch h moves A_i by (0; omega_i) dh; the Jacobian in q answers for offsets and gains.
    The body twist f^-1 df is Ad(f)^-1 times all this.

    Parameters: q (..., m) or a dict; by. Returns: PoseChanges, (..., 6, n, 6) and (..., 6, 6): rows
    omega (rad) and v (m), per unit of eta or A, rad and m. Raises: ShapeError, UnknownName,
    InputError.
    Accuracy: within 1e-12 of finite differences in 50 digits for arms up to 10 m; in general 8 u (8
    (n + 1) + 4 sum |x|) and lengths times the reach (tests/model/kinematics/test_derivatives.py).
    Source: Park 1994, Section II, with e^{Ad(g) A x} = g e^{A x} g^-1; Lemma 5 for the entries.
    """
    if not isinstance(by, str) or by not in ("motion", "entries"):
        raise InputError(f"by: expected 'motion' or 'entries', got {safe_repr(by)}")
    batch, (rows,) = _together(self, (q,), ("q",))
    n = len(self.joint_names)
    D = np.zeros((len(rows), 6, n + 1, 6))
    derivative_kernels.pose_changes.call(self._table, self.screws, _home_row(self), rows, D)
    D = D.reshape(*batch, 6, n + 1, 6)
    motions, home = D[..., :n, :], D[..., n, :]
    if by == "motion" or not n:
        return PoseChanges(motions.copy(), home.copy())
    # Ad(P_{i-1}) is what is left of the space twist of the home pose when the joints from i on are
    # taken back.
    x = rows if self._coupling is None else rows @ self._coupling.T
    x = (x + self.offset).reshape(*batch, n, 1)
    before = (
        np.eye(6) - np.cumsum(np.moveaxis(motions, -2, -3), axis=-3) + np.moveaxis(motions, -2, -3)
    )
    entries = before @ (se3.left_jacobian(self.screws * x) * x[..., None])
    return PoseChanges(np.moveaxis(entries, -3, -2).copy(), home.copy())


def jacobian_screw_derivatives(self: Chain, q: Any, frame: str) -> JacobianChanges:
    """The derivative of `jacobian(q, frame)` under A_i <- Ad(e^eta_i) A_i and M <- M e^eta.

    A space column s_k moves by [d_i eta_i, s_k] for i < k with d_i the pose's derivative
    (`screw_derivatives`), by [Ad(P_{k-1}) eta_k, s_k] for i = k, and not for i > k nor with the
    home pose; the other frames follow the pose too.

    Parameters: q (..., m) or a dict; frame "space", "body" or "hybrid". Returns: JacobianChanges,
    (..., 6, m, n, 6)
    and (..., 6, m, 6). Raises: ShapeError, UnknownName, InputError.
    Accuracy: 16 n u (8 (n + 1) + 4 sum |x|), lengths times the reach squared
    (tests/model/kinematics/test_derivatives.py).
    Source: Park 1994, Sections II and III.
    """
    code = _code(frame)
    batch, (rows,) = _together(self, (q,), ("q",))
    n, m = len(self.joint_names), self.dof
    C = np.zeros((len(rows), 6, m, n + 1, 6))
    if n:
        arguments = self._table, self.screws, _home_row(self), rows, code, C
        derivative_kernels.jacobian_changes.call(*arguments)
    C = C.reshape(*batch, 6, m, n + 1, 6)
    return JacobianChanges(C[..., :n, :].copy(), C[..., n, :].copy())


def _home_row(chain: Chain) -> Array:
    return np.concatenate([chain.home[:3, :3].ravel(), chain.home[:3, 3]])


def _code(frame: object) -> int:
    if isinstance(frame, str) and frame in _CODES:
        return _CODES[frame]
    raise InputError(f"frame: expected 'space', 'body' or 'hybrid', got {safe_repr(frame)}")


def _together(
    chain: Chain, given: tuple[Any, ...], names: tuple[str, ...]
) -> tuple[tuple[int, ...], list[Array]]:
    """The common batch shape of configurations, rates, ... and each as rows (N, m)."""
    arrays = [
        coordinates(value, chain.q_names, name) for value, name in zip(given, names, strict=True)
    ]
    try:
        shape = np.broadcast_shapes(*(a.shape for a in arrays))
    except ValueError as error:
        shapes = ", ".join(str(a.shape) for a in arrays)
        raise ShapeError(f"{', '.join(names)} do not broadcast: shapes {shapes}") from error
    rows = [np.broadcast_to(a, shape).reshape(math.prod(shape[:-1]), chain.dof) for a in arrays]
    return shape[:-1], rows
