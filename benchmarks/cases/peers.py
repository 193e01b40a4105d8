"""Pose and Jacobian of the Panda's hand by every library that is installed: one call, and many
configurations.
"""

from __future__ import annotations

import math
import os
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from poekin import Chain, load

from .. import exact_arm, peers
from ..draw import bars
from ..harness import Case, Timed, in_turn, ratio
from ..peers import Arm, Kinematics
from ..report import Figure, Picture, Table, Topic, short

MANY, CALLS = 20_000, 20
NONE = "has no kinematics of arms"
RUNS = {"pose": CALLS, "both": CALLS, "many": MANY}  # configurations in a run of each case


@dataclass(frozen=True)
class Library:
    """poekin or a peer: its name, its kinematics of the arm or what is wrong with it, and whether
    it is poekin.
    """

    name: str
    kinematics: Kinematics | None
    problem: str = ""
    own: bool = False


@dataclass
class Times:
    """What was measured of a library: pose alone, pose and Jacobian, and that of many at once."""

    pose: Timed | None = None
    both: Timed | None = None
    many: Timed | None = None


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robot = load("erd:panda")
    chain = robot.chain(tip="panda_hand")
    with open(str(robot.source), encoding="utf-8") as stream:
        text = stream.read()
    q = chain.random(np.random.default_rng(0), MANY)
    poses, columns = exact_arm.hybrid(text, "panda_hand", q[:CALLS])
    judge = partial(_error, poses, columns, chain.reach)
    own, others = libraries(Arm(chain), say)
    tried = [tested(library, q, judge) for library in others]
    ready = [library for library in [*own, *tried] if library.kinematics is not None]
    times = {library.name: Times() for library in [*own, *tried]}
    rounds = 5 if quick else 15
    for what, cases in _cases(ready, q, judge).items():
        for name, timed in zip(cases, in_turn(list(cases.values()), rounds=rounds), strict=True):
            setattr(times[name], what, timed)
        say({"pose": "pose alone", "both": "pose and Jacobian", "many": f"{MANY} at once"}[what])
    alone = _alone(chain, q, rounds)
    say("threads, and writing alone")
    first = own[0].name
    notes = [
        (x.name, x.kinematics.note) for x in tried if x.kinematics is not None and x.kinematics.note
    ]
    return Topic(
        "Pose and Jacobian of the Panda's hand by every library",
        "Fingers locked, from Python, each library in its fastest documented way, and in the frame in which it has its "
        "Jacobian. Its results are the arrays or objects that its users get; what has to be turned for the comparison "
        f"is turned outside the clock. One call means many in a row, each at another q within the limits; {MANY} at "
        "once is measured where a library takes a batch. Cases run in turn, time is the processor's, over all threads "
        f"of the process. The error is the largest entry that differs at {CALLS} configurations from what 60 digits "
        "make of the URDF's text, lengths ÷ R.",
        figures=[_figure(library, times, first) for library in tried if library.problem != NONE],
        pictures=[_picture(times, alone)],
        tables=[
            Table(
                "Time of each (µs a configuration)",
                ("library", "Jacobian", "pose alone", "error", "pose and J, one call", "quartiles", "error",
                 f"{MANY} at once", "error"),
                [_row(library, times[library.name]) for library in [*own, *tried]],
            ),
            Table(
                f"By the wall clock: {MANY} at once, into arrays that are there",
                ("what", "time (µs a configuration)"),
                list(alone.items()),
            ),
            *([Table("Notes", ("library", "note"), notes)] if notes else []),
        ],
    )  # fmt: skip


