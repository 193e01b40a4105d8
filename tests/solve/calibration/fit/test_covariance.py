"""The covariance of a fit: Huber's, a prior's, and which errors depend on each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import Distances, Points, Poses, calibrate
from poekin.solve.calibration.diagnostics.identification import identify_directions
from poekin.solve.calibration.fit import covariance, fitting, losses
from poekin.solve.calibration.fit.covariance import clusters_of, covariance_of
from poekin.solve.calibration.fit.losses import LossName
from poekin.solve.calibration.fit.minimise import FitOptions
from poekin.solve.calibration.model.configurations import configurations
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

PUMA = pk.load("puma560").chain()
MODEL = ErrorModel(PUMA, ("screws", "home"), None)
TRUE = MODEL.chain(2e-3 * np.random.default_rng(1).normal(size=30))
C = 4e-8 * np.eye(6)


def problem_of(count: int, C: Any = None, outliers: int = 0) -> Problem:
    rng = np.random.default_rng(2)
    q = PUMA.random(rng, count)
    T = TRUE.fk(q) @ se3.exp(2e-4 * rng.normal(size=(count, 6)))
    T[:outliers] = T[:outliers] @ se3.exp([0, 0, 0, 0.01, 0, 0])
    return Problem(MODEL, q, [Poses(T, C)])


@pytest.mark.parametrize("loss", ["huber", "tukey"])
def test_the_covariance_of_a_robust_loss_is_huber_s(loss: LossName):
    problem = problem_of(40, C, 3)
    free = identify_directions(problem)[1]
    options = FitOptions(loss)
    fit = fitting.fit_parameters(problem, free, np.zeros(problem.size), options)
    whitened = [fit.noise.whitened(0, jacobian) for _, jacobian in problem.linearised(fit.p)]
    J = np.concatenate(whitened).reshape(-1, problem.size) @ (problem.scale[:, None] * free)
    e = fit.noise.whitened(0, problem.errors(fit.p)[0][..., None])[..., 0]

    def psi(e: np.ndarray) -> np.ndarray:
        return e * losses.loss(loss, (e**2).sum(1), 6).weight[:, None]

    np.testing.assert_allclose(
        covariance._scores(problem, fit, options), psi(e).ravel(), rtol=0, atol=1e-12
    )
    # where the sum of rho is least its slope is 0, to the last step that was taken
    score = J.T @ psi(e).ravel()
    assert np.abs(score).max() <= 1e-4 * np.abs(J.T * psi(e).ravel()).sum(axis=1).max()

    # psi(e) = w e of all six numbers of a measurement, its divergence by differences
    h = 1e-5
    steps = [psi(e + h * d)[:, i] - psi(e - h * d)[:, i] for i, d in enumerate(np.eye(6))]
    slope = np.mean(steps) / (2 * h)
    spent = np.sum(psi(e) ** 2) / (e.size - free.shape[1])
    B = problem.scale[:, None] * free
    expected = B @ np.linalg.inv(J.T @ J) @ B.T * spent / slope**2
    size = np.sqrt(np.diag(expected))
    # differences are right to h^2 / 6, and the Jacobian is the one before the last short step
    even = covariance_of(problem, fit, options) / np.outer(size, size)
    np.testing.assert_allclose(even, expected / np.outer(size, size), rtol=0, atol=1e-3)


def test_a_prior_counts_in_the_covariance_as_a_measurement_of_each_parameter():
    problem = problem_of(10, 1e-8 * np.eye(6))
    prior = np.where(np.arange(problem.size) % 3 > 0, 1e-4, np.inf)
    options = FitOptions("linear", prior)
    fit = fitting.fit_parameters(problem, np.eye(problem.size), np.zeros(problem.size), options)
    J = 1e4 * problem.linearised(fit.p)[0].jacobian.reshape(-1, problem.size)
    expected = np.linalg.inv(J.T @ J + np.diag(1 / prior**2))
    size = np.sqrt(np.diag(expected))
    even = covariance_of(problem, fit, options) / np.outer(size, size)
    np.testing.assert_allclose(even, expected / np.outer(size, size), atol=1e-6)


def sets_of(q: np.ndarray, *sets: Any) -> Any:
    return clusters_of(Problem(MODEL, q, list(sets)))


def test_errors_are_taken_together_where_a_configuration_carries_more_than_a_point():
    q = PUMA.random(0, 4)
    p = PUMA.fk(q)[:, :3, 3]
    assert sets_of(q, Points(p)) is None
    assert sets_of(q, Poses(PUMA.fk(q), C)) is None
    assert sets_of(q, Poses(PUMA.fk(q))).tolist() == np.repeat(range(4), 6).tolist()
    assert sets_of(q, Distances(np.linalg.norm(p, axis=1), [0.0, 0, 0])) is None
    again = [0, 1, 2, 3, 1]
    assert sets_of(q[again], Points(p[again])).tolist() == np.repeat(again, 3).tolist()
    both = sets_of(q, Points(p), Points(p[:2], rows=[3, 2]))
    assert both.tolist() == np.repeat([0, 1, 2, 3, 3, 2], 3).tolist()


@pytest.mark.parametrize(("apart", "same"), [(0.9e-3, True), (1.1e-3, False)])
def test_nearly_equal_readings_are_of_one_configuration(apart, same):
    q = PUMA.random(0, 30)
    near = q[[4, 9]].copy()
    near[:, 2] += apart
    found = configurations(np.concatenate([q, near]))
    assert found[:30].tolist() == list(range(30))
    assert found[30:].tolist() == ([4, 9] if same else [30, 31])
    assert configurations(q[:0]).tolist() == []
    assert configurations(np.empty((3, 0))).tolist() == [0, 0, 0]


def test_readings_that_differ_in_one_coordinate_alone_are_told_apart_whatever_its_place():
    grid = np.array(np.meshgrid([0.0, 0.1], [0.0, 0.1], [0.0, 0.1])).reshape(3, -1).T
    assert configurations(grid).tolist() == list(range(8))
    assert configurations(np.tile(grid, (3, 1))).tolist() == list(range(8)) * 3


def test_what_is_left_of_a_configuration_by_every_reflector_widens_the_deviations(monkeypatch):
    """Three reflectors with one error in common: as much is known as from one."""
    rng = np.random.default_rng(3)
    q = PUMA.random(rng, 60)
    points = np.array([[0.05, 0, 0.02], [-0.03, 0.05, 0.02], [0, -0.04, 0.06]])
    T = TRUE.fk(q)
    p = points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]
    together = Points(p + 1e-3 * rng.normal(size=(60, 1, 3)), points)
    clustered = calibrate(PUMA, q, together, folds=0)
    robust = calibrate(PUMA, q, together, folds=0, loss="huber")
    # Huber's estimate of normal errors needs 5 % more of them, 2.5 % in a deviation
    even = robust.workspace(100).length / clustered.workspace(100).length
    assert np.median(even) == pytest.approx(1.0, abs=0.1)
    monkeypatch.setattr(covariance, "clusters_of", lambda problem: None)
    alone = calibrate(PUMA, q, together, folds=0)
    ratio = clustered.workspace(100).length / alone.workspace(100).length
    # the root of 3, but for the turns, which differences of reflectors tell
    assert 1.4 < np.median(ratio) < 2.0
