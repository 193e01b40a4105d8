"""Cross-validation: each fold of the readings is predicted by a calibration from the others."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....checks import is_whole, whole
from ....errors import InputError, safe_repr
from ....groups.arrays import Array
from ....results import Progress, Result
from ..fit.fitting import fit_frames
from ..fit.minimise import FitOptions
from ..fit.refit import fit_with_refit
from ..measurements.measurement import Rows
from ..model.configurations import Folds, configurations
from ..model.problem import Problem
from ..model.residuals import Residuals, concatenate


@dataclass(frozen=True, eq=False)
class CrossValidation(Result):
    """Residuals on held-out data, pooled over the folds.

    Parameters
    ----------
    before : Residuals
        Of the nominal arm, with unknown frames fitted to the other folds.
    after : Residuals
        Of the arm calibrated from the other folds.
    folds : int
        Number of folds.
    """

    before: Residuals
    after: Residuals
    folds: int

    def summary(self) -> str:
        """Residuals of the nominal and the calibrated arm as text, in mm and mrad."""
        return f"{self.folds} folds\nbefore: {self.before}\nafter: {self.after}"


def cross_validate(
    problem: Problem,
    free: Array,
    options: FitOptions,
    folds: int,
    seed: int,
    progress: Progress | None,
) -> CrossValidation:
    """The readings in folds drawn at random, equal and nearly equal ones in the same; unknown frames
    are those of the other folds, too.
    """
    fold = Folds(folds, seed).of(configurations(problem.q))
    before = []
    after = []
    for k in range(folds):
        if progress is not None:
            progress(k, folds)
        held_out = fold == k
        chosen = np.flatnonzero(held_out)
        training = problem.part(np.flatnonzero(~held_out))
        test = problem.part(chosen)
        p = fit_frames(training, options.loss)
        fit = fit_with_refit(training, free, p, options)
        before.append(_held_out_residuals(test, p, chosen))
        after.append(_held_out_residuals(test, fit.p, chosen))
    if progress is not None:
        progress(folds, folds)
    return CrossValidation(concatenate(before), concatenate(after), folds)


def _held_out_residuals(test: Problem, p: Array, chosen: Rows) -> Residuals:
    found = test.residuals(p)
    return replace(found, row=chosen[found.row])


def check_folds(folds: Any, count: int, seed: Any) -> int:
    """Number of folds of `count` readings, 0 for none. Raises: InputError, of the seed too."""
    whole(seed, "seed", 0)
    if not is_whole(folds, 0) or folds == 1:
        raise InputError(f"folds: expected 0 for none, or 2 and more, got {safe_repr(folds)}")
    if folds > count:
        raise InputError(f"folds: {folds} parts of {count} readings; folds=0 holds none out")
    return int(folds)
