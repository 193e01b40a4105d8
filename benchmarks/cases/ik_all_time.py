"""Time a pose of every solution in a batch, of nominal arms and a calibrated one, beside EAIK's
single calls and its batch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import poekin as pk
from poekin.model.chain import Chain

from ..calibrated_arm import calibrated_ur10e
from ..harness import Case, Timed, in_turn, ratio
from ..report import Figure, Table, Topic, short
from ..workers import processors
from .ik_all_judge import CALIBRATED, Eaik, absent, errors

NOMINAL = {"ur5e": "UR5e", "puma560": "Puma 560", "kr5": "KUKA KR 5", "irb140": "ABB IRB 140"}
SEED, COUNT = 6, 1000
NOMINAL_BAR, CALIBRATED_BAR, RATIO_BAR = 5.0, 15.0, 1.0

OURS = "poekin"
INCLUDES = {
    OURS: "one call with the batch, method auto: targets checked, every solution tried down by fk, doubles taken out, "
    "the order, and whether the solutions are complete",
    "EAIK, one call a pose": "a Python loop over targets in its own frame; its least-squares answers are among its "
    "results, and its arrays are not read",
    "EAIK, batch": "one call with a list of targets in its own frame; its results as before",
}


@dataclass(frozen=True)
class Measured:
    """One arm: each way's time of a batch, and the solutions that each finds; `fastest` of EAIK's
    ways or None, where it does not solve the arm.
    """

    title: str
    ways: Sequence[Timed]
    solutions: Sequence[int]
    count: int

    @property
    def fastest(self) -> Timed | None:
        return min(self.ways[1:], key=lambda way: way.time.median, default=None)

    def microseconds(self, way: Timed) -> tuple[float, float, float]:
        """Median and quartiles of a pose."""
        each = 1e6 / self.count
        return way.time.median * each, way.time.lower * each, way.time.upper * each


def measured(title: str, chain: Chain, count: int, rounds: int) -> Measured:
    """One arm at targets of configurations drawn from one turn of every joint."""
    T = chain.fk(np.random.default_rng(SEED).uniform(-np.pi, np.pi, (count, chain.dof)))
    found: dict[str, int] = {}

    def case(name: str, run: Callable[[], Any], read: Callable[[Any], tuple[Any, Any]]) -> Case:
        def error(_: None, result: Any) -> float:
            q, counts = read(result)
            found[name] = len(q)
            return max(errors(chain, q, counts, T))

        return Case(name, lambda: None, lambda _: run(), error)

    ours = partial(pk.ik_all, chain, T, method="auto", limits=False)
    cases = [case(OURS, ours, lambda result: (result.q, result.counts))]
    eaik = Eaik(chain)
    if eaik.solves:
        targets = eaik.targets(T)
        read = partial(eaik.own, T=T)
        loop, *batches = list(INCLUDES)[1:]
        cases.append(case(loop, partial(eaik.each, targets), read))
        for workers in sorted({1, processors()}):
            name = f"{batches[0]}, {workers} worker{'s' if workers > 1 else ''}"
            cases.append(case(name, partial(eaik.batch, targets, workers), read))
    timed = in_turn(cases, rounds=rounds)
    return Measured(title, timed, [found[way.name] for way in timed], count)


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    title = "Every solution of a pose: time"
    if (without := absent(title, "time of every solution ÷ EAIK's")) is not None:
        return without
    count, rounds = (200, 5) if quick else (COUNT, 15)
    arms = {title: pk.load(name).chain() for name, title in NOMINAL.items()}
    rows = []
    figures = []
    for name, chain in (arms | {CALIBRATED: calibrated_ur10e()}).items():
        one = measured(name, chain, count, rounds)
        rows.append(one)
        figures += (
            [_time(one, NOMINAL_BAR), _ratio(one)] if name in arms else [_time(one, CALIBRATED_BAR)]
        )
        say(name)
    return Topic(
        title,
        "Targets are poses of configurations drawn evenly from one turn of every joint, without limits. Ways run in "
        "turn, time is the processor's over all threads; the table says what each includes, and how near its solutions "
        "are to their targets.",
        figures=figures,
        tables=[_table(rows)],
    )


def _time(one: Measured, bar: float) -> Figure:
    ours = one.ways[0]
    median, lower, upper = one.microseconds(ours)
    return Figure(
        f"{one.title}: every solution of a pose, in a batch of {one.count}", median, bar, "µs",
        spread=(lower, upper), error=_error(ours),
    )  # fmt: skip


def _ratio(one: Measured) -> Figure:
    what = f"{one.title}: time of every solution ÷ EAIK's in its fastest way"
    theirs = one.fastest
    if theirs is None:
        return Figure(what, None, RATIO_BAR, note="EAIK does not solve this arm")
    against = ratio(one.ways[0], theirs)
    note = f"{theirs.name}: {short(one.microseconds(theirs)[0])} µs a pose, its worst error {_error(theirs)}"
    return Figure(
        what, against.median, RATIO_BAR, spread=(against.lower, against.upper), error=_error(one.ways[0]), note=note
    )  # fmt: skip


def _error(way: Timed) -> str:
    return f"{short(way.error)} m or rad"


def _table(rows: Sequence[Measured]) -> Table:
    return Table(
        "Processor time of every solution of a pose, all threads added up, and the largest error of those solutions "
        "by fk",
        ("arm", "how", "solutions", "µs a pose", "lower quartile", "upper quartile", "error (m or rad)", "includes"),
        [
            (one.title, way.name, number, *one.microseconds(way), way.error,
             next(words for name, words in INCLUDES.items() if way.name.startswith(name)))
            for one in rows for way, number in zip(one.ways, one.solutions, strict=True)
        ],
    )  # fmt: skip
