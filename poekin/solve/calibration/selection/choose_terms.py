"""Choice of terms: forward, by the error on held-out readings and the one-standard-error rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..fit.fitting import Fit
from ..fit.losses import LossName
from ..model.configurations import Folds
from ..model.error_model import ErrorModel
from ..model.problem import Problem
from ..terms.conditions import Conditions
from ..terms.named import BUILDERS
from ..terms.term import Term, name_of
from .held_out import HeldOut, LinearFit
from .term_gain import TermGain

CANDIDATES = ("compliance", "gains", *(name for name in BUILDERS if name != "compliance"))
"""Terms that `parameters="auto"` tries."""


_GEOMETRY = ""


class Candidates(NamedTuple):
    """Linearisation with all terms, and their names."""

    fit: LinearFit
    names: tuple[str, ...]

    def columns(self, names: Sequence[str]) -> Array:
        """Orthonormal columns of the geometry and of these terms."""
        found = self.fit.with_group(self.fit.nothing, _GEOMETRY)
        for name in names:
            found = self.fit.with_group(found, name)
        return found

    def held_out(self, names: Sequence[str]) -> HeldOut | None:
        """Errors on held-out readings with these terms."""
        return self.fit.held_out(self.columns(names))


def candidates(
    problem: Problem,
    fit: Fit,
    kinds: Sequence[str | Term],
    conditions: Conditions,
    loss: LossName,
    folds: Folds,
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
    geometry = np.zeros((wide.size, fit.free.shape[1]))
    geometry[old] = fit.free
    directions = {_GEOMETRY: geometry}
    for kind in kinds:
        mine = [place[parameter] for parameter in model.parameters_of(kind)]
        geometry[mine] = 0.0
        directions[name_of(kind)] = np.eye(wide.size)[:, mine]
    linear = LinearFit(wide, fit._replace(p=p), loss, folds, directions)
    return Candidates(linear, tuple(map(name_of, kinds)))


def choose(found: Candidates) -> list[str]:
    """The terms in the order in which they were added: each time the one of the least error, and of
    all these sets the smallest whose error is within one standard error of the least.

    Source: Breiman, Friedman, Olshen and Stone 1984, section 3.4.3, the one-standard-error rule.
    """
    Q = found.columns([])
    first = found.fit.held_out(Q)
    if first is None:
        return []
    chosen: list[str] = []
    path = [first]
    left = list(found.names)
    while left:
        tried = {}
        for name in left:
            wider = found.fit.with_group(Q, name)
            errors = found.fit.held_out(wider)
            if errors is not None:
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
    for name in found.names:
        others = [other for other in chosen if other != name]
        before = found.held_out(others)
        Q = found.columns(others)
        count = found.fit.with_group(Q, name).shape[1] - Q.shape[1]
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
    count = len(pairs)
    error = float(np.std(pairs, ddof=1) / np.sqrt(count))
    least = np.finfo(float).tiny
    gain = before.rms_length - after.rms_length
    return gain, error / max(total, least)
