"""Measurements that no arm near the nominal one explains, as those of other readings, of another
arm or frame; and covariances that what is left contradicts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ..causes.most_likely import most_likely
from ..fit.fitting import Fit
from ..fit.losses import OUTLIER, chi_square
from ..model.problem import Problem
from .explanation import far, median, set_name

TIMES = 3.0
"""Standard deviations that are given are contradicted by residuals this many times as large, or as
small.
"""

ENOUGH = 30
"""Numbers, beyond the parameters, from which that is told: of 30 right ones it is said with a
chance of 3e-5.
"""


def check(problem: Problem, fit: Fit) -> None:
    """Refuse a set that the calibrated arm misses by more than any arm is off, and by more than was
    said to be noise.

    Raises: InputError that names the set, by how much it is missed, and what may be wrong.
    """
    found = problem.residuals(fit.p)
    reach = problem.model.nominal.reach
    squares = fit.noise.squares(problem.errors(fit.p))
    for k, s in enumerate(problem.sets):
        off = median(found, k)
        known = s.covariance is not None
        noise = known and np.median(squares[k]) <= chi_square(s.width, OUTLIER)
        if noise or not far(off, reach):
            continue
        which = set_name(problem.sets, k, "these")
        cause = most_likely(problem.model, problem.q, problem.sets)
        why = (
            "is it this arm, does each row of q belong to its measurement, are the joints in order "
            "and their signs right, and is each measured in the frame and of the point that it is "
            "said to be?"
        )
        if cause is not None:
            why = f"most likely: {cause}"
        raise InputError(
            f"no arm near the nominal one explains {which}: the best that was found is off by {off}"
            f" in the median; {why}"
        )


class Contradiction(NamedTuple):
    """Ratio of the residuals to what a covariance says, by their median, and that in words."""

    ratio: float
    words: str


def contradicted(problem: Problem, fit: Fit) -> list[Contradiction]:
    """Covariances that the residuals of a fit that converged contradict."""
    spare = (problem.n_equations - fit.free.shape[1]) * fit.converged
    found = []
    for k, squares in enumerate(fit.noise.squares(problem.errors(fit.p))):
        s = problem.sets[k]
        if s.covariance is None or min(spare, squares.size * s.width) < ENOUGH:
            continue
        usual = chi_square(s.width, 0.0)
        ratio = float(np.sqrt(np.median(squares) / usual * problem.n_equations / spare))
        if 1.0 / TIMES <= ratio <= TIMES:
            continue
        which = set_name(problem.sets, k, "the")
        words = (
            f"{which}: the residuals are {ratio:.2g} times as large as covariance= says, and the "
            "deviations of the parameters are wrong by as much; without it they are estimated from "
            "the residuals"
        )
        found.append(Contradiction(ratio, words))
    return found
