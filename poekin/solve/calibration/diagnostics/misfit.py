"""Measurements that no arm near the nominal one explains, as those of other readings, of another
arm or frame; and covariances that what is left contradicts.
"""

from __future__ import annotations

import numpy as np

from ....errors import InputError
from ..fit.fitting import Fit, squared
from ..fit.losses import OUTLIER, chi_square
from ..model.problem import Problem
from ..model.residuals import residuals
from .explanation import explained, far, hint, median

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
    found, reach = (
        residuals(problem.sets, problem.rows, problem.errors(fit.p)),
        problem.arm.nominal.reach,
    )
    for k, (s, squares) in enumerate(
        zip(problem.sets, squared(problem, fit.noise, fit.p), strict=True)
    ):
        off = median(found, k, s)
        noise = s.covariance is not None and np.median(squares) <= chi_square(s.width, OUTLIER)
        if noise or not far(off, reach):
            continue
        which = f"measurement set {k} ({s.what})" if len(problem.sets) > 1 else f"these {s.what}"
        other = explained(problem, k)
        near = "" if other is None or far(other.left, reach) else (
            f" With {other}, the nominal arm is off by {other.left} only: {hint(s, other, reach)}."
        )  # fmt: skip
        raise InputError(
            f"no arm near the nominal one explains {which}: the best that was found is off by {off} in the median; is "
            "it this arm, does each row of q belong to its measurement, are the joints in order and their signs right, "
            f"and is each measured in the frame and of the point that it is said to be?{near}"
        )


def contradicted(problem: Problem, fit: Fit) -> list[tuple[float, str]]:
    """How many times as large as each covariance says the residuals of a fit that converged are, by
    their median, and that in words; of covariances that they contradict.
    """
    spare = (problem.numbers - fit.free.shape[1]) * fit.converged
    said = []
    for k, (s, squares) in enumerate(
        zip(problem.sets, squared(problem, fit.noise, fit.p), strict=True)
    ):
        if s.covariance is None or min(spare, squares.size * s.width) < ENOUGH:
            continue
        times = float(
            np.sqrt(np.median(squares) / chi_square(s.width, 0.0) * problem.numbers / spare)
        )
        if 1.0 / TIMES <= times <= TIMES:
            continue
        which = f"measurement set {k} ({s.what})" if len(problem.sets) > 1 else f"the {s.what}"
        said.append((
            times,
            f"{which}: the residuals are {times:.2g} times as large as covariance= says, and the deviations of the "
            "parameters are wrong by as much; without it they are estimated from the residuals",
        ))  # fmt: skip
    return said
