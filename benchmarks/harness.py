"""How time is measured: two cases in turn, A B A B …, in one run, so that a slow moment of the
machine hits both.

Time is the processor's (`time.process_time`): while another process has the processor, it stands
still. It adds up all threads of this process, so that no case gains by threads that the other one
does not start.

Where threads are meant, the clock is the wall's (`clock=time.perf_counter`), and the machine has to
be idle otherwise.

A case is a triple (setup, run, error): every row of speed has its error beside it, from the results
of the same run.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

Clock = Callable[[], float]


@dataclass(frozen=True)
class Case:
    """One thing to be timed.

    name; setup() -> state, outside the clock; run(state) -> result, inside it; error(state, result)
    -> the numerical error of that result, by whatever reference the case states.
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
class Timed:
    """One case measured: seconds a run, each of them in order, and the error of its result."""

    name: str
    time: Spread
    each: tuple[float, ...]
    error: float


@dataclass(frozen=True)
class Comparison:
    """Two cases measured in turn: processor seconds a run, ratio first ÷ second of each pair, the
    errors of both.
    """

    first: Spread
    second: Spread
    ratio: Spread
    first_error: float
    second_error: float


def spread(values: list[float]) -> Spread:
    """Median and quartiles; of a single value, three times itself."""
    lower, _, upper = (
        statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3
    )
    return Spread(statistics.median(values), lower, upper)


def compare(
    first: Case,
    second: Case,
    *,
    pairs: int = 31,
    slice_s: float = 0.02,
    clock: Clock = time.process_time,
) -> Comparison:
    """Time two cases in turn and take the ratio within each pair; the order within a pair
    alternates.

    Parameters: pairs, how often; slice_s, seconds by the wall clock that one measurement of a case
    lasts at least
    (fast runs repeat); clock, the processor's or the wall's.
    """
    a, b = in_turn([first, second], rounds=pairs, slice_s=slice_s, clock=clock)
    return Comparison(a.time, b.time, ratio(a, b), a.error, b.error)


def in_turn(
    cases: Sequence[Case],
    *,
    rounds: int = 31,
    slice_s: float = 0.02,
    clock: Clock = time.process_time,
    rest_s: float = 0.0,
) -> list[Timed]:
    """Time any number of cases in turn, there and back: A B C C B A A B C …; parameters as
    `compare`.

    rest_s: seconds to wait before each slice. Threads of a library that the last case has started
    use the processor for some hundredths of a second more, waiting for work, and that would be the
    next one's time.
    """
    states = [case.setup() for case in cases]
    errors = [
        case.error(state, case.run(state)) for case, state in zip(cases, states, strict=True)
    ]  # warms up, too
    loops = [_loops(case.run, state, slice_s) for case, state in zip(cases, states, strict=True)]
    times: list[list[float]] = [[] for _ in cases]
    for number in range(rounds):
        for which in range(len(cases)) if number % 2 == 0 else reversed(range(len(cases))):
            time.sleep(rest_s)
            times[which].append(_clock(cases[which].run, states[which], loops[which], clock))
    return [
        Timed(case.name, spread(each), tuple(each), error)
        for case, each, error in zip(cases, times, errors, strict=True)
    ]


def ratio(first: Timed, second: Timed) -> Spread:
    """Of two cases that were measured in turn: the ratio of each pair, first ÷ second."""
    return spread([a / b for a, b in zip(first.each, second.each, strict=True)])


def _clock(
    run: Callable[[Any], Any], state: Any, loops: int, clock: Clock = time.process_time
) -> float:
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
