"""Measurements that no arm near the nominal one explains: they belong to other readings, another arm or frame."""

from __future__ import annotations

import numpy as np

from ...errors import InputError
from .first_guess import MISFIT
from .fitting import Fit, squared
from .losses import OUTLIER, chi_square
from .problem import Problem
from .residuals import residuals
from .units import LARGE


def check(problem: Problem, fit: Fit) -> None:
    """Refuse a set that the calibrated arm misses by more than any arm is off, and by more than was said to be noise.

    Raises: InputError that names the set, by how much it is missed, and what may be wrong.
    """
    found, most = residuals(problem.sets, problem.rows, problem.errors(fit.p)), LARGE * problem.arm.nominal.reach
    for k, (s, squares) in enumerate(zip(problem.sets, squared(problem, fit.noise, fit.p), strict=True)):
        length = float(np.median(found.length[found.set == k]))
        angle = float(np.median(found.angle[found.set == k])) if s.angular else 0.0
        noise = s.covariance is not None and np.median(squares) <= chi_square(s.width, OUTLIER)
        if noise or (length <= most and angle <= MISFIT):
            continue
        which = f"measurement set {k} ({s.what})" if len(problem.sets) > 1 else f"these {s.what}"
        off = f"{length:.3g} m and {angle:.3g} rad" if s.angular else f"{length:.3g} m"
        raise InputError(
            f"no arm near the nominal one explains {which}: the best that was found is off by {off} in the median; is "
            "it this arm, does each row of q belong to its measurement, are the joints in order and their signs right, "
            "and is each measured in the frame and of the point that it is said to be?"
        )
