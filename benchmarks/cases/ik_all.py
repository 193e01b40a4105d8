"""Every solution of a pose: what it takes beside EAIK, the search alone against EAIK's closed form,
and how near all are to their targets.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

import poekin as pk
from poekin.model.chain import Chain

from ..calibrated_arm import calibrated_ur10e
from ..report import Figure, Table, Topic, short
from .ik_all_judge import CALIBRATED, SAME, Eaik, absent, equal, errors, missed

ARMS = {"ur5": "UR5", "puma560": "Puma 560"}
SEED, COUNT, SEARCHED = 5, 500, 100


@dataclass(frozen=True)
class Judged:
    """One arm: the largest errors of solutions (m, rad), how many sets equal EAIK's, and seconds a
    target by method.
    """

    name: str
    position: float
    rotation: float
    equal: int
    targets: int
    seconds: dict[str, float]
    solutions: dict[str, int]


def judged(name: str, count: int) -> Judged:
    """One arm at targets of configurations drawn from one turn of every joint."""
    chain = pk.load(name).chain()
    T = chain.fk(np.random.default_rng(SEED).uniform(-np.pi, np.pi, (count, chain.dof)))
    eaik = Eaik(chain)
    targets = eaik.targets(T)
    start = time.process_time()
    answers = eaik.each(targets)
    times, results = {"EAIK alone": (time.process_time() - start) / count}, {}
    own, counts = eaik.own(answers, T)
    theirs = np.split(own, np.cumsum(counts)[:-1])
    for method in ("search", "closed"):
        pk.ik_all(chain, T[:1], method=method, limits=False)
        start = time.process_time()
        results[method] = pk.ik_all(chain, T, method=method, limits=False)
        times[method] = (time.process_time() - start) / count
    worst = [errors(chain, result.q, result.counts, T) for result in results.values()]
    same = sum(equal(a, b) for a, b in zip(results["search"].solutions, theirs, strict=True))
    numbers = {method: int(result.counts.sum()) for method, result in results.items()}
    position, rotation = (max(pair) for pair in zip(*worst, strict=True))
    return Judged(
        name,
        position,
        rotation,
        same,
        count,
        times,
        numbers | {"EAIK alone": len(own)},
    )


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    count = 100 if quick else COUNT
    title = "Every solution of a pose"
    if (without := absent(title, "search alone against EAIK's solution sets")) is not None:
        return without
    found = []
    for name in ARMS:
        found.append(judged(name, count))
        say(ARMS[name])
    figures = []
    for one in found:
        figures += [
            Figure(
                f"{ARMS[one.name]}: targets for which the search alone finds EAIK's solution set",
                1 - one.equal / one.targets, 0.005, shown=f"{100 * one.equal / one.targets:.4g} %",
                bar_shown="≥ 99.5 %", error=f"{short(one.position)} m, {short(one.rotation)} rad",
                note=f"{one.targets} targets; {short(1e3 * one.seconds['search'])} ms a target",
            ),
            Figure(
                f"{ARMS[one.name]}: largest error of a solution by fk, search and closed form",
                max(one.position, one.rotation), 1e-10, "m and rad",
            ),
        ]  # fmt: skip
    figures += _complete(calibrated_ur10e(), 2 * count, SEARCHED // 4 if quick else SEARCHED)
    say(CALIBRATED)
    rows = [
        (ARMS[one.name], {"search": "search alone", "closed": "closed form, tried down"}.get(how, how),
         one.solutions[how], 1e3 * one.seconds[how])
        for one in found for how in ("search", "closed", "EAIK alone")
    ]  # fmt: skip
    return Topic(
        title,
        "Targets are poses of configurations drawn evenly from one turn of every joint, without limits. Two sets are "
        f"equal where each solution of one is one of the other within {SAME:g} rad. EAIK's own time is that of its "
        "calls alone, without its least-squares answers being sorted out.",
        figures=figures,
        tables=[
            Table(
                "Solutions found, and processor time",
                ("arm", "how", "solutions", "ms a target"),
                rows,
            ),
        ],
    )


def _complete(chain: Chain, count: int, searched: int) -> list[Figure]:
    """What the calibrated arm's `complete` is worth, by a search from random starts for the first
    of the targets.
    """
    T = chain.fk(np.random.default_rng(SEED + 2).uniform(-np.pi, np.pi, (count, chain.dof)))
    share = float(np.mean(pk.ik_all(chain, T, method="auto", limits=False).complete))
    few = T[:searched]
    every = pk.ik_all(chain, few, method="auto", limits=False)
    lost = missed(every, pk.ik_all(chain, few, method="search", limits=False))
    return [
        Figure(
            f"{CALIBRATED}: solutions of a search that are missing where `complete` is True",
            int(lost[np.asarray(every.complete)].sum()), 0,
            note=f"{len(few)} targets; {int(lost.sum())} at all targets",
        ),
        Figure(
            f"{CALIBRATED}: targets of which the solutions are surely complete", 1 - share, 0.01,
            shown=f"{100 * share:.4g} %", bar_shown="≥ 99 %", note=f"{count} targets; method {every.method}",
        ),
    ]  # fmt: skip
