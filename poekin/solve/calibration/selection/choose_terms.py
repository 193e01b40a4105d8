"""Choice of terms: forward, by the error on held-out readings and the one-standard-error rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..fit.fitting import Fit
from ..fit.losses import LossName
from ..model.error_model import ErrorModel
from ..model.problem import Problem
from ..terms.conditions import Conditions
from ..terms.named import BUILDERS
from ..terms.term import Term, name_of
from .held_out import HeldOut, LinearFit, joined
from .term_gain import TermGain

CANDIDATES = ("compliance", "gains", *(name for name in BUILDERS if name != "compliance"))
"""Terms that `parameters="auto"` tries."""


class Candidates(NamedTuple):
    """Linearisation with all terms, and the basis of each of them in it, that of the rest first."""

    fit: LinearFit
    rest: Array
    directions: dict[str, Array]

    def basis(self, names: Sequence[str]) -> Array:
        """Orthonormal basis (M, k) of the rest and of these terms."""
        found = self.rest
        for name in names:
            found = self.added(found, name)
        return found

    def added(self, Q: Array, name: str) -> Array:
        """Basis Q and that of one more term."""
        return joined([Q, self.fit.basis(self.directions[name], Q)], len(Q))

    def held_out(self, names: Sequence[str]) -> HeldOut | None:
        """Errors on held-out readings with these terms."""
        return self.fit.held_out(self.basis(names))


def candidates(
    problem: Problem,
    fit: Fit,
    kinds: Sequence[str | Term],
    conditions: Conditions,
    loss: LossName,
    folds: int,
    seed: int,
) -> Candidates:
    """The linearisation at a fit, with these kinds of terms beside what was fitted."""
    own = problem.model
    every = [*own.kinds, *(kind for kind in kinds if kind not in own.kinds)]
    model = ErrorModel(own.nominal, every, own.moving, own.reference)
    wide = Problem(model, problem.q, problem.sets, problem.initial_frames).under(conditions)
    place = {parameter: k for k, parameter in enumerate(wide.parameters)}
    old = [place[parameter] for parameter in problem.parameters]
    p = np.zeros(wide.size)
    p[old] = fit.p
    free = np.zeros((wide.size, fit.free.shape[1]))
    free[old] = fit.free
    directions = {}
    of_terms = np.zeros(wide.size, bool)
    for kind in kinds:
        mine = [place[parameter] for parameter in model.parameters_of(kind)]
        of_terms[mine] = True
        directions[name_of(kind)] = np.eye(wide.size)[:, mine]
    linear = LinearFit(wide, p, fit.noise, loss, folds, seed)
    rest = linear.basis(free * ~of_terms[:, None], np.empty((len(linear.b), 0)))
    return Candidates(linear, rest, directions)


def choose(found: Candidates) -> list[str]:
    """The terms in the order in which they were added: each time the one of the least error, and of
    all these sets the smallest whose error is within one standard error of the least.

    Source: Breiman, Friedman, Olshen and Stone 1984, section 3.4.3, the one-standard-error rule.
    """
    first = found.fit.held_out(found.rest)
    if first is None:
        return []
    chosen: list[str] = []
    path = [first]
    Q = found.rest
    left = list(found.directions)
    while left:
        tried = {}
        for name in left:
            wider = found.added(Q, name)
            errors = found.fit.held_out(wider)
            if errors is not None and wider.shape[1] > Q.shape[1]:
                tried[name] = (errors, wider)
        if not tried:
            break
        best = min(tried, key=lambda name: tried[name][0].score)
        errors, wider = tried[best]
        if errors.score >= path[-1].score:
            break
        chosen.append(best)
        path.append(errors)
        left.remove(best)
        Q = wider
    least = path[-1]
    most = least.score + least.deviation
    enough = next(k for k, errors in enumerate(path) if errors.score <= most)
    return chosen[:enough]


def gains(found: Candidates, chosen: Sequence[str]) -> tuple[TermGain, ...]:
    """The gain of each term, beside those that are chosen."""
    base = found.held_out(chosen)
    rows = []
    for name in found.directions:
        others = [other for other in chosen if other != name]
        before = found.held_out(others)
        Q = found.basis(others)
        count = found.added(Q, name).shape[1] - Q.shape[1]
        after = base
        if name not in chosen:
            after = found.held_out([*others, name])
        gain, deviation = _gain(before, after)
        rows.append(TermGain(name, name in chosen, count, gain, deviation))
    return tuple(rows)


def _gain(before: HeldOut | None, after: HeldOut | None) -> tuple[float, float]:
    """Difference of the root mean squares, m, and its standard deviation, by the squares' pairs."""
    if before is None or after is None:
        return math.nan, math.nan
    pairs = before.lengths - after.lengths
    total = before.rms_length + after.rms_length
    error = float(np.std(pairs, ddof=1) / np.sqrt(len(pairs)))
    return before.rms_length - after.rms_length, error / max(total, np.finfo(float).tiny)
