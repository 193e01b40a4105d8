"""Worst case of what a fit to poses makes of errors in joint readings and poses that are bounded.

At the fit p <- p - G e, G = (J^T W J)^-1 J^T W, e the errors of the poses. A reading q_k that is off
by h_k at most turns and moves the pose by J_h,k h_k; a position is off by h at most in each axis, a
rotation by r at most about any axis. What is linear in p, y = Y p, is then off by at most

    sum over the pairs i of  sum_k |Y G_i J_h,ik| h_k + |Y G_i|_rotation r + sum |Y G_i|_position h

to first order in these errors: nothing is assumed of how they are distributed.
"""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import angular_part, linear_part, norms
from ....model.checks import read_only
from ..diagnostics.identification import RANK
from ..fit.noise import NoiseEstimate
from ..measurements.measurement import per_error
from ..measurements.poses import Poses
from ..result import CalibrationData

ROUNDING = 2e-14
"""Least error of a pose, rad and reaches: that of forward kinematics in double precision."""
_AT_ONCE = 200_000  # numbers of one product, which stay in the processor's cache


class ReadingErrors(NamedTuple):
    """Largest error of each coordinate (m,), rad or m; of a rotation, rad; of a position in each
    axis, m.
    """

    joints: Array
    rotation: float
    position: float


class Propagation(NamedTuple):
    """Linear estimate at the end of a fit to poses.

    errors (N, 6), rad and m; their Jacobian J (N, 6, P); gain G (P, N, 6); hybrid Jacobian
    (N, 6, m) of each pair; standard deviations (6,) that the errors were weighted with.
    """

    errors: Array
    design: Array
    gain: Array
    jacobian: Array
    deviations: Array


def propagation(found: CalibrationData, q: Array, poses: Poses) -> Propagation:
    """The linear estimate at the end of a fit to poses measured at q (N, m)."""
    T, D = found.error_model.poses_and_twists(found.values, q)
    errors = poses.errors(T, [])
    J, _ = poses.jacobian(T, [], errors, D)
    angle, length = cast(NoiseEstimate, found.noise_std[0])  # no covariance was given
    deviations = per_error(poses, angle, length)
    lengths = [parameter.unit == "m" for parameter in found.parameters]
    scale = np.where(lengths, found.nominal.reach, 1.0)
    whitened = J / deviations[:, None] * scale
    rows = whitened.reshape(-1, len(scale))
    inverse = np.linalg.pinv(rows, rcond=RANK)
    gain = scale[:, None] * inverse
    gain = gain.reshape(len(scale), -1, 6) / deviations
    hybrid = found.chain.jacobian(q, "hybrid")
    parts = (errors, J, gain, hybrid, deviations)
    return Propagation(*map(read_only, parts))


def worst_case(Y: Array, fit: Propagation, largest: ReadingErrors) -> Array:
    """Largest error (...,) of Y p, Y (..., k) for the first k of the parameters."""
    rows = Y.reshape(-1, Y.shape[-1])
    gain = fit.gain[: rows.shape[1]]
    off = largest.joints > 0
    moving = fit.jacobian[..., off]
    joints = np.einsum("pni,nik->pnk", gain, moving) * largest.joints[off]
    positions = linear_part(gain) * largest.position
    rotations = angular_part(gain) * largest.rotation
    # what counts by itself, and what counts by the length of three numbers
    lines = np.concatenate([joints, positions], axis=2)
    turns = np.moveaxis(rotations, 2, 0)
    bound = np.zeros(len(rows))
    numbers = 1 + len(rows) * lines.shape[2]
    count = 1 + _AT_ONCE // numbers
    for start in range(0, len(fit.errors), count):
        some = slice(start, start + count)
        each = lines[:, some].reshape(len(lines), -1)
        bound += np.abs(rows @ each).sum(axis=1)
        turned = np.linalg.norm(rows @ turns[..., some], axis=0)
        bound += turned.sum(axis=1)
    return bound.reshape(Y.shape[:-1])


def screw_bounds(found: CalibrationData, fit: Propagation, largest: ReadingErrors) -> Array:
    """Largest error (n, 6) of each entry of the screws, with the rounding of doubles and a bound on
    what is of second order.

    Where first order tilts an axis by a and moves it by s, e^eta turns omega by a^2 / 2 more, and v
    by a^2 |v| / 2 + a s: twice that is added.
    """
    chain = found.chain
    J = found.error_model.screw_jacobian(found.values)
    first = worst_case(J, fit, largest)
    tilt, shift = norms(first.reshape(-1, 2, 3)).T
    moments = norms(linear_part(chain.screws))
    turned = tilt**2 + ROUNDING
    rounding = ROUNDING * (chain.reach + moments)
    moved = tilt**2 * moments + 2.0 * tilt * shift + rounding
    second = np.stack([turned, moved], axis=1)
    return first + np.repeat(second, 3, axis=1)
