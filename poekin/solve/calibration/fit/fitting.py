"""One fit: unknown frames first, then all that is free; spreads that are not given are estimated
along.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..measurements.measurement import Indices
from ..model.problem import Problem
from ..model.tsqr import triangle
from .losses import OUTLIER, chi_square, loss
from .minimise import STEPS, Outcome, Step, minimise, regular
from .noise import EVEN, Noise, spreads

_ROUNDS = 10
_FIRST = (
    1e-2  # how even the spreads of angles and lengths are taken to be before anything was fitted
)
_SAME = 1e-2  # spreads that change by less are settled: they are known to some per cent only


class Fit(NamedTuple):
    """Parameters p with covariance (P, P), in the parameters' units; whether it converged; the
    steps; the noise; the directions (P, k) that were free, in rad and reaches.
    """

    p: Array
    covariance: Array
    converged: bool
    steps: list[Step]
    noise: Noise
    free: Array


def frames_only(problem: Problem, name: str, most: int = STEPS) -> tuple[Array, bool]:
    """The p with which the nominal arm fits best: only the unknown frames move."""
    p = np.zeros(problem.size)
    if problem.size == problem.arm_size:
        return p, True
    free = np.eye(problem.size)[:, problem.arm_size :]
    fit = fitted(problem, free, name, p, None, most)
    return fit.p, fit.converged


def fitted(
    problem: Problem, free: Array, name: str, p: Array, prior: Array | None, most: int = STEPS
) -> Fit:
    """The fit from p on, of so many steps at most. A robust loss begins as Huber's, which has one
    minimum near p.
    """
    robust = name != "linear"
    reach, k = problem.arm.nominal.reach, free.shape[1]

    def noise_at(p: Array, free: int, even: float = EVEN) -> Noise:
        return Noise(
            problem.sets, spreads(problem.sets, problem.errors(p), free, robust, reach, even)
        )

    noise, steps = noise_at(p, 0, _FIRST), []
    for number in range(_ROUNDS):
        for one in ("huber", name) if robust and number == 0 and name != "huber" else (name,):
            outcome = minimise(problem, free, noise, one, p, prior, most - len(steps))
            p = outcome.p
            steps += outcome.steps
        if not noise.estimated:
            break
        before, noise = noise, noise_at(p, k)
        if _change(before, noise) < _SAME:
            break
        if len(steps) >= most:
            outcome = outcome._replace(converged=False)
            break
    return Fit(
        p,
        _covariance(problem, free, outcome, noise, name, prior),
        outcome.converged,
        steps,
        noise,
        free,
    )


def _change(a: Noise, b: Noise) -> float:
    both = [
        (x, y)
        for s, t in zip(a.spreads, b.spreads, strict=True)
        if s and t
        for x, y in zip(s, t, strict=True)
    ]
    return max((abs(y / x - 1.0) for x, y in both if x and y), default=0.0)


def squared(problem: Problem, noise: Noise, p: Array) -> list[Array]:
    """s = e^T C^-1 e of each measurement of each set."""
    return [
        np.sum(noise.whitened(k, e[..., None]) ** 2, axis=(1, 2)) for k, e in enumerate(problem.errors(p))
    ]  # fmt: skip


def outliers(problem: Problem, noise: Noise, p: Array) -> list[Indices]:
    """The measurements of each set that are off by more than one good one in 10^4 would be."""
    sets = problem.sets
    return [
        np.flatnonzero(s > chi_square(m.width, OUTLIER))
        for s, m in zip(squared(problem, noise, p), sets, strict=True)
    ]  # fmt: skip


def _covariance(
    problem: Problem, free: Array, outcome: Outcome, noise: Noise, name: str, prior: Array | None
) -> Array:
    """Covariance of p: (J^T J)^-1 over the whitened slopes; with a robust loss times mean(psi^2) /
    mean(psi')^2.

    Source: Huber, Robust Statistics, 1981, section 7.6.
    """
    B = problem.scale[:, None] * free
    A = outcome.slopes
    if prior is not None:
        A = np.concatenate([A, (1.0 / prior)[:, None] * B])
    R = triangle(A)
    half = B @ (
        np.linalg.inv(R) if regular(R) else np.linalg.lstsq(R, np.eye(len(R)), rcond=None)[0]
    )
    covariance = half @ half.T  # a product with its own transpose is symmetric to the last bit
    if name == "linear":
        return covariance
    spent, bends, total = 0.0, 0.0, 0
    for s, m in zip(squared(problem, noise, outcome.p), problem.sets, strict=True):
        rho = loss(name, s, m.width)
        spent += float(np.sum(rho.weight**2 * s))
        bends += float(np.sum(m.width * rho.weight + 2.0 * rho.bend * s))
        total += m.width * len(m)
    # residuals after a fit are smaller than the noise, by what the parameters took up
    spent /= max(total - free.shape[1], 1)
    return covariance * spent / max(bends / total, 1e-3) ** 2