def _alone(chain: Chain, q: np.ndarray, rounds: int) -> dict[str, float]:
    """Wall-clock µs a configuration: all at once in one thread and in all, and writing the same
    arrays with nothing computed.
    """
    out = np.zeros((MANY, 4, 4)) + 0.0, np.zeros((MANY, 6, chain.dof)) + 0.0

    def batch(name: str, parallel: bool) -> Case:
        arm = chain.compile(parallel=parallel)
        return Case(
            name,
            lambda: q,
            lambda q: arm.fk_jacobian(q, "hybrid", out=out),
            lambda state, result: math.nan,
        )

    def write(arrays: tuple[np.ndarray, np.ndarray]) -> None:
        for array in arrays:
            array.fill(1.0)

    threads = f"poekin, compiled, out=, {os.cpu_count()} threads"
    cases = [
        batch("poekin, compiled, out=, one thread", False),
        batch(threads, True),
        Case("writing the arrays alone", lambda: out, write, lambda state, result: math.nan),
    ]
    timed = in_turn(cases, rounds=rounds, clock=time.perf_counter)
    return {case.name: 1e6 * case.time.median / MANY for case in timed}


def _picture(times: dict[str, Times], alone: dict[str, float]) -> Picture:
    many = f"{MANY} at once"
    rows: dict[str, dict[str, float | None]] = {
        name: {"one call": _us(t.both, "both"), many: _us(t.many, "many")}
        for name, t in times.items()
        if t.both
    }
    rows |= {name: {many: found} for name, found in list(alone.items())[1:]}
    return bars(
        "Time of pose and Jacobian of the Panda's hand (µs a configuration, logarithmic; shorter is faster)",
        rows,
        x_label="time (µs a configuration)",
    ).answering("fast")


def libraries(arm: Arm, say: Callable[[str], None]) -> tuple[list[Library], list[Library]]:
    """poekin's own ways, and the peers of this run; one that cannot be used says why."""
    chain, compiled = arm.chain, arm.chain.compile()
    one, many = ((np.empty((*n, 4, 4)), np.empty((*n, 6, chain.dof))) for n in ((), (MANY,)))

    def reused(q: np.ndarray) -> Any:
        return compiled.fk_jacobian(q, "hybrid", out=one if q.ndim == 1 else many)

    def way(name: str, fk: Any, both: Any) -> Library:
        return Library(
            f"poekin, {name}",
            Kinematics("hybrid", fk, both, native=lambda q: q, batch=True),
            own=True,
        )

    own = [
        way("compiled", compiled.fk, lambda q: compiled.fk_jacobian(q, "hybrid")),
        way(
            "compiled, out=",
            lambda q: compiled.fk(q, out=one[0] if q.ndim == 1 else many[0]),
            reused,
        ),
        way("chain", chain.fk, lambda q: chain.fk_jacobian(q, "hybrid")),
    ]
    others = []
    for found in peers.chosen():
        make = found.peer.kinematics
        if make is None:
            others.append(Library(found.label, None, found.problem or NONE))
        elif found.problem:
            others.append(Library(found.label, None, found.problem))
        else:
            others.append(Library(found.label, *peers.attempt(lambda make=make: make(arm))))
        if others[-1].problem not in ("", NONE):
            say(f"{found.label}: {others[-1].problem}")
    return own, others


def tested(library: Library, q: np.ndarray, judge: Any) -> Library:
    """The same library, or without its kinematics where a first call breaks off."""
    if library.kinematics is None:
        return library
    k = library.kinematics
    _, problem = peers.attempt(lambda: [_error_of(case) for case in of(library, k, q, judge)])
    return Library(library.name, None, problem) if problem else library


def _error_of(case: Case) -> float:
    state = case.setup()
    return case.error(state, case.run(state))


