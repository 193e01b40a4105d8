"""A fit, and another one where the arm that it found shows more than the nominal one did.

A nominal arm is often special, as with a measured point on its last axis: what tilts that axis
about the point moves nothing in first order, and is unidentifiable. The true arm is not special, and to
second order, some micrometres where it is off by millimetres, it shows these directions.
"""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ..diagnostics.identification import free_directions_at, rank_at
from ..model.problem import Problem
from .fitting import Fit, fit_parameters
from .losses import OUTLIER, chi_square
from .minimise import FitOptions, minimise, misfit

_TRIED = 3  # steps: from so near they gain nearly all that there is to gain


def fit_with_refit(
    problem: Problem,
    free: Array,
    p: Array,
    options: FitOptions,
) -> Fit:
    """`fit_parameters`, and again with the directions identified only where it ended, if the data
    fit better by more than chance explains.

    Directions that noise hides stay fixed: of the first fit's noise, the sum of rho has to fall by
    more than it would, once in 10^4 times, for as many directions without any meaning. `Fit.free`
    says what was free in the end.
    Source of the test: Wilks 1938, the likelihood ratio of nested models is distributed as
    chi-square.
    """
    first = fit_parameters(problem, free, p, options)
    rank = free.shape[1]
    if not first.converged or rank == problem.size or rank_at(problem, first.p) <= rank:
        return first
    known = None if options.prior is None else np.isfinite(options.prior)
    more = free_directions_at(problem, first.p, known)
    if not rank < more.shape[1] < problem.n_equations:
        return first
    left = options.max_iterations - len(first.steps)
    trial = options._replace(max_iterations=min(_TRIED, left))
    tried = minimise(problem, more, first.noise, first.p, trial)
    was = misfit(problem, first.noise, options.loss, first.p)
    now = misfit(problem, first.noise, options.loss, tried.p)
    gain = was - now
    if gain <= chi_square(more.shape[1] - rank, OUTLIER):
        return first
    steps = first.steps + tried.steps
    rest = options._replace(max_iterations=options.max_iterations - len(steps))
    second = fit_parameters(problem, more, tried.p, rest)
    if not second.converged:
        return first
    return second._replace(steps=steps + second.steps)
