"""How time is measured: two cases in turn, A B A B …, in one run, so that a slow moment of the machine hits both.

Time is the processor's (`time.process_time`): while another process has the processor, it stands still. It adds up all
threads of this process, so that no case gains by threads that the other one does not start.

A case is a triple (setup, run, error): every row of speed has its error beside it, from the results of the same run.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Case:
    """One thing to be timed.

    name; setup() -> state, outside the clock; run(state) -> result, inside it; error(state, result) -> the numerical
    error of that result, by whatever reference the case states.
    """

    name: str
    setup: Callable[[], Any]
    run: Callable[[Any], Any]
    error: Callable[[Any, Any], float]


@dataclass(frozen=True)
class Spread:
    """Median and quartiles of repeated measurements."""

    median: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Comparison:
    """Two cases measured in turn: processor seconds a run, ratio first ÷ second of each pair, the errors of both."""

    first: Spread
    second: Spread
    ratio: Spread
    first_error: float
    second_error: float


def spread(values: list[float]) -> Spread:
    """Median and quartiles; of a single value, three times itself."""
    lower, _, upper = statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3
    return Spread(statistics.median(values), lower, upper)


def compare(first: Case, second: Case, *, pairs: int = 31, slice_s: float = 0.02) -> Comparison:
    """Time two cases in turn and take the ratio within each pair; the order within a pair alternates.

    Parameters: pairs, how often; slice_s, seconds by the wall clock that one measurement of a case lasts at least
    (fast runs repeat).
    """
    cases = [(case, case.setup()) for case in (first, second)]
    errors = [case.error(state, case.run(state)) for case, state in cases]  # also warms both up
    loops = [_loops(case.run, state, slice_s) for case, state in cases]
    times: list[list[float]] = [[], []]
    for pair in range(pairs):
        for which in (0, 1) if pair % 2 == 0 else (1, 0):
            case, state = cases[which]
            times[which].append(_clock(case.run, state, loops[which]))
    ratios = [a / b for a, b in zip(*times, strict=True)]
    return Comparison(spread(times[0]), spread(times[1]), spread(ratios), errors[0], errors[1])


def _clock(run: Callable[[Any], Any], state: Any, loops: int, clock: Callable[[], float] = time.process_time) -> float:
    """Seconds a run, over so many runs in a row."""
    span = range(loops)
    start = clock()
    for _ in span:
        run(state)
    return (clock() - start) / loops


def _loops(run: Callable[[Any], Any], state: Any, slice_s: float) -> int:
    loops = 1
    # By the wall clock: a run that waits would never use up its slice otherwise.
    while (taken := _clock(run, state, loops, time.perf_counter) * loops) < slice_s:
        loops = max(loops + 1, int(loops * min(10.0, 1.2 * slice_s / max(taken, 1e-9))))
    return loops
