"""Base and tool with which the nominal arm is the calibrated one as nearly as it can be."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....errors import InputError, escape_unprintable
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import norm, rotation_part, translation_part
from ....results import brief
from ..fit import initial_guess
from ..measurements.points import points_at, velocities
from ..model.tsqr import least_squares
from .uncertainty import Estimate

_SAMPLES = 100
_ROUNDS = 30
_SETTLED = 1e-12  # rad and reaches: a step that is rounding
_RANK = 1e-9
_FIXED = 1e-14  # of the largest variance: what is smaller is rounding of none
_FAR = 0.05  # reaches: from so far a search may have ended in another minimum


class FrameEstimate(NamedTuple):
    """A frame that a calibration found.

    Parameters
    ----------
    name : str
        "base": the nominal arm's base in the frame that was measured in; "tool": the tool in the
        nominal tip frame; or an unknown frame.
    T : (4, 4) ndarray
        Its pose, m.
    covariance : (6, 6) ndarray
        Covariance of its rotation vector and position errors, in its own axes, rad² and m².
    held : (6, h) ndarray
        Motions of it in its own axes, rad and m, by what the measurements do not tell and the
        calibration fixed.
    """

    name: str
    T: Array
    covariance: Array
    held: Array

    def summary(self) -> str:
        """Name, place and turn with their standard deviations, in words.

        Returns
        -------
        text : str
            One sentence.
        """
        turn, shift = (1e3 * norm(of) for of in np.split(np.sqrt(np.diag(self.covariance)), 2))
        x, y, z = 1e3 * translation_part(self.T)
        angle = np.degrees(norm(so3.log(rotation_part(self.T))))
        return (
            f"{self.name} at ({x:.3f}, {y:.3f}, {z:.3f}) mm ± {shift:.2g} mm, turned by {angle:.3f}° ± "
            f"{turn:.2g} mrad, {self.held.shape[1]} motions held"
        )

    def __repr__(self) -> str:
        return brief(self, escape_unprintable(self.summary()))


class BaseAndTool(NamedTuple):
    """Base and tool (4, 4), with their motions (12, P), in their own axes, by the parameters and those
    (12, h) that no point shows; root mean square distance of the nominal arm as it stands, and with
    them, m.
    """

    base: Array
    tool: Array
    motions: Array
    unseen: Array
    before: float
    after: float


def pose_points(reach: float) -> Array:
    """Points (4, 3) of the tool that tell its pose, a tenth of the reach apart."""
    return np.concatenate([np.zeros((1, 3)), 0.1 * reach * np.eye(3)])


def base_and_tool(
    estimate: Estimate,
    points: Array,
) -> BaseAndTool:
    """The P and Q of the least distances of P f(q) Q, f of the nominal arm, and the calibrated one,
    over random configurations and of these points (k, 3) of the tool.
    """
    nominal = estimate.model.nominal
    q = np.asarray(nominal.random(0, _SAMPLES))
    T, D = estimate.at(q)
    here = nominal.fk(q)
    goal = points_at(T, points)
    found = min(_searched(here, T, goal, points, nominal.reach), key=lambda trial: trial.left)
    P, Q, J, left = found
    by_parameters = velocities(D[:, None], goal).reshape(-1, D.shape[2])
    motions = least_squares(J, by_parameters)
    _, s, Vt = np.linalg.svd(J, full_matrices=False)
    unseen = Vt[s <= _RANK * s[0]].T
    to_own = np.eye(12)
    to_own[:6, :6] = se3.adjoint(se3.inverse(P))
    before = _rms(goal - points_at(here, points))
    return BaseAndTool(P, Q, to_own @ motions, to_own @ unseen, before, left)


class _Trial(NamedTuple):
    P: Array
    Q: Array
    J: Array
    left: float


def _searched(
    here: Array,
    T: Array,
    goal: Array,
    points: Array,
    reach: float,
) -> Iterator[_Trial]:
    """Least squares from the tool as it is; where that ends far off, from base and tool of hand-eye
    calibration, too.
    """
    start = initial_guess.mean_pose(T @ se3.inverse(here))
    found = _least(here, goal, points, reach, start, np.eye(4))
    yield found
    if found.left > _FAR * reach:
        try:
            X, Z = initial_guess.hand_eye(here, T)
        except InputError:  # an arm that turns about one axis only
            return
        yield _least(here, goal, points, reach, se3.inverse(X), Z)


def _least(
    here: Array,
    goal: Array,
    points: Array,
    reach: float,
    P: Array,
    Q: Array,
) -> _Trial:
    """Gauss-Newton from P and Q on."""
    scale = np.tile([1.0, 1.0, 1.0, reach, reach, reach], 2)
    for _ in range(_ROUNDS):
        T = P @ here @ Q
        places = points_at(T, points)
        fixed = np.broadcast_to(np.eye(6), (len(T), 6, 6))
        D = np.concatenate([fixed, se3.adjoint(T)], axis=2)
        J = velocities(D[:, None], places).reshape(-1, 12)
        off = goal - places
        z = np.linalg.lstsq(J * scale, off.ravel(), rcond=_RANK)[0]
        step = scale * z
        P = se3.exp(step[:6]) @ P
        Q = Q @ se3.exp(step[6:])
        if np.abs(z).max() <= _SETTLED:
            break
    return _Trial(P, Q, J, _rms(off))


def _rms(vectors: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))


def frame_estimates(
    estimate: Estimate,
    points: Array,
) -> list[FrameEstimate]:
    """Base, tool, and unknown frames, of measured points of the tool: where it is one, the tool's
    origin is there.
    """
    found = base_and_tool(estimate, points)
    point = points[0] if len(points) == 1 else np.zeros(3)
    count = len(estimate.model.parameters)
    fixed = _fixed(estimate)
    at_point = se3.pose(np.eye(3), point)
    to_point = se3.adjoint(se3.inverse(at_point))
    of_tool = found.tool @ at_point
    of_both = np.concatenate([found.motions, found.unseen], axis=1)
    frames = []
    rows = (
        ("base", found.base, of_both[:6]),
        ("tool", of_tool, to_point @ of_both[6:]),
    )
    for name, T, moves in rows:
        motions = moves[:, :count]
        held = np.concatenate([moves[:, count:], motions @ fixed[:count]], axis=1)
        frames.append(FrameEstimate(name, T, estimate.propagated(motions), held))
    for name, T in estimate.frames.items():
        mine = [k for k, p in enumerate(estimate.parameters) if p.owner == name]
        if len(mine) == 6:
            J = se3.right_jacobian(estimate.p[mine])
            C = estimate.covariance[np.ix_(mine, mine)]
            frames.append(FrameEstimate(name, T, J @ C @ J.T, J @ fixed[mine]))
    return frames


def _fixed(estimate: Estimate) -> Array:
    """Orthonormal directions (P, h) without variance, in rad and reaches."""
    reach = estimate.model.nominal.reach
    scale = np.where([p.unit in ("m", "m/rad") for p in estimate.parameters], reach, 1.0)
    variances, V = np.linalg.eigh(estimate.covariance / np.outer(scale, scale))
    return V[:, variances <= _FIXED * variances[-1]]
