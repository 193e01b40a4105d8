"""Data kept aside: each part of the readings is judged by a calibration from the others."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ....errors import InputError, safe_repr
from ....groups.arrays import Array
from ..fit.fitting import frames_only
from ..fit.refit import settled
from ..measurements.measurement import Indices
from ..model.problem import Problem
from ..model.residuals import Residuals, joined, residuals

Progress = Callable[[int, int], None]


class HeldOut(NamedTuple):
    """Residuals on data kept aside, pooled over the folds: before, with unknown frames fitted only,
    and after.
    """

    before: Residuals
    after: Residuals
    folds: int


def held_out(
    problem: Problem, free: Array, name: str, prior: Array | None, folds: int, seed: int, most: int,
    progress: Progress | None,
) -> HeldOut:  # fmt: skip
    """The readings in `folds` parts drawn at random; unknown frames are those of the other parts,
    too.
    """
    order = np.random.default_rng(seed).permutation(len(problem.q))
    before, after = [], []
    for k, chosen in enumerate(np.array_split(order, folds)):
        if progress is not None:
            progress(k, folds)
        chosen = np.sort(chosen)
        training = problem.part(np.setdiff1d(order, chosen))
        test = problem.part(chosen)
        p, _ = frames_only(training, name)
        before.append(_judged(test, p, chosen))
        after.append(_judged(test, settled(training, free, name, p, prior, most).p, chosen))
    if progress is not None:
        progress(folds, folds)
    return HeldOut(joined(before), joined(after), folds)


def _judged(test: Problem, p: Array, chosen: Indices) -> Residuals:
    return residuals(test.sets, [chosen[rows] for rows in test.rows], test.errors(p))


def checked(folds: object, count: int, seed: object) -> int:
    """How many folds, 0 for none; a seed that draws them. Raises: InputError."""
    if not isinstance(seed, (int, np.integer)) or isinstance(seed, bool) or seed < 0:
        raise InputError(f"seed: expected a whole number from 0 on, got {safe_repr(seed)}")
    if (
        not isinstance(folds, (int, np.integer))
        or isinstance(folds, bool)
        or folds < 0
        or folds == 1
    ):
        raise InputError(f"folds: expected 0 for none, or 2 and more, got {safe_repr(folds)}")
    if folds > count:
        raise InputError(f"folds: {folds} parts of {count} readings; folds=0 keeps none aside")
    return int(folds)
