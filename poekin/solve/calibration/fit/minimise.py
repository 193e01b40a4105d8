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
_FIRST_DAMPING = 1e-6
_MOST_DAMPING = 1e12
_MOST_FALL = 0.1
_PLAIN = 4  # steps, after which one that was not damped follows a curved valley, too
_AHEAD = 0.1  # of a step: where its second derivative is looked for
_BENDING = 0.375
# a search of more steps than this, lightly damped, ends where a step gains less than this part of
# the square of the noise
_SLOW = 10
_LIGHT = 1e-6
_CHANCE = 1e-4


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
    free directions, and its triangle with the rows of the prior, None where the loss has weights.
    """

    p: Array
    converged: bool
    steps: list[Step]
    jacobian: Array
    triangle: Array | None = None


class _Objective(NamedTuple):
    """Sum of rho(s) and of (p / prior)^2, and the free directions B (P, k) in the units of p."""

    problem: Problem
    noise: Noise
    loss: LossName
    inverse_prior: Array
    B: Array


class _Damping:
    """Damping of the steps, none at first.

    Source: Nielsen 1999, "Damping parameter in Marquardt's method" (IMM-REP-1999-05), with a tenth
    in place of his third.
    """

    def __init__(self) -> None:
        self.value = 0.0
        self._growth = 2.0

    def grow(self) -> None:
        """After a step that led up: twice, then four times, eight times as much."""
        if self.value:
            self.value *= self._growth
            self._growth *= 2.0
        else:
            self.value = _FIRST_DAMPING

    def fall(self, gain: float, predicted: float) -> None:
        """After a step that led down: to a tenth where its gain is the predicted one, or more."""
        self._growth = 2.0
        ratio = 1.0
        if predicted > gain:
            ratio = gain / predicted
        factor = 1.0 - (2.0 * ratio - 1.0) ** 3
        self.value *= max(_MOST_FALL, factor)


class _Linear(NamedTuple):
    """Triangle R (k, k) and c (k,) with |A z + b|^2 = |R z + c|^2 + constant, of a step z in the
    free directions.
    """

    R: Array
    c: Array


class _Valley(NamedTuple):
    """Weighted Jacobian and errors (M, k + 1) without a prior, the Jacobian without the loss's weights,
    and the roots (M,) of these.
    """

    rows: Array
    jacobian: Array
    weights: Array


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
    damping = _Damping()
    steps: list[Step] = []
    cost = _cost(objective, p)
    while True:
        valley = _valley(objective, p)
        jacobian = valley.jacobian
        if cost == 0.0 or len(steps) >= options.max_iterations:
            return Minimum(p, cost == 0.0, steps, jacobian)
        linear = _triangular(objective, p, valley.rows)
        triangle = linear.R if options.loss == "linear" else None
        full = _solution(linear, 0.0)
        done = _is_last(linear, cost, full)
        z = full
        if damping.value or len(steps) >= _PLAIN:
            z = _bent(objective, p, linear, damping.value, valley)
        trial = _trial(objective, p, z)
        while not trial.cost <= cost:
            done = bool(done or _exact(problem, p))
            if done or damping.value > _MOST_DAMPING:
                # what is left cannot be told from rounding, or no direction leads down
                return Minimum(p, done, steps, jacobian, triangle)
            damping.grow()
            z = _bent(objective, p, linear, damping.value, valley)
            trial = _trial(objective, p, z)
        step = Step(cost, norm(trial.z), damping.value)
        steps.append(step)
        predicted = _predicted(linear, trial.z)
        errors, columns = valley.rows.shape
        freedom = max(errors - columns, 1)
        gain = cost - trial.cost
        # a bent step leaves the linear problem, whose prediction may be a loss
        is_slight = max(gain, predicted) < _CHANCE * cost / freedom
        is_light = 0.0 < damping.value < _LIGHT
        done = done or (is_slight and is_light and len(steps) > _SLOW)
        damping.fall(gain, predicted)
        p = trial.p
        cost = trial.cost
        if done:
            # the step was too short to change the Jacobian
            return Minimum(p, True, steps, jacobian, triangle)


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


def _is_last(linear: _Linear, cost: float, z: Array) -> bool:
    """Whether the full step z gains next to nothing; a damped one promises little wherever it is."""
    gain = _predicted(linear, z)
    return gain <= _ENOUGH * cost or norm(z) <= _ROUNDING


def _predicted(linear: _Linear, z: Array) -> float:
    """Gain of a step as the linear problem has it."""
    R, c = linear
    left = R @ z + c
    return float(c @ c - np.sum(left**2))


def _trial(objective: _Objective, p: Array, z: Array) -> _Trial:
    new = p + objective.B @ z
    cost = np.inf
    if np.isfinite(z).all():
        cost = _cost(objective, new)
    return _Trial(z, new, cost)


def _bent(
    objective: _Objective,
    p: Array,
    linear: _Linear,
    damping: float,
    valley: _Valley,
) -> Array:
    """Step with half its geodesic acceleration, by which it follows a valley that is curved; without
    where that is more than 3/8 of the step, and the curvature not the same all along it.

    Source: Transtrum and Sethna 2012, "Improvements to the Levenberg-Marquardt algorithm for
    nonlinear least-squares minimization" (arXiv:1201.5885), with their step of 0.1.
    """
    z = _solution(linear, damping)
    if not np.isfinite(z).all():
        return z
    A = valley.rows[:, :-1]
    here = valley.rows[:, -1]
    ahead = p + objective.B @ (_AHEAD * z)
    there = valley.weights * objective.noise.stacked(objective.problem.errors(ahead))
    slope = (there - here) / _AHEAD
    second = 2.0 / _AHEAD * (slope - A @ z)
    scales = np.linalg.norm(linear.R, axis=0)
    normal = linear.R.T @ linear.R + damping * np.diag(scales**2)
    a = -0.5 * least_squares(normal, A.T @ second)
    if norm(scales * a) <= _BENDING * norm(scales * z):
        return z + a
    return z


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
    problem, noise, name, inverse, _ = objective
    of_prior = np.sum((inverse * p) ** 2)
    return misfit(problem, noise, name, p, float(of_prior))


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


def _valley(objective: _Objective, p: Array) -> _Valley:
    found = []
    for k, (errors, jacobian) in enumerate(objective.problem.linearised(p)):
        e = objective.noise.whitened_errors(k, errors)
        width = e.shape[1]
        whitened = objective.noise.whitened(k, jacobian)
        stacked = whitened.reshape(-1, jacobian.shape[2])
        D = blocked_product(stacked, objective.B)
        rows = np.column_stack([D, e.ravel()])
        root = np.ones(len(rows))
        if objective.loss != "linear":  # of which each weight is 1
            squares = np.sum(e * e, axis=1)
            weight = loss(objective.loss, squares, width).weight
            root = np.repeat(np.sqrt(weight), width)
            rows *= root[:, None]
        found.append(_Valley(rows, D, root))
    return _Valley(*map(np.concatenate, zip(*found, strict=True)))
