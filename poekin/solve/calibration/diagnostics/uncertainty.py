"""Uncertainty of what does not depend on where frames were put: measurements as a calibration
predicts them, relative motions, distances, the tool over the workspace.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError, join_names
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import angular_part, linear_part, normalised_or_zero
from ....results import brief
from ..measurements.measurement import Measurement
from ..measurements.points import point_at, velocities
from ..measurements.poses import pose_error_jacobian
from ..model.error_model import ErrorModel, PosesAndTwists
from ..model.parameters import Parameter
from ..model.problem import in_all_parameters
from ..model.residuals import largest, median

CONFIGURATIONS = 1000
"""How many random configurations stand for the workspace."""


class Estimate(NamedTuple):
    """An error model, its parameters with those of unknown frames, their values p (P,) and
    covariance (P, P), and these frames.
    """

    model: ErrorModel
    parameters: Sequence[Parameter]
    p: Array
    covariance: Array
    frames: Mapping[str, Array]

    def __repr__(self) -> str:
        return brief(self, f"{len(self.p)} parameters, {len(self.frames)} unknown frames")

    def at(self, q: Array) -> PosesAndTwists:
        """Poses and twists at the readings q (N, m)."""
        n = len(self.model.parameters)
        return self.model.poses_and_twists(self.p[:n], q)

    def propagated(self, J: Array) -> Array:
        """J C J^T of J (..., d, k) in the first k parameters."""
        k = J.shape[-1]
        C = self.covariance[:k, :k]
        return J @ C @ np.swapaxes(J, -1, -2)


class Workspace(NamedTuple):
    """Standard deviations of the tool's pose over random configurations within the limits.

    Parameters
    ----------
    length, angle : (N,) ndarray
        Of its position, m, and of its rotation, rad: root of the trace of each covariance.
    q : (N, m) ndarray
        The configurations, rad or m.
    """

    length: Array
    angle: Array
    q: Array

    @property
    def worst(self) -> Array:
        """Configuration (m,) at which the position is known least."""
        least_known = np.argmax(self.length)
        return np.asarray(self.q[least_known])

    def summary(self) -> str:
        """Medians, and the worst position with where it is, in words.

        Returns
        -------
        text : str
            One sentence.
        """
        worst = ", ".join(f"{x:.3g}" for x in self.worst)
        length = 1e3 * median(self.length)
        angle = 1e3 * median(self.angle)
        return (
            f"the tool is known to {length:.3g} mm and {angle:.3g} mrad over the workspace (standard "
            f"deviation, median), worst {1e3 * largest(self.length):.3g} mm at q = ({worst})"
        )

    def __repr__(self) -> str:
        return brief(self, self.summary())


def pose_covariance(estimate: Estimate, q: Array) -> Array:
    """Covariance (N, 6, 6) of rotation vector and position at q (N, m), in base axes."""
    return estimate.propagated(pose_jacobian(*estimate.at(q)))


def relative_covariance(estimate: Estimate, q_a: Array, q_b: Array) -> Array:
    """Covariance (N, 6, 6) of the pose at q_b in the tool's frame at q_a, in axes of that frame."""
    T_a, D_a = estimate.at(q_a)
    T_b, D_b = estimate.at(q_b)
    back = se3.inverse(T_a)
    T_ab = back @ T_b
    D_ab = se3.adjoint(back) @ (D_b - D_a)
    return estimate.propagated(pose_jacobian(T_ab, D_ab))


def distance_variance(estimate: Estimate, q_a: Array, q_b: Array, point: Array) -> Array:
    """Variance (N,) of the distance between the places of a point of the tool at q_a and q_b."""
    T_a, D_a = estimate.at(q_a)
    T_b, D_b = estimate.at(q_b)
    a = point_at(T_a, point)
    b = point_at(T_b, point)
    u = normalised_or_zero(b - a)
    apart = velocities(D_b, b) - velocities(D_a, a)
    J = u[:, None] @ apart
    return estimate.propagated(J)[:, 0, 0]


def measurement_covariance(estimate: Estimate, q: Array, s: Measurement, k: int) -> Array:
    """Covariance (N, d, d) of the errors of a measurement like s, of set k, at q (N, m)."""
    T, D = estimate.at(q)
    no_errors = np.zeros((len(q), s.width))
    frames = []
    parts = []
    for frame in s.unknown_frames:
        name = _frame_name(estimate, frame.name, frame.shared, k)
        frames.append(estimate.frames[name])
        parts.append([i for i, p in enumerate(estimate.parameters) if p.owner == name])
    jacobian = s.jacobian(T, frames, no_errors, D)
    J = in_all_parameters(*jacobian, parts, estimate.p)
    return estimate.propagated(J)


def _frame_name(estimate: Estimate, name: str, shared: str | None, k: int) -> str:
    """Name of an unknown frame of set k in the calibration. Raises: InputError."""
    which = f" of measurement set {k}"
    if shared is not None:
        which = f" of {shared!r}"
    for found in (name + which, name):
        if found in estimate.frames:
            return found
    known = join_names(list(estimate.frames)) or "none"
    raise InputError(f"measurement: no frame {name!r} was estimated; available: {known}")


def workspace(estimate: Estimate, count: int, seed: int) -> Workspace:
    """Standard deviations of the tool's pose at `count` random configurations."""
    q = np.asarray(estimate.model.nominal.random(seed, count))
    C = pose_covariance(estimate, q)
    diagonal = np.diagonal(C, axis1=1, axis2=2)
    variances = np.maximum(diagonal, 0.0)
    of_angle = angular_part(variances).sum(axis=1)
    of_length = linear_part(variances).sum(axis=1)
    return Workspace(np.sqrt(of_length), np.sqrt(of_angle), q)


def pose_jacobian(T: Array, D: Array) -> Array:
    """Derivatives (N, 6, P) of rotation vector and position, in base axes, of twists D (N, 6, P)."""
    no_errors = np.zeros((len(T), 6))
    return pose_error_jacobian(T, no_errors, D)
