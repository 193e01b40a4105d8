"""Fitted problem: what a calibration problem identifies, and the fit of that."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, get_args

import numpy as np

from ...checks import choice, positive
from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from .diagnostics import misfit, units
from .diagnostics.identification import (
    Identification,
    OnRankDeficiency,
    check_rank,
    identify_directions,
)
from .fit import noise
from .fit.fitting import Fit, fit_frames
from .fit.losses import LossName
from .fit.minimise import FitOptions
from .fit.refit import fit_with_refit
from .model.parameters import Unit
from .model.problem import MeasuredPoints, Problem
from .model.residuals import Residuals


class FittedProblem(NamedTuple):
    """A fit, its options, what was free before it, and the errors and points that it began with."""

    identification: Identification
    free: Array
    options: FitOptions
    before: Residuals
    points: MeasuredPoints
    fit: Fit


def fit_problem(
    problem: Problem,
    loss: LossName,
    prior: Mapping[Unit, float] | None,
    iterations: int,
    on_rank_deficiency: OnRankDeficiency,
) -> FittedProblem:
    """The fit of a problem that was found sound."""
    sigma = _prior(prior, problem)
    identification, free = identify_directions(problem)
    with_prior = identification
    if sigma is not None:
        with_prior, free = identify_directions(problem, np.isfinite(sigma))
    check_rank(with_prior, on_rank_deficiency)
    noise.check(problem.sets, problem.n_equations, free.shape[1])
    start = fit_frames(problem, loss)
    units.check(problem, start)
    # now, while the problem has these errors
    before = problem.residuals(start)
    points = problem.points(start)
    options = FitOptions(loss, sigma, iterations)
    fit = fit_with_refit(problem, free, start, options)
    if fit.free is not free:
        identification, _ = identify_directions(problem, p=fit.p)
    misfit.check(problem, fit)
    return FittedProblem(identification, free, options, before, points, fit)


def _prior(prior: Mapping[Unit, float] | None, problem: Problem) -> Array | None:
    """Standard deviations (P,), infinite for unknown frames and units that are not named."""
    if prior is None:
        return None
    if not isinstance(prior, Mapping) or not prior:
        raise InputError(
            "prior: expected standard deviations by unit, such as {'rad': 1e-3}, got "
            f"{safe_repr(prior)}"
        )
    for unit, sigma in prior.items():
        choice(unit, get_args(Unit), "prior")
        positive(sigma, f"prior[{unit!r}]")
    sigmas = np.full(problem.size, np.inf)
    own = problem.model.parameters
    sigmas[: len(own)] = [prior.get(p.unit, np.inf) for p in own]
    return sigmas
