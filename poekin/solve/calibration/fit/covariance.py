"""Covariance of a fit's parameters: by the noise alone, or by clusters of errors that depend on each
other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ..model.configurations import configurations
from ..model.problem import Problem
from ..model.tsqr import least_squares, qr_r
from ..selection.jackknife import Jackknife
from .fitting import Fit
from .losses import loss
from .minimise import FitOptions, regular

_OWN = 3
"""Numbers of a configuration that are taken for independent: those of one point."""


def covariance_of(problem: Problem, fit: Fit, options: FitOptions) -> Array:
    """Covariance (P, P) of p, (J^T J)^-1 of the whitened Jacobian J; with a robust loss times
    mean(psi^2) / mean(psi')^2.

    Where a configuration carries more than three numbers, and their covariance is not given, their
    errors may depend on each other, as those of three reflectors on an arm that bends: (J^T J)^-1
    M (J^T J)^-1 then, with the M of `Jackknife`. Source: Huber, Robust Statistics, 1981, section 7.6; Liang
    and Zeger 1986 (Biometrika 73) for clusters.
    """
    B = problem.scale[:, None] * fit.free
    A = fit.jacobian
    if options.prior is not None:
        of_prior = (1.0 / options.prior)[:, None] * B
        A = np.concatenate([A, of_prior])
    R = qr_r(A) if fit.triangle is None else fit.triangle
    inverse = _inverse(R)
    half = B @ inverse
    clusters = clusters_of(problem)
    if clusters is not None:
        scores = _scores(problem, fit, options)
        M = Jackknife(A @ inverse, clusters).meat(scores)
        half = half @ _root(M)
    covariance = half @ half.T  # a product with its own transpose is symmetric to the last bit
    if options.loss == "linear":
        return covariance
    psi_squared = 0.0
    psi_slope = 0.0
    total = problem.n_equations
    squares = fit.noise.squares(problem.errors(fit.p))
    for s, m in zip(squares, problem.sets, strict=True):
        rho = loss(options.loss, s, m.width)
        slopes = m.width * rho.weight + 2.0 * rho.rho_second * s
        psi_squared += float(np.sum(rho.weight**2 * s))
        psi_slope += float(np.sum(slopes))
    # residuals after a fit are smaller than the noise, by what the parameters took up
    freedom = total - fit.free.shape[1]
    psi_squared /= max(freedom, 1)
    if clusters is not None:
        psi_squared = 1.0  # its part is in the scores
    mean_slope = max(psi_slope / total, 1e-3)
    return covariance * psi_squared / mean_slope**2


def clusters_of(problem: Problem) -> NDArray[np.intp] | None:
    """Configuration of each number that was measured (M,); None where no errors depend on each
    other, or all their covariances are given: these are believed.
    """
    if all(s.covariance is not None for s in problem.sets):
        return None
    label = configurations(problem.q)
    of_sets = []
    for s, rows in zip(problem.sets, problem.rows, strict=True):
        of_set = np.repeat(label[rows], s.width)
        of_sets.append(of_set)
    clusters = np.concatenate(of_sets)
    if np.bincount(clusters).max() <= _OWN:
        return None
    return clusters


def _scores(problem: Problem, fit: Fit, options: FitOptions) -> Array:
    """Whitened errors (M,), with the weights of the loss."""
    found = []
    for k, errors in enumerate(problem.errors(fit.p)):
        e = fit.noise.whitened_errors(k, errors)
        squares = np.sum(e * e, axis=1)
        weight = loss(options.loss, squares, e.shape[1]).weight
        weighted = e * weight[:, None]
        found.append(weighted.ravel())
    return np.concatenate(found)


def _root(M: Array) -> Array:
    """A root R of a positive semidefinite matrix, R R^T = M."""
    values, V = np.linalg.eigh(M)
    return V * np.sqrt(np.maximum(values, 0.0))


def _inverse(R: Array) -> Array:
    """Inverse of a triangle, the pseudoinverse of a singular one."""
    if regular(R):
        return np.asarray(np.linalg.inv(R), float)
    return least_squares(R, np.eye(len(R)))
