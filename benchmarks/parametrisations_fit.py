"""How well an arm's parameters can be identified, and what is found: of link parameters here, of
screws by poekin.
"""

from __future__ import annotations

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from scipy.optimize import least_squares

from poekin import Chain, calibration, so3
from poekin.groups.arrays import Array

from .parametrisations import Elementary

A = TypeVar("A", Elementary, Chain)

NEGLIGIBLE = 1e-10
"""Singular values below this part of the largest are left out of a Gauss-Newton step over link
parameters.
"""


class Sample(NamedTuple):
    """Configurations (N, n) and the tool's poses there (N, 4, 4): measured ones, or fresh ones to
    judge by.
    """

    q: Array
    T: Array

    def error(self, T: Array) -> float:
        """The largest distance of the tool from where it is by the poses T, m."""
        return float(np.linalg.norm(T[:, :3, 3] - self.T[:, :3, 3], axis=-1).max())


class Found(NamedTuple, Generic[A]):
    """An arm as it was found, and its errors on fresh poses: at the start and after each step (m)."""

    arm: A
    errors: list[float]

    def steps_to(self, error: float) -> int | None:
        """The number of steps after which the error is that small; None where it never is."""
        return next((k for k, e in enumerate(self.errors) if e <= error), None)


class Descent(NamedTuple):
    """What Levenberg-Marquardt ends with: the arm, evaluations of the poses, error on fresh poses
    (m).
    """

    arm: Elementary
    evaluations: int
    error: float


def condition(arm: Elementary | Chain, q: Array, R: float) -> float:
    """Largest ÷ smallest singular value on the identifiable space, from poses at q; lengths in R,
    rows and columns.

    Of a chain the unit is its own reach.
    """
    if isinstance(arm, Chain):
        return float(calibration.identify(arm, q, arm.fk(q)).condition)
    values = np.linalg.svd(identification(arm, q, R), compute_uv=False)
    return float(values[0] / values[-1])


def identification(arm: Elementary, q: Array, R: float) -> Array:
    """(6 N, P): the poses' derivatives by the parameters, with lengths in units of R in rows and
    columns.
    """
    J = arm.columns(q) * units(arm, R)
    J[:, 3:] /= R
    return J.reshape(-1, J.shape[-1])


def units(arm: Elementary, R: float) -> Array:
    """(P,) what one unit of each scaled parameter is, in rad or m."""
    return np.where(arm.lengths, R, 1.0)


def residuals(arm: Elementary, measured: Sample, R: float) -> Array:
    """(6 N,): rotation vector of R_arm R_measured^T, and the difference of positions ÷ R."""
    T = arm.poses(measured.q)
    turn = so3.log(T[:, :3, :3] @ np.swapaxes(measured.T[:, :3, :3], -1, -2))
    return np.concatenate([turn, (T[:, :3, 3] - measured.T[:, :3, 3]) / R], axis=-1).ravel()


def gauss_newton(
    arm: Elementary, measured: Sample, fresh: Sample, R: float, steps: int
) -> Found[Elementary]:
    """That many full steps, with no damping."""
    errors = [fresh.error(arm.poses(fresh.q))]
    for _ in range(steps):
        J, r = identification(arm, measured.q, R), residuals(arm, measured, R)
        arm = arm.moved(-units(arm, R) * np.linalg.lstsq(J, r, rcond=NEGLIGIBLE)[0])
        errors.append(fresh.error(arm.poses(fresh.q)))
    return Found(arm, errors)


def levenberg_marquardt(
    arm: Elementary, measured: Sample, fresh: Sample, R: float, evaluations: int
) -> Descent:
    """SciPy's (MINPACK's) with its own tolerances and the exact derivative."""
    scale = units(arm, R)
    jacobian: Any = lambda y: identification(arm.moved(scale * y), measured.q, R)  # noqa: E731  SciPy's stubs know no callable here
    found = least_squares(
        lambda y: residuals(arm.moved(scale * y), measured, R),
        np.zeros(len(scale)), jacobian, method="lm", max_nfev=evaluations,
    )  # fmt: skip
    end = arm.moved(scale * found.x)
    return Descent(end, int(found.nfev), fresh.error(end.poses(fresh.q)))


def calibrated(arm: Chain, measured: Sample, fresh: Sample, steps: int) -> Found[Chain]:
    """poekin's calibration of screws and home pose, stopped after one step, two, ... or where it
    ends by itself.

    Angles and lengths ÷ R weigh the same, as in `residuals`. Raises: RuntimeError for a step that
    had to be damped.
    """
    poses = calibration.Poses(measured.T, covariance=np.diag([1.0] * 3 + [arm.reach**2] * 3))
    errors, found = [fresh.error(arm.fk(fresh.q))], arm
    for most in range(1, steps + 1):
        result = calibration.calibrate(arm, measured.q, poses, folds=0, iterations=most)
        if any(step.damping for step in result.steps):
            raise RuntimeError("a step was damped: it is no Gauss-Newton step")
        if len(result.steps) < most:
            break
        found = result.chain
        errors.append(fresh.error(found.fk(fresh.q)))
    return Found(found, errors)