def of(library: Library, k: Kinematics, q: np.ndarray, judge: Any) -> list[Case]:
    """The calls of one library: pose alone, pose and Jacobian where it has one, and many at once
    where it can.
    """
    few = k.native(q[:CALLS])
    # A batch of one is one call, where a library takes nothing but batches.
    singles = list(few) if library.own or not k.batch else [few[i : i + 1] for i in range(len(few))]

    def calls(call: Callable[[Any], Any]) -> Callable[[Any], Any]:
        return lambda states: deque(map(call, states), maxlen=1)[0]

    def pose_error(state: Any, result: Any) -> float:
        return judge(
            "", np.stack([np.array(k.pose(k.fk(one))).reshape(4, 4) for one in state[:CALLS]]), None
        )

    def error(state: Any, result: Any) -> float:
        some = [tuple(map(np.array, k.arrays(*k.fk_jacobian(one)))) for one in state[:CALLS]]  # type: ignore[misc]
        T, J = (
            np.stack([np.reshape(pair[i], pair[i].shape[-2:]) for pair in some]) for i in (0, 1)
        )
        return judge(k.frame, T, J)

    def many_error(state: Any, result: Any) -> float:
        T, J = k.arrays(*result)
        return judge(k.frame, T[:CALLS], J[:CALLS])

    cases = [Case("pose", lambda: singles, calls(k.fk), pose_error)]
    if k.fk_jacobian is not None:
        cases.append(Case("both", lambda: singles, calls(k.fk_jacobian), error))
        if k.batch:
            cases.append(Case("many", lambda: k.native(q), k.fk_jacobian, many_error))
    return cases


def _cases(ready: list[Library], q: np.ndarray, judge: Any) -> dict[str, dict[str, Case]]:
    """{what: {library: case}}, so that what is compared runs in turn."""
    cases: dict[str, dict[str, Case]] = {"pose": {}, "both": {}, "many": {}}
    for library in ready:
        if library.kinematics is not None:
            for case in of(library, library.kinematics, q, judge):
                cases[case.name][library.name] = case
    return cases


def _error(
    poses: np.ndarray, columns: np.ndarray, reach: float, frame: str, T: np.ndarray, J: Any
) -> float:
    """The largest entry that differs from the exact ones, lengths ÷ reach; of the poses alone where
    J is None.
    """
    weight = np.array([1.0, 1.0, 1.0, 1 / reach])
    worst = (np.abs(T - poses)[:, :3] * weight).max()
    if J is not None:
        exact = columns
        if frame == "space":  # v of the point at the base's origin: v - ω × p
            p = poses[:, :3, 3, None]
            exact = np.concatenate(
                [columns[:, :3], columns[:, 3:] - np.cross(columns[:, :3], p, axis=1)], 1
            )
        elif frame == "body":
            exact = np.kron(np.eye(2), poses[:, :3, :3].transpose(0, 2, 1)) @ columns
        worst = max(worst, (np.abs(J - exact) * np.repeat(weight[2:], 3)[:, None]).max())
    return float(worst)


def _us(timed: Timed | None, what: str) -> float | None:
    return None if timed is None else 1e6 * timed.time.median / RUNS[what]


def _figure(library: Library, times: dict[str, Times], first: str) -> Figure:
    what = f"{library.name}: pose and Jacobian, one call ÷ poekin's, compiled"
    peer, own = times[library.name].both, times[first].both
    if peer is None or own is None:
        return Figure(what, None, note=library.problem or "has no Jacobian")
    found = ratio(peer, own)
    return Figure(
        what,
        found.median,
        spread=(found.lower, found.upper),
        error=f"{short(peer.error)} (poekin {short(own.error)})",
    )


def _row(library: Library, t: Times) -> tuple[str | float, ...]:
    k = library.kinematics
    cells: list[str | float] = [library.name, k.frame if k and k.fk_jacobian else library.problem]
    for what, timed in (("pose", t.pose), ("both", t.both), ("many", t.many)):
        if timed is None:
            cells += [""] * (3 if what == "both" else 2)
            continue
        scale = 1e6 / RUNS[what]
        quartiles = f"{short(scale * timed.time.lower)} – {short(scale * timed.time.upper)}"
        cells += [scale * timed.time.median, *([quartiles] if what == "both" else []), timed.error]
    return tuple(cells)
