"""Gauss-Newton with Levenberg and Marquardt's damping where a step fails, over whitened errors with
a robust loss.

An own loop in place of a library's: a loss here belongs to a whole measurement, not to each of its
numbers, and the Jacobian is exact, so that a step costs one QR factorisation.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norm
from ..measurements.measurement import per_error
from ..model.problem import Problem
from ..model.tsqr import blocked_product, least_squares, qr_r
from .losses import LossName, loss
from .noise import Noise

STEPS = 100
"""Of a fit in all, each time that its noise is estimated anew included."""
_ENOUGH = 1e-10  # a step that would gain less than this part of the cost is not worth another one
_ROUNDING = 1e-13  # a step or an error smaller than this, in rad and reaches, is rounding
# of a triangle's diagonal, least to largest: below it, the shortest solution is taken
_REGULAR = 1e-8
_FIRST_DAMPING = 1e-4
_MOST_DAMPING = 1e12


class FitOptions(NamedTuple):
    """Loss of a fit, standard deviations (P,) of a prior, infinite where nothing is told, and the
    most steps.
    """

    loss: LossName
    prior: Array | None = None
    max_iterations: int = STEPS


class Step(NamedTuple):
    """One iteration: the cost that it began with, the length of its step (rad and reaches), its
    damping.
    """

    cost: float
    step: float
    damping: float


class Minimum(NamedTuple):
    """End of the search: p; whether it converged; the steps; the whitened Jacobian (M, k) in the
    free directions.
    """

    p: Array
    converged: bool
    steps: list[Step]
    jacobian: Array


class _Objective(NamedTuple):
    """Sum of rho(s) and of (p / prior)^2, and the free directions B (P, k) in the units of p."""

    problem: Problem
    noise: Noise
    loss: LossName
    inverse_prior: Array
    B: Array


class _Linear(NamedTuple):
    """Triangle R (k, k) and c (k,) with |A z + b|^2 = |R z + c|^2 + constant, of a step z in the
    free directions.
    """

    R: Array
    c: Array


class _Trial(NamedTuple):
    """A step z, the p that it leads to, and the cost there."""

    z: Array
    p: Array
    cost: float


def minimise(
    problem: Problem,
    free: Array,
    noise: Noise,
    p: Array,
    options: FitOptions,
) -> Minimum:
    """The p of the least cost, sum of rho(s) and of (p / prior)^2, among p + scale * free z.

    free (P, k): directions, in rad and reaches.
    """
    inverse = np.zeros(len(p))
    if options.prior is not None:
        inverse = 1.0 / options.prior
    B = problem.scale[:, None] * free
    objective = _Objective(problem, noise, options.loss, inverse, B)
    damping = 0.0
    steps: list[Step] = []
    cost = _cost(objective, p)
    while True:
        rows, jacobian = _rows(objective, p)
        if cost == 0.0 or len(steps) >= options.max_iterations:
            return Minimum(p, cost == 0.0, steps, jacobian)
        linear = _triangular(objective, p, rows)
        done = _is_last(linear, cost)
        trial = _trial(objective, p, linear, damping)
        while not trial.cost <= cost:
            done = bool(done or _exact(problem, p))
            if done or damping > _MOST_DAMPING:
                # what is left cannot be told from rounding, or no direction leads down
                return Minimum(p, done, steps, jacobian)
            damping = max(_FIRST_DAMPING, 10.0 * damping)
            trial = _trial(objective, p, linear, damping)
        length = norm(trial.z)
        steps.append(Step(cost, length, damping))
        p = trial.p
        cost = trial.cost
        if damping > _FIRST_DAMPING:
            damping = damping / 10.0
        else:
            damping = 0.0
        if done:
            # the step was too short to change the Jacobian
            return Minimum(p, True, steps, jacobian)


def _triangular(objective: _Objective, p: Array, rows: Array) -> _Linear:
    """Weighted Jacobian and errors (M, k + 1) with the rows of the prior, as a triangle."""
    known = np.flatnonzero(objective.inverse_prior)
    inverse = objective.inverse_prior[known]
    B = inverse[:, None] * objective.B[known]
    of_prior = np.column_stack([B, inverse * p[known]])
    if len(known):
        rows = np.concatenate([rows, of_prior])
    triangle = qr_r(rows)
    R = triangle[: B.shape[1]]
    return _Linear(R[:, :-1], R[:, -1])


def _is_last(linear: _Linear, cost: float) -> bool:
    """Whether the full step gains next to nothing; a damped one promises little wherever it is."""
    R, c = linear
    z = _solution(linear, 0.0)
    gain = c @ c - np.sum((R @ z + c) ** 2)
    return bool(gain <= _ENOUGH * cost or np.linalg.norm(z) <= _ROUNDING)


def _trial(
    objective: _Objective,
    p: Array,
    linear: _Linear,
    damping: float,
) -> _Trial:
    z = _solution(linear, damping)
    new = p + objective.B @ z
    cost = np.inf
    if np.isfinite(z).all():
        cost = _cost(objective, new)
    return _Trial(z, new, cost)


def _solution(linear: _Linear, damping: float) -> Array:
    """The z of the least |R z + c|^2 + damping |diag(|R|) z|^2."""
    R, c = linear
    if damping > 0.0:
        norms = np.linalg.norm(R, axis=0)
        scales = np.maximum(norms, np.finfo(float).tiny)
        weights = np.sqrt(damping) * scales
        zeros = np.zeros(len(norms))
        R = np.concatenate([R, np.diag(weights)])
        c = np.concatenate([c, zeros])
    elif regular(R):
        return np.asarray(np.linalg.solve(R, -c), float)
    return least_squares(R, -c)


def regular(R: Array) -> bool:
    """Whether a triangle (k, k) is far from singular."""
    if R.shape[0] != R.shape[1]:
        return False
    diagonal = np.abs(np.diag(R))
    least = diagonal.min(initial=np.inf)
    return bool(least > _REGULAR * diagonal.max(initial=0.0))


def _exact(problem: Problem, p: Array) -> bool:
    """Whether all errors are rounding."""
    reach = problem.model.nominal.reach
    least = [_ROUNDING * per_error(s, 1.0, reach) for s in problem.sets]
    pairs = zip(problem.errors(p), least, strict=True)
    return all((np.abs(e) <= small).all() for e, small in pairs)


def _cost(objective: _Objective, p: Array) -> float:
    of_prior = float(np.sum((objective.inverse_prior * p) ** 2))
    return misfit(objective.problem, objective.noise, objective.loss, p, of_prior)


def misfit(
    problem: Problem,
    noise: Noise,
    name: LossName,
    p: Array,
    of_prior: float = 0.0,
) -> float:
    """Sum of rho of all measurements, and the part of the prior."""
    total = of_prior
    every = noise.squares(problem.errors(p))
    for s, squares in zip(problem.sets, every, strict=True):
        rho = loss(name, squares, s.width).rho
        total += float(np.sum(rho))
    return total


def _rows(objective: _Objective, p: Array) -> tuple[Array, Array]:
    """Weighted Jacobian and errors (M, k + 1), and the Jacobian without the loss's weights."""
    weighted = []
    plain = []
    for k, (errors, jacobian) in enumerate(objective.problem.linearised(p)):
        e = objective.noise.whitened(k, errors[..., None])[..., 0]
        width = e.shape[1]
        whitened = objective.noise.whitened(k, jacobian)
        stacked = whitened.reshape(-1, jacobian.shape[2])
        D = blocked_product(stacked, objective.B)
        rows = np.column_stack([D, e.ravel()])
        if objective.loss != "linear":  # of which each weight is 1
            squares = np.sum(e * e, axis=1)
            weight = loss(objective.loss, squares, width).weight
            rows *= np.repeat(np.sqrt(weight), width)[:, None]
        weighted.append(rows)
        plain.append(D)
    return np.concatenate(weighted), np.concatenate(plain)
