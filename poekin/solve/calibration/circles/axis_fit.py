"""Fit of the axis of one sweep: all points on circles about it, wherever on these, or on lines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups import so3
from ....groups.arrays import Array
from ....groups.vectors import norm, translation_part
from ....model.chain import Chain
from ....results import brief
from ..diagnostics.identification import identification_matrix, row_space
from ..fit.fitting import Fit, fit_parameters
from ..fit.minimise import FitOptions
from ..measurements.measurement import per_error
from ..model.error_model import ErrorModel
from ..model.parameters import Parameter
from ..model.problem import Problem
from ..model.tsqr import qr_r
from ..terms.conditions import Conditions
from ..terms.term import Term
from .joint_sweep import JointSweep
from .rough_axis import check_arc, rough_axis

_GAIN = 0.1  # by which measured and read motion may differ


class AxisFit(NamedTuple):
    """Axis of one joint as its sweep shows it.

    Parameters
    ----------
    joint : int
        Number of the joint.
    screw : (6,) ndarray
        Screw (ω; v) in the frame of the measurements, where the other joints stood; 1 and m.
    covariance : (6, 6) ndarray
        Covariance of these numbers.
    arc : float
        Measured motion from the first to the last reading, rad or m.
    radius : float
        Distance of the point, or of the tool, from the axis, m; 0 of a joint that slides.
    tilt, shift : float
        Standard deviations of the axis's direction, rad, and of its place at the middle of the
        circle, m; no shift of a joint that slides.
    rms : float
        Root mean square distance of the measured positions from the circle or line, m.
    """

    joint: int
    screw: Array
    covariance: Array
    arc: float
    radius: float
    tilt: float
    shift: float
    rms: float

    def summary(self) -> str:
        """Standard deviations and residual in words, in mrad and mm.

        Returns
        -------
        text : str
            One sentence.
        """
        known = f"direction ± {1e3 * self.tilt:.2g} mrad"
        if self.radius:
            known += f", place ± {1e3 * self.shift:.2g} mm"
        return f"{known}; residual {1e3 * self.rms:.2g} mm rms"

    def __repr__(self) -> str:
        return brief(self, f"joint {self.joint}, {self.summary()}")


def fit_axis(sweep: JointSweep) -> AxisFit:
    """The screw that all readings turn about, by how much is free. Raises: InputError where the sweep
    does not show it.
    """
    what = f"sweep of joint {sweep.joint}"
    q = sweep.readings[:, None]
    rough = rough_axis(sweep, what)
    chain = Chain.from_space(rough.screw[None], rough.home)
    kinds = ("screws", "home", _free_motion(len(q)))
    model = ErrorModel(chain, kinds, None)
    problem = Problem(model, q, [sweep.measurements])
    free = row_space(identification_matrix(problem)).basis
    start = np.zeros(problem.size)
    fit = fit_parameters(problem, free, start, FitOptions("linear"))
    measured = model.values(fit.p, q)
    gain = float(np.sum(q * measured) / np.sum(q * q))
    if not fit.converged or abs(gain - 1.0) > _GAIN:
        raise InputError(
            f"{what}: the measured motion is {gain:.3g} times that of the readings: are they those "
            "of this joint, in rad or m, and is it the kind of joint that it is said to be?"
        )
    screw = model.joints(fit.p).screws[0]
    S = model.screw_jacobian(fit.p)[0]
    moving = problem.scale[:, None] * free
    half = S @ moving[: S.shape[1]] @ _covariance_root(problem, fit)
    covariance = half @ half.T
    positions = translation_part(model.poses(fit.p, q))
    radius, shift = _about(screw, covariance, positions)
    slides = sweep.kind == "prismatic"
    of_direction = covariance[3:, 3:] if slides else covariance[:3, :3]
    tilt = _deviation(of_direction)
    check_arc(sweep, tilt, shift, what)
    return AxisFit(
        joint=sweep.joint,
        screw=screw,
        covariance=covariance,
        arc=float(np.ptp(measured)),
        radius=radius,
        tilt=tilt,
        shift=shift,
        rms=problem.residuals(fit.p).rms_length,
    )


def _free_motion(count: int) -> Term:
    """Term by which the joint is anywhere at each of the readings: these tell its direction only."""
    names = [f"at reading {k}" for k in range(count)]
    coefficients = [Parameter("joint", name, "rad") for name in names]

    def basis(q: Array, _: Conditions) -> Array:
        return np.eye(len(q))[:, None]

    return Term("free motion", tuple(coefficients), basis)


def _covariance_root(problem: Problem, fit: Fit) -> Array:
    """H (k, M), with H H^T the covariance in the free directions.

    The noise of angles and of lengths is what the fit left of each: where the joint is at a reading
    is told by one of them more than by the other.
    """
    measured = problem.sets[0]
    inverse = np.linalg.inv(qr_r(fit.jacobian))
    Q = fit.jacobian @ inverse
    (errors,) = problem.errors(fit.p)
    e = fit.noise.whitened_errors(0, errors)
    leverages = np.sum(Q * Q, axis=1)
    left = 1.0 - leverages.reshape(e.shape)
    squares = np.sum(e * e, axis=0)
    freedom = np.sum(left, axis=0)
    sizes = []
    for part in (slice(measured.angular), slice(measured.angular, None)):
        ratio = np.sum(squares[part]) / max(np.sum(freedom[part]), 1.0)
        sizes.append(ratio**0.5)
    sigma = per_error(measured, *sizes)
    weights = np.tile(sigma, len(e))
    return inverse @ (Q.T * weights)


def _about(screw: Array, covariance: Array, positions: Array) -> tuple[float, float]:
    """Distance of the positions (N, 3) from an axis, and the standard deviation of its place beside
    them; nothing of a joint that slides.
    """
    u, v = np.split(screw, 2)
    if not u.any():
        return 0.0, 0.0
    foot = np.cross(u, v)
    heights = (positions - foot) @ u
    middle = foot + heights.mean() * u
    # a line through c is v = c x u: dc x u = dv - c x du
    J = np.hstack([-so3.hat(middle), np.eye(3)])
    radius = norm(positions[0] - middle)
    return radius, _deviation(J @ covariance @ J.T)


def _deviation(covariance: Array) -> float:
    return float(np.trace(covariance)) ** 0.5
