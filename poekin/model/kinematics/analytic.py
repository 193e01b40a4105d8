"""A pose as so many numbers, and the analytic Jacobian of them: rotation vector, quaternion, or
roll, pitch and yaw.

The position is that of the tool's origin in the base frame; the rotation's
rates come from the angular velocity in base axes, the rows of the hybrid Jacobian, by a map for
each kind of numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import numpy as np

from ...checks import choice
from ...engine.kernels import group_kernels
from ...errors import InputError
from ...groups import rpy, so3
from ...groups.arrays import Array, map_kernel

RotationKind = Literal["rotation_vector", "quaternion_wxyz", "rpy"]
KINDS: tuple[RotationKind, ...] = get_args(RotationKind)

GIMBAL = 1e-8
"""Least cos(pitch) at which roll and yaw have rates: there they turn 1e8 times as fast as the tool,
and half of their digits are left.
"""


class RotationNumbers(NamedTuple):
    """A rotation R as numbers (..., k), and the map (..., k, 3) from omega in base axes to their
    rates.
    """

    numbers: Callable[[Array], Array]
    rates: Callable[[Array], Array]

    def pose_coordinates(self, T: Array) -> Array:
        """Numbers (..., k + 3) of poses: those of the rotation, then the position."""
        return np.concatenate(
            [
                self.numbers(T[..., :3, :3]),
                T[..., :3, 3],
            ],
            axis=-1,
        )

    def jacobian(self, T: Array, J: Array) -> Array:
        """Derivatives (..., k + 3, m) of the numbers, of poses and hybrid Jacobians."""
        rates = self.rates(T[..., :3, :3]) @ J[..., :3, :]
        return np.concatenate([rates, J[..., 3:, :]], axis=-2)


def rotation_numbers(kind: RotationKind) -> RotationNumbers:
    """Numbers of a kind. Raises InputError for any other kind."""
    choice(kind, KINDS, "kind")
    return _ROTATION_NUMBERS[kind]


def quaternion_wxyz(R: Array) -> Array:
    """Unit quaternions (w, x, y, z), w >= 0, right to their last digits at half a turn too."""
    return map_kernel(group_kernels.so3_quaternion, 2, (4,), R) + 0.0


def _vector_rates(R: Array) -> Array:
    """The map (..., 3, 3) from omega in base axes to dw/dt."""
    return so3.left_jacobian_inverse(so3.log(R))


def _quaternion_rates(R: Array) -> Array:
    """The map (..., 4, 3) from omega in base axes to dQ/dt."""
    Q = quaternion_wxyz(R)
    w = Q[..., :1, None]
    v = Q[..., 1:]
    return 0.5 * np.concatenate(
        [
            -v[..., None, :],
            w * np.eye(3) - so3.hat(v),
        ],
        axis=-2,
    )


def _rpy_rates(R: Array) -> Array:
    """The map (..., 3, 3) from omega in base axes to (roll, pitch, yaw)'; InputError at the
    singularity.
    """
    cosine = np.hypot(R[..., 0, 0], R[..., 1, 0])
    sine = -R[..., 2, 0]
    if np.any(cosine < GIMBAL):
        raise _gimbal_lock(cosine, sine)
    # Rz(yaw)'s first column is (c, s): omega turned back by yaw
    c = R[..., 0, 0] / cosine
    s = R[..., 1, 0] / cosine
    zero = np.zeros_like(c)
    one = np.ones_like(c)
    tangent = sine / cosine
    rows = [
        [c / cosine, s / cosine, zero],
        [-s, c, zero],
        [c * tangent, s * tangent, one],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _gimbal_lock(cosine: Array, sine: Array) -> InputError:
    """The error for the first of the pitches, given by cosine and sine, that is too near to ±90°."""
    index = tuple(int(i) for i in np.argwhere(cosine < GIMBAL)[0])
    which = f"q[{', '.join(map(str, index))}]" if index else "q"
    pitch = np.degrees(np.arctan2(sine[index], cosine[index]))
    return InputError(
        f"{which}: roll and yaw have no rates at pitch ±90°; here pitch = {pitch:.9g}°, cos(pitch) = "
        f"{cosine[index]:.3g}, and at least {GIMBAL:g} is needed; 'rotation_vector' and "
        "'quaternion_wxyz' have no such place"
    )


_ROTATION_NUMBERS: dict[RotationKind, RotationNumbers] = {
    "rotation_vector": RotationNumbers(so3.log, _vector_rates),
    "quaternion_wxyz": RotationNumbers(quaternion_wxyz, _quaternion_rates),
    "rpy": RotationNumbers(rpy.angles, _rpy_rates),
}
