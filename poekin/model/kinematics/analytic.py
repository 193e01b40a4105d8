"""A pose as so many numbers, and the analytic Jacobian of them: rotation vector, quaternion, or
roll, pitch and yaw.

Methods of `Chain`. The position is that of the tool's origin in the base frame; the rotation's
rates come from the angular velocity in base axes, the rows of the hybrid Jacobian, by a map for
each kind of numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError, safe_repr
from ...groups import rpy, so3
from ...groups.arrays import Array

if TYPE_CHECKING:
    from ..chain import Chain

GIMBAL = 1e-8
"""Least cos(pitch) at which roll and yaw have rates: there they turn 1e8 times as fast as the tool,
and half of their digits are left.
"""


def pose_coordinates(self: Chain, q: Any, kind: str) -> Array:
    """f(q) as numbers: the rotation's, then the position (x, y, z) in m of the tool's origin in the
    base frame.

    - "rotation_vector": w = log R, 0 <= |w| <= pi, rad; as `so3.log`
    - "quaternion_wxyz": (w, x, y, z) of unit length, of the two that mean R the one with w >= 0 (w
      = cos(|log R|/2)); at w = 0, half a turn, the largest of x, y, z is positive. So it jumps to
      its negative where |log R| passes pi
    - "rpy": (roll, pitch, yaw) in rad, R = Rz(yaw) Ry(pitch) Rx(roll) as URDF has it, |pitch| <=
      pi/2

    Parameters: q (..., m) or a dict; kind. Returns: (..., 6), or (..., 7) with a quaternion.
    Raises: ShapeError, UnknownName, InputError. Accuracy: that of `fk` in R; roll and yaw apart
    from each other lose 1/cos(pitch). Source: Park 1994, Lemma 3; the URDF specification for rpy.
    """
    numbers, _ = _functions(kind)
    T = self.fk(q)
    return np.concatenate([numbers(T[..., :3, :3]), T[..., :3, 3]], axis=-1)


def analytic_jacobian(self: Chain, q: Any, kind: str) -> Array:
    """The derivative of `pose_coordinates(q, kind)` with respect to q: rows of the rotation's
    numbers, then of p.

    - "rotation_vector": dw/dt = J_l(w)^-1 omega, regular up to and at |w| = pi (there it is that of
      the branch that w is on: w itself jumps)
    - "quaternion_wxyz": dQ/dt = (-omega . v; w omega + omega x v) / 2 with Q = (w; v), of the sign
      that `pose_coordinates` gives; regular everywhere, and Q . dQ = 0
    - "rpy": singular at pitch = ±90 deg, where roll and yaw turn about one axis and cannot give
      every omega

    Parameters: q (..., m) or a dict; kind. Returns: (..., 6, m), or (..., 7, m) with a quaternion:
    per unit of dq, rad/s (1/s of a quaternion) and m/s.
    Raises: InputError with "rpy" where cos(pitch) < 1e-8, with the configuration and its pitch;
    ShapeError, UnknownName, InputError as `jacobian`.
    Accuracy: that of `jacobian`, times 1/cos(pitch) squared with "rpy"
    (tests/model/kinematics/test_analytic.py). Source: Park 1994, Lemma 4 for the rotation vector;
    the kinematic equation of unit quaternions; R of rpy differentiated.
    """
    _, rates = _functions(kind)
    T, J = self.fk_jacobian(q, "hybrid")
    return np.concatenate([rates(T[..., :3, :3]) @ J[..., :3, :], J[..., 3:, :]], axis=-2)


def _functions(kind: object) -> tuple[Callable[[Array], Array], Callable[[Array], Array]]:
    """The numbers (..., k) of a rotation R, and the map (..., k, 3) from omega in base axes to
    their rates.
    """
    if isinstance(kind, str) and kind in _FUNCTIONS:
        return _FUNCTIONS[kind]
    raise InputError(f"kind: expected one of {', '.join(map(repr, KINDS))}, got {safe_repr(kind)}")


def quaternion_wxyz(R: Array) -> Array:
    """(w, x, y, z) from the logarithm, which has the right branch and all its digits at half a turn
    too.
    """
    w = so3.log(R)
    half = 0.5 * np.linalg.norm(w, axis=-1, keepdims=True)
    # sin(x)/x, as NumPy has it for pi x
    # and at half a turn rounding may take |w| past pi by a bit
    return np.concatenate([np.maximum(np.cos(half), 0.0), 0.5 * np.sinc(half / np.pi) * w], axis=-1)


def _vector_rates(R: Array) -> Array:
    """The map (..., 3, 3) from omega in base axes to dw/dt."""
    return so3.left_jacobian_inverse(so3.log(R))


def _quaternion_rates(R: Array) -> Array:
    """The map (..., 4, 3) from omega in base axes to dQ/dt."""
    Q = quaternion_wxyz(R)
    w, v = Q[..., :1, None], Q[..., 1:]
    return 0.5 * np.concatenate([-v[..., None, :], w * np.eye(3) - so3.hat(v)], axis=-2)


def _rpy_rates(R: Array) -> Array:
    """The map (..., 3, 3) from omega in base axes to (roll, pitch, yaw)'; InputError at the
    singularity.
    """
    cosine, sine = np.hypot(R[..., 0, 0], R[..., 1, 0]), -R[..., 2, 0]
    if np.any(cosine < GIMBAL):
        index = tuple(int(i) for i in np.argwhere(cosine < GIMBAL)[0])
        which = f"q[{', '.join(map(str, index))}]" if index else "q"
        pitch = np.degrees(np.arctan2(sine[index], cosine[index]))
        raise InputError(
            f"{which}: roll and yaw have no rates at pitch ±90°; here pitch = {pitch:.9g}°, cos(pitch) = "
            f"{cosine[index]:.3g}, and at least {GIMBAL:g} is needed; 'rotation_vector' and 'quaternion_wxyz' have "
            "no such place"
        )
    # Rz(yaw)'s first column is (c, s): omega turned back by yaw
    c, s = R[..., 0, 0] / cosine, R[..., 1, 0] / cosine
    zero, one = np.zeros_like(c), np.ones_like(c)
    tangent = sine / cosine
    rows = [[c / cosine, s / cosine, zero], [-s, c, zero], [c * tangent, s * tangent, one]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


_FUNCTIONS = {
    "rotation_vector": (so3.log, _vector_rates),
    "quaternion_wxyz": (quaternion_wxyz, _quaternion_rates),
    "rpy": (rpy.angles, _rpy_rates),
}
KINDS = tuple(_FUNCTIONS)
