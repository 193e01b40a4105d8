"""Poses, three reflectors seen by a device, and distances of one arm, with the errors that are said."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import poekin as pk
from poekin.solve.calibration import Distances, Points, Poses
from poekin.solve.calibration.fit.noise import Noise, NoiseEstimate
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

ARM = pk.load("ur5").chain()
N = 30
Q = ARM.random(3, N)
POINTS = np.array([[0.05, 0.03, 0.1], [-0.05, 0.04, 0.08], [0.0, -0.06, 0.12]])
DEVICE = pk.se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
CENTRE = np.array([1.5, -0.4, 0.3])
FEW = np.arange(4, 14)
WIDTHS = (6, 9, 1)
COUNTS = (N, N, len(FEW))
STD = (NoiseEstimate(2e-4, 1e-4), NoiseEstimate(None, 5e-5), NoiseEstimate(None, 3e-4))
SIGMA = (np.repeat([2e-4, 1e-4], 3), np.full(9, 5e-5), np.full(1, 3e-4))
ENDS = np.cumsum([0, *(n * d for n, d in zip(COUNTS, WIDTHS, strict=True))])


def parts_of(numbers: np.ndarray) -> list[np.ndarray]:
    """Errors (N, d) of each set, of those of all (M,)."""
    pairs = zip(np.split(numbers, ENDS[1:-1]), WIDTHS, strict=True)
    return [part.reshape(-1, width) for part, width in pairs]


def problem_of(whitened: np.ndarray, known: bool = True) -> Problem:
    """The problem whose nominal arm has these errors (M,), in standard deviations; `known`: that the
    covariances are given.
    """
    of_poses, of_points, of_distances = (
        e * sigma for e, sigma in zip(parts_of(whitened), SIGMA, strict=True)
    )
    C: list[Any] = [np.diag(sigma**2) if known else None for sigma in SIGMA]
    T = ARM.fk(Q)
    measured = T.copy()
    measured[:, :3, :3] = pk.so3.exp(-of_poses[:, :3]) @ T[:, :3, :3]
    measured[:, :3, 3] -= of_poses[:, 3:]
    seen = pk.se3.inverse(DEVICE) @ T
    p = POINTS @ np.swapaxes(seen[:, :3, :3], 1, 2) + seen[:, None, :3, 3]
    d = np.linalg.norm(T[FEW, :3, 3] - CENTRE, axis=1) - of_distances[:, 0]
    sets = [
        Poses(measured, C[0]),
        Points(p - of_points.reshape(N, 3, 3), POINTS, C[1], frame="unknown"),
        Distances(d, CENTRE, covariance=float(SIGMA[2][0] ** 2) if known else None, rows=FEW),
    ]
    return Problem(ErrorModel(ARM, ("screws", "home"), None), Q, sets, [DEVICE])


def fit_of(problem: Problem) -> Any:
    """The nominal arm as a fit of all parameters, with the noise of these standard deviations."""
    p = np.zeros(problem.size)
    known = problem.sets[0].covariance is not None
    noise = Noise(problem.sets, [None] * 3 if known else STD)
    J = [
        noise.whitened(k, of_set).reshape(-1, problem.size)
        for k, of_set in enumerate(problem.jacobians(p))
    ]
    return SimpleNamespace(p=p, noise=noise, jacobian=np.concatenate(J))
