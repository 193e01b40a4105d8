"""One fit: unknown frames first, then all that is free; noise that is not given is estimated
jointly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..model.problem import Problem
from .losses import LossName
from .minimise import FitOptions, Step, minimise
from .noise import EVEN, Noise, estimate_noise

_ROUNDS = 10
# how even the noise of angles and lengths is taken to be before anything was fitted
_FIRST_EVEN = 1e-2
_SAME = 1e-2  # noise that changes by less is settled: it is known to some per cent only


class Fit(NamedTuple):
    """Parameters p, in their units; whether it converged; the steps; the noise; the directions
    (P, k) that were free, in rad and reaches; the whitened Jacobian (M, k) in these and its
    triangle, as of `Minimum`.
    """

    p: Array
    converged: bool
    steps: list[Step]
    noise: Noise
    free: Array
    jacobian: Array
    triangle: Array | None = None


def fit_frames(problem: Problem, name: LossName) -> Array:
    """The p with which the nominal arm fits best: only the unknown frames move."""
    p = np.zeros(problem.size)
    if problem.size == problem.model_size:
        return p
    free = np.eye(problem.size)[:, problem.model_size :]
    return fit_parameters(problem, free, p, FitOptions(name)).p


def fit_parameters(problem: Problem, free: Array, p: Array, options: FitOptions) -> Fit:
    """The fit from p on, of so many steps at most. A robust loss begins as Huber's, which has one
    minimum near p.
    """
    name = options.loss
    most = options.max_iterations
    noise = _noise(problem, p, 0, name, _FIRST_EVEN)
    steps: list[Step] = []
    losses: list[LossName] = [name]
    if name not in ("linear", "huber"):
        losses = ["huber", name]
    for _ in range(_ROUNDS):
        for one in losses:
            round_options = FitOptions(one, options.prior, most - len(steps))
            outcome = minimise(problem, free, noise, p, round_options)
            p = outcome.p
            steps += outcome.steps
        losses = [name]
        if not any(noise.noise_std):
            break
        before = noise
        noise = _noise(problem, p, free.shape[1], name)
        if _change(before, noise) < _SAME:
            break
        if len(steps) >= most:
            outcome = outcome._replace(converged=False)
            break
    return Fit(p, outcome.converged, steps, noise, free, outcome.jacobian, outcome.triangle)


def _noise(
    problem: Problem,
    p: Array,
    free: int,
    name: LossName,
    even: float = EVEN,
) -> Noise:
    """Noise by the errors at p, to which `free` parameters were fitted."""
    reach = problem.model.nominal.reach
    errors = problem.errors(p)
    estimates = estimate_noise(
        problem.sets,
        errors,
        free,
        name != "linear",
        reach,
        even,
    )
    return Noise(problem.sets, estimates)


def _change(a: Noise, b: Noise) -> float:
    """Largest relative change of a standard deviation."""
    changes = [0.0]
    for before, after in zip(a.noise_std, b.noise_std, strict=True):
        if before and after:
            pairs = zip(before, after, strict=True)
            changes += [abs(y / x - 1.0) for x, y in pairs if x and y]
    return max(changes)
