"""Gauss-Newton with Levenberg and Marquardt's damping where a step fails, over whitened errors with
a robust loss.

An own loop in place of a library's: a loss here belongs to a whole measurement, not to each of its
numbers, and the slopes are exact, so that a step costs one QR factorisation.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..model.problem import Problem
from ..model.tsqr import times, triangle
from .losses import loss
from .noise import Noise

STEPS = 100
"""Of a fit in all, each time that its spreads are estimated anew included."""
_ENOUGH = 1e-10  # a step that would gain less than this part of the cost is not worth another one
_ROUNDING = 1e-13  # a step or an error smaller than this, in rad and reaches, is rounding
_REGULAR = (
    1e-8  # of a triangle's diagonal, least to largest: below it, the shortest solution is taken
)
_FIRST_DAMPING, _MOST_DAMPING = 1e-4, 1e12


class Step(NamedTuple):
    """One iteration: the cost that it began with, the length of its step (rad and reaches), its
    damping.
    """

    cost: float
    step: float
    damping: float


class Outcome(NamedTuple):
    """Where the search ended: p; whether it converged; the steps; whitened slopes (M, k) in the
    free directions.
    """

    p: Array
    converged: bool
    steps: list[Step]
    slopes: Array


def minimise(
    problem: Problem,
    free: Array,
    noise: Noise,
    name: str,
    p: Array,
    prior: Array | None,
    most: int = STEPS,
) -> Outcome:
    """The p of the least cost, sum of rho(s) and of (p / prior)^2, among p + scale * free z.

    free (P, k): directions, in rad and reaches; prior (P,): standard deviations, infinite where
    there is none.
    """
    B = problem.scale[:, None] * free
    inverse = np.zeros(len(p)) if prior is None else 1.0 / prior
    kept = inverse > 0
    damping, steps = 0.0, []
    cost = _cost(problem, noise, name, p, inverse)
    while True:
        A, b, slopes = _rows(problem, noise, name, p, B)
        if cost == 0.0 or len(steps) >= most:
            return Outcome(p, cost == 0.0, steps, slopes)
        if kept.any():
            A, b = (
                np.concatenate([A, (inverse[:, None] * B)[kept]]),
                np.concatenate([b, (inverse * p)[kept]]),
            )
        both = triangle(np.column_stack([A, b]))
        R, c = both[: free.shape[1], :-1], both[: free.shape[1], -1]
        z = _solved(R, c, 0.0)
        # of the full step: a damped one promises little wherever it is
        done = c @ c - np.sum((R @ z + c) ** 2) <= _ENOUGH * cost or np.linalg.norm(z) <= _ROUNDING
        while True:
            if damping > 0.0:
                z = _solved(R, c, damping)
            new = p + B @ z
            after = _cost(problem, noise, name, new, inverse) if np.isfinite(z).all() else np.inf
            if after <= cost:
                break
            done = bool(done or _exact(problem, p))
            if done or damping > _MOST_DAMPING:
                # what is left cannot be told from rounding, or no direction leads down
                return Outcome(p, done, steps, slopes)
            damping = max(_FIRST_DAMPING, 10.0 * damping)
        steps.append(Step(cost, float(np.linalg.norm(z)), damping))
        p, cost = new, after
        damping = damping / 10.0 if damping > _FIRST_DAMPING else 0.0
        if done:
            # the step was too short to change the slopes
            return Outcome(p, True, steps, slopes)


def _solved(R: Array, c: Array, damping: float) -> Array:
    """The z of the least |R z + c|^2 + damping |diag(|R|) z|^2."""
    if damping > 0.0:
        more = np.sqrt(damping) * np.maximum(np.linalg.norm(R, axis=0), np.finfo(float).tiny)
        R, c = np.concatenate([R, np.diag(more)]), np.concatenate([c, np.zeros(len(more))])
    elif regular(R):
        return np.asarray(np.linalg.solve(R, -c), float)
    return np.asarray(np.linalg.lstsq(R, -c, rcond=None)[0], float)


def regular(R: Array) -> bool:
    """Whether a triangle (k, k) is far from singular."""
    diagonal = np.abs(np.diag(R))
    return R.shape[0] == R.shape[1] and bool(
        diagonal.min(initial=np.inf) > _REGULAR * diagonal.max(initial=0.0)
    )


def _exact(problem: Problem, p: Array) -> bool:
    """Whether all errors are rounding."""
    reach = problem.arm.nominal.reach
    return all(
        np.abs(e[:, : s.angular]).max(initial=0.0) <= _ROUNDING
        and np.abs(e[:, s.angular :]).max(initial=0.0) <= _ROUNDING * reach
        for s, e in zip(problem.sets, problem.errors(p), strict=True)
    )


def _cost(problem: Problem, noise: Noise, name: str, p: Array, inverse: Array) -> float:
    total = float(np.sum((inverse * p) ** 2))
    for k, errors in enumerate(problem.errors(p)):
        s = np.sum(noise.whitened(k, errors[..., None]) ** 2, axis=(1, 2))
        total += float(np.sum(loss(name, s, errors.shape[1]).rho))
    return total if np.isfinite(total) else np.inf


def _rows(
    problem: Problem, noise: Noise, name: str, p: Array, B: Array
) -> tuple[Array, Array, Array]:
    """Weighted slopes (M, k) and errors (M,), and the slopes without the loss's weights."""
    A, b, plain = [], [], []
    for k, (errors, slopes) in enumerate(problem.linearised(p)):
        e = noise.whitened(k, errors[..., None])[..., 0]
        D = times(noise.whitened(k, slopes).reshape(-1, slopes.shape[-1]), B)
        root = np.repeat(np.sqrt(loss(name, np.sum(e * e, axis=1), e.shape[1]).weight), e.shape[1])
        plain.append(D)
        A.append(D if name == "linear" else root[:, None] * D)
        b.append(root * e.ravel())
    return np.concatenate(A), np.concatenate(b), np.concatenate(plain)
