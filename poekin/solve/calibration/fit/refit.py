"""A fit, and another one where the arm that it found shows more than the nominal one did.

A nominal arm is often special, as with a measured point on its last axis: what tilts that axis
about the point moves nothing in first order, and is held. The true arm is not special, and to
second order, some micrometres where it is off by millimetres, it shows these directions.
"""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ..diagnostics.identification import movable_at, seen_at
from ..model.problem import Problem
from .fitting import Fit, fitted, squared
from .losses import OUTLIER, chi_square, loss
from .minimise import minimise

_TRIED = 3  # steps: from so near they gain nearly all that there is to gain


def settled(
    problem: Problem, free: Array, name: str, p: Array, prior: Array | None, most: int
) -> Fit:
    """`fitted`, and what is seen only where it ended fitted too, if the data fit better by more
    than chance explains.

    Directions that noise hides stay held: of the first fit's noise, the sum of rho has to fall by
    more than it would, once in 10^4 times, for as many directions without any meaning. `Fit.free`
    says what was free in the end.
    Source of the test: Wilks 1938, the likelihood ratio of nested models is distributed as
    chi-square.
    """
    first = fitted(problem, free, name, p, prior, most)
    if (
        not first.converged
        or free.shape[1] == problem.size
        or seen_at(problem, first.p) <= free.shape[1]
    ):
        return first
    more = movable_at(problem, first.p, None if prior is None else np.isfinite(prior))
    if not free.shape[1] < more.shape[1] < problem.numbers:
        return first
    tried = minimise(
        problem, more, first.noise, name, first.p, prior, min(_TRIED, most - len(first.steps))
    )
    gain = _misfit(problem, name, first, first.p) - _misfit(problem, name, first, tried.p)
    if gain <= chi_square(more.shape[1] - free.shape[1], OUTLIER):
        return first
    steps = first.steps + tried.steps
    second = fitted(problem, more, name, tried.p, prior, most - len(steps))
    return second._replace(steps=steps + second.steps) if second.converged else first


def _misfit(problem: Problem, name: str, fit: Fit, p: Array) -> float:
    """The sum of rho at p, with the noise of that fit."""
    rho = zip(problem.sets, squared(problem, fit.noise, p), strict=True)
    return float(sum(np.sum(loss(name, s, m.width).rho) for m, s in rho))
