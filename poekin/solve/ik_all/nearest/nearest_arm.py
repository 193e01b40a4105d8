"""The nearest arm of a family that has a closed form, found by least squares over such arms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ....analysis.axis_lines import place, sine
from ....errors import InputError, join_names
from ....groups import so3
from ....groups.arrays import Array
from ....groups.vectors import directions, norm, rotation_part, translation_part
from ....model.chain import Chain
from ....model.sampling import angle_mask, half_range, sampling_range
from ....results import Result
from ..structure import Family
from .constrained_arm import ConstrainedArm, Motions, rounded_arm
from .pose_bound import pose_bound

_CONFIGURATIONS = 96
_STEPS = 40  # at most; two to twelve for an arm that is near, thirty for one that is far


@dataclass(frozen=True)
class NearestArm(Result):
    """Nearest arm of a family, and how far away it is.

    Attributes
    ----------
    chain : Chain
        Chain of the family, with the given one's joints, limits and coupling.
    family : Family
        Three joints whose axes meet, or are parallel, in it.
    position_bound : float
        Bound of the distance of its tip from the given chain's at the same coordinates, m.
    rotation_bound : float
        Bound of the angle between their orientations, rad.
    rms : float
        Root mean square of the pose difference, √(θ² + d² / reach²), rad.
    changes : tuple of JointChange
        Motion of each joint's axis.
    """

    left_out: ClassVar[tuple[str, ...]] = ("chain",)

    chain: Chain
    family: Family
    position_bound: float
    rotation_bound: float
    rms: float
    changes: tuple[JointChange, ...]

    def summary(self) -> str:
        """Text for people.

        Returns
        -------
        text : str
            Bounds in mm and degrees, then the joints whose axes moved, one a line.
        """
        position = f"{1e3 * self.position_bound:.3g} mm"
        rotation = f"{np.degrees(self.rotation_bound):.3g}°"
        return "\n".join([f"within {position} and {rotation}", *map(str, self.changes)])


@dataclass(frozen=True)
class JointChange(Result):
    """Motion of one axis from the given arm to the nearest one of a family.

    Attributes
    ----------
    joint : str
        Name of the joint.
    angle : float
        Angle between the two directions, rad.
    distance : float
        Distance of the given axis' point nearest to the new one, m; 0 of a prismatic joint.
    """

    joint: str
    angle: float
    distance: float

    def summary(self) -> str:
        """Name, angle in degrees and distance in mm.

        Returns
        -------
        text : str
            Line such as "elbow: turned by 0.2°, moved by 0.31 mm".
        """
        turned = f"{np.degrees(self.angle):.3g}°"
        return f"{self.joint}: turned by {turned}, moved by {1e3 * self.distance:.3g} mm"


class _Fit(NamedTuple):
    """Arm, its chain, and its mean square pose difference with residuals (N, 6) and poses."""

    arm: ConstrainedArm
    chain: Chain
    cost: float
    residuals: Array
    poses: Array


def nearest_arm(chain: Chain, family: Family) -> NearestArm:
    """The arm of a family with the least mean square pose difference from a chain.

    The mean of θ² + d² / reach² over `_CONFIGURATIONS` fixed quasi-random configurations is
    minimised (θ the angle between the two orientations, d the distance of the tips), angles over a
    whole turn and lengths within their range, by Gauss-Newton over the motions that keep the family
    and over the home pose. It starts where the three axes are moved to the point nearest to them,
    or turned to their mean direction, and is deterministic.

    Raises: InputError for joints that are not revolute or not there.
    Accuracy: the mean square is stationary to 1e-6 of itself (tests/solve/ik_all/nearest/).
    """
    _check(chain, family)
    q = configurations(chain)
    wanted = chain.fk(q)
    fit = _fit(rounded_arm(chain, family), chain, q, wanted)
    for _ in range(_STEPS):
        step = _step(fit, q, chain.reach)
        better = _fit(step, chain, q, wanted)
        if not better.cost < fit.cost:
            break
        fit = better
    bound = pose_bound(chain, fit.chain)
    return NearestArm(
        chain=fit.chain,
        family=family,
        position_bound=bound.position,
        rotation_bound=bound.rotation,
        rms=float(np.sqrt(fit.cost)),
        changes=_changes(chain, fit.chain),
    )


def configurations(chain: Chain) -> Array:
    """Fixed quasi-random configurations (N, m): angles over a whole turn, lengths in their range.

    Source: the additive recurrence of the root of x^(m + 1) = x + 1 (Roberts 2018).
    """
    m = chain.dof
    root = 2.0
    for _ in range(60):
        root = (1 + root) ** (1 / (m + 1))
    alpha = root ** -np.arange(1.0, m + 1)
    counter = np.arange(1, _CONFIGURATIONS + 1)
    unit = (0.5 + np.outer(counter, alpha)) % 1
    low, high = sampling_range(chain)
    angles = angle_mask(chain)
    half = half_range(chain)
    low = np.where(angles, -half, low)
    high = np.where(angles, half, high)
    return low + (high - low) * unit


def pose_differences(T: Array, wanted: Array, reach: float) -> Array:
    """Differences (N, 6) of poses: rotation vector of R R_wanted^T, rad, and (p - p_wanted) / reach."""
    back = np.swapaxes(rotation_part(wanted), 1, 2)
    turned = so3.log(rotation_part(T) @ back)
    moved = translation_part(T) - translation_part(wanted)
    return np.concatenate([turned, moved / reach], axis=1)


def _fit(
    arm: ConstrainedArm,
    chain: Chain,
    q: Array,
    wanted: Array,
) -> _Fit:
    new = arm.chain(chain)
    poses = new.fk(q)
    residuals = pose_differences(poses, wanted, chain.reach)
    squares = (residuals**2).sum(axis=1)
    return _Fit(arm, new, float(squares.mean()), residuals, poses)


def _step(fit: _Fit, q: Array, reach: float) -> ConstrainedArm:
    """The arm after one step of Gauss-Newton.

    With rotation vectors r as residuals the space twist's ω stands for dr: their left Jacobian
    leaves r as it is, so that the gradient is exact.
    """
    motions = fit.arm.motions()
    J = _jacobian(fit, motions, q, reach)
    columns = J.reshape(-1, J.shape[-1])
    # Normal equations: small matrices wait for no threads, and each step mends the one before.
    normal = columns.T @ columns
    right = -columns.T @ fit.residuals.ravel()
    found, *_ = np.linalg.lstsq(normal, right, rcond=1e-13)
    x = np.asarray(found, np.float64)
    return fit.arm.moved(motions, x[:-6], x[-6:])


def _jacobian(fit: _Fit, motions: Motions, q: Array, reach: float) -> Array:
    """Derivatives (N, 6, p + 6) of the residuals by the motions, then by the home pose."""
    change = fit.chain.screw_derivatives(q)
    N = len(q)
    twists = motions.twists().reshape(-1, motions.turns.shape[2])
    by_motions = change.screws.reshape(N, 6, -1) @ twists
    space = np.concatenate([by_motions, change.home], axis=2)
    w = space[:, :3]
    p = translation_part(fit.poses)
    of_turns = np.cross(w, p[:, :, None], axis=1)
    at_tip = space[:, 3:] + of_turns
    return np.concatenate([w, at_tip / reach], axis=1)


def _changes(given: Chain, new: Chain) -> tuple[JointChange, ...]:
    changes = []
    joints = zip(given.joint_names, given.screws, new.screws, strict=True)
    for name, A, B in joints:
        w = directions(A)
        u = directions(B)
        angle = np.arctan2(sine(w, u), w @ u)
        moved = norm(place(B) - place(A))
        changes.append(JointChange(name, float(angle), moved))
    return tuple(changes)


def _check(chain: Chain, family: Family) -> None:
    kinds = chain.kinds[family.first : family.first + 3]
    if family.first < 0 or kinds != ("revolute",) * 3:
        raise InputError(
            f"family: expected three revolute joints from number {family.first} on, from 0; the "
            f"chain has {join_names(chain.joint_names)}, which are {', '.join(chain.kinds)}"
        )
