"""Causes of measurements that do not fit: each is tried on the data, and the best is named with the
error that it would leave.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ..diagnostics import units
from ..diagnostics.explanation import Size, explained, far, hint, median, set_name
from ..measurements.measurement import Measurement
from ..model.error_model import ErrorModel
from ..model.problem import Problem
from ..model.residuals import Residuals
from . import other_data, readings
from .other_data import Other

_FAR = 0.01  # rad and reaches, together: a nominal arm that is off by less may just be so
_BETTER = 3.0  # how many times better a cause has to explain the data
_FREE = 1.5  # how many times better than other causes one with frames that were fitted has to
_MOST_ROWS = 12
_ROUNDING = 1e-12


class Cause(NamedTuple):
    """A cause in words, and the median errors with it and as the data stand; None without frames."""

    words: str
    left: Size
    before: Size | None

    def __str__(self) -> str:
        stands = ""
        if self.before is not None:
            stands = f", as the data stand by {self.before}"
        return f"{self.words}; with that the nominal arm is off by {self.left} (median){stands}"


class _Miss(NamedTuple):
    """Errors of the nominal arm: their size, where a few rows count too, and their medians."""

    size: float
    median: Size


def most_likely(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> Cause | None:
    """The cause that explains the data best, None where none explains them much better.

    A cause whose base or tool was fitted has to be better than one that fits nothing.
    """
    stand = _miss(model, q, sets)
    if stand is not None and stand.size < _FAR:
        return None
    least = np.inf if stand is None else stand.size
    found: Cause | None = None
    least /= _BETTER
    for other in _others(model, q, sets):
        miss = _miss(model, other.q, other.sets)
        if miss is None or far(miss.median, model.nominal.reach):
            continue
        size = miss.size * other.handicap
        if size < least:
            least = size
            found = Cause(other.words, miss.median, stand and stand.median)
    if found is not None or stand is None:
        return found
    return _of_base_and_tool(Problem(model, q, sets))


def _others(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> Iterator[Other]:
    """The data taken otherwise."""
    arm = model.nominal
    for read in (*readings.other_readings(arm, q), *readings.other_zeros(arm, q)):
        yield Other(read.words, read.q, sets)
    for unit in units.TRIES:
        scaled = [s.scaled(unit.length) for s in sets]
        # whatever the model, lengths made a thousandth are off by a thousandth
        yield Other(unit.words, units.converted(arm, q, unit), scaled, 1.0 / unit.length)
    yield from other_data.other_rows(q, sets)
    yield from _exchanged(model, q, sets)
    T = arm.fk(q)
    for k, s in enumerate(sets):
        for words, other in other_data.other_numbers(s):
            yield Other(words, q, _with(sets, k, other))
        for words, other in other_data.other_frames(s, T):
            yield Other(words, q, _with(sets, k, other), _FREE)


def _with(sets: Sequence[Measurement], k: int, other: Measurement) -> list[Measurement]:
    return [*sets[:k], other, *sets[k + 1 :]]


def _miss(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> _Miss | None:
    """Errors of the nominal arm with initial guesses of unknown frames; None where there are none."""
    try:
        problem = Problem(model, q, sets)
    except InputError:
        return None
    found = _nominal_residuals(problem)
    sizes = _sizes(problem)
    typical = Size(found.median_length, found.median_angle)
    return _Miss(float(np.mean(sizes)), typical)


def _sizes(problem: Problem) -> Array:
    """Errors of the nominal arm in rad and reaches, together."""
    found = _nominal_residuals(problem)
    reach = problem.model.nominal.reach
    return found.length / reach + np.nan_to_num(found.angle)


def _nominal_residuals(problem: Problem) -> Residuals:
    return problem.residuals(np.zeros(problem.size))


def _exchanged(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> Iterator[Other]:
    """A few rows exchanged: of those that stand out, each goes where it fits best."""
    try:
        problem = Problem(model, q, sets)
    except InputError:
        return
    sizes = _sizes(problem)
    if len(sets) > 1 or len(sizes) < 3:
        return
    odd = np.flatnonzero(sizes > _BETTER * np.median(sizes))
    odd = odd[np.argsort(-sizes[odd])][:_MOST_ROWS]
    taken = problem.rows[0]
    rows = taken.copy()
    named = []
    for a in odd:
        here = np.full(len(odd), a)
        one = Problem(
            model,
            q,
            [sets[0].subset(here).with_rows(taken[odd])],
            problem.initial_frames,
        )
        fits = _sizes(one)
        b = odd[np.argmin(fits)]
        if a != b:
            rows[a] = taken[b]
            named.append(int(taken[a]))
    if len(np.unique(rows)) == len(np.unique(taken)) and named:
        words = f"the measurements of rows {', '.join(map(str, sorted(named)))} exchanged"
        yield Other(words, q, [sets[0].with_rows(rows)])


def _of_base_and_tool(problem: Problem) -> Cause | None:
    """Another base and tool of a set, where they explain it, and most of what is wrong."""
    reach = problem.model.nominal.reach
    stand = _nominal_residuals(problem)
    found: Cause | None = None
    least = 1.0 / (_BETTER * _FREE)
    for k, s in enumerate(problem.sets):
        other = explained(problem, k)
        if other is None or far(other.left, reach):
            continue
        before = median(stand, k)
        ratio = _together(other.left, reach) / _together(before, reach)
        if ratio < least:
            least = ratio
            which = set_name(problem.sets, k, "the")
            words = f"{which}: {other} ({hint(s, other, reach)})"
            found = Cause(words, other.left, before)
    return found


def _together(size: Size, reach: float) -> float:
    """An error in rad and reaches, together."""
    together = size.length / reach + float(np.nan_to_num(size.angle))
    return max(together, _ROUNDING)


def build_problem(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> Problem:
    """The problem with initial guesses of its unknown frames.

    Raises: InputError where there is no guess; with the cause with which there is one, if any.
    """
    try:
        return Problem(model, q, sets)
    except InputError as fault:
        cause = most_likely(model, q, sets)
        if cause is None:
            raise
        raise InputError(f"most likely: {cause}; as the data stand, {fault}") from fault
