"""Pose and hybrid Jacobian of the Panda's hand, compiled for the arm: ÷ Pinocchio's Python, ÷ the
bare writing.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from poekin import load

from .. import exact_arm, peers
from ..harness import Case, Timed, compare, in_turn, ratio
from ..report import Figure, Table, Topic, short
from ..workers import processors

CONFIGURATIONS, CALLS, JUDGED = 20_000, 200, 50
MILLION = 1_000_000

Arrays = tuple[np.ndarray, np.ndarray]
Judge = Callable[[Any, Any], float]


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robot = load("erd:panda")
    chain = robot.chain(tip="panda_hand")
    with open(str(robot.source), encoding="utf-8") as stream:
        text = stream.read()
    arm = chain.compile()
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (CONFIGURATIONS, chain.dof))
    judged = [*q[:JUDGED], q[CALLS - 1]]
    judge = Judged(*exact_arm.hybrid(text, "panda_hand", judged), chain.reach)
    found = next(f for f in peers.find([peers.STANDARD["pinocchio"]]))
    loops, calls, note = _pinocchio(found, peers.Arm(chain), q, judge)
    many = _arrays(CONFIGURATIONS, chain.dof)
    one = _arrays((), chain.dof)

    def each(call: Callable[[np.ndarray], Arrays]) -> Callable[[list[np.ndarray]], Arrays]:
        return lambda configurations: deque(map(call, configurations), maxlen=1)[0]

    few = list(q[:CALLS].copy())
    batches = [
        Case(
            "compiled, out=",
            lambda: q,
            lambda q: arm.fk_jacobian(q, "hybrid", out=many),
            judge.many,
        ),
        Case(
            "compiled, fresh arrays", lambda: q, lambda q: arm.fk_jacobian(q, "hybrid"), judge.many
        ),
        Case(
            "writing the same arrays, and nothing else",
            lambda: many,
            _written,
            lambda s, r: float("nan"),
        ),
    ]
    ones = [
        Case(
            "compiled, one call, out=",
            lambda: few,
            each(lambda q: arm.fk_jacobian(q, "hybrid", out=one)),
            judge.one,
        ),
        Case(
            "compiled, one call, fresh arrays",
            lambda: few,
            each(lambda q: arm.fk_jacobian(q, "hybrid")),
            judge.one,
        ),
    ]
    in_batch = in_turn([*batches, *loops], rounds=5 if quick else 21)
    say(f"{CONFIGURATIONS} configurations")
    in_calls = in_turn([*ones, *calls], rounds=5 if quick else 31)
    say("one call")
    threads = _threads(chain, arm, judge, quick)
    say(f"{MILLION} configurations")
    reused, fresh, written = in_batch[:3]
    return Topic(
        "Pose and hybrid Jacobian of the Panda's hand, compiled for the arm",
        "`chain.compile()` makes machine code for the numbers of one arm. All yield the same two arrays, 4×4 and 6×7, "
        "from Python; Pinocchio computes joint Jacobians, frame placement and frame Jacobian, the faster of its two "
        "usual ways, one configuration after the other. The floor is the time to write two arrays of that size and to "
        "compute nothing. Cases run in turn; a ratio is the median over rounds. Time is the processor's, over all "
        "threads of the process, but for the row of threads. The error is the largest entry that differs from what "
        "60 digits make of the URDF's text, lengths ÷ R.",
        figures=[
            *_figures(f"Panda, {CONFIGURATIONS} configurations, one thread, compiled, out= ÷ Pinocchio's Python loop",
                      reused, in_batch[3:], 1 / 40, "1/40", note),
            *_figures("the same into fresh arrays ÷ Pinocchio's Python loop", fresh, in_batch[3:], note=note),
            _figure(f"Panda, {CONFIGURATIONS} configurations, compiled, out= ÷ writing the same arrays", reused,
                    written, 4, "4"),
            _figure("the same into fresh arrays ÷ writing into arrays that are there", fresh, written),
            *_figures("Panda, one call of the compiled arm, out= ÷ Pinocchio's Python", in_calls[0], in_calls[2:],
                      0.55, "0.55", note),
            *_figures("the same into fresh arrays ÷ Pinocchio's Python", in_calls[1], in_calls[2:], note=note),
            threads,
        ],
        tables=[
            Table(
                "Time of each", ("what", "time (ns a configuration)", "lower quartile", "upper quartile", "error"),
                [_times(t, CONFIGURATIONS) for t in in_batch] + [_times(t, CALLS) for t in in_calls],
            )
        ],
    )  # fmt: skip


class Judged:
    """The error of poses and Jacobians against the exact ones of the first so many configurations,
    and of the last.
    """

    def __init__(self, poses: np.ndarray, columns: np.ndarray, reach: float):
        self.poses, self.columns, self.reach = poses, columns, reach

    def many(self, state: Any, result: Arrays) -> float:
        """Of a batch: its first configurations."""
        count = len(self.poses) - 1
        return self.error(result[0][:count], result[1][:count], slice(count))

    def one(self, state: Any, result: Arrays) -> float:
        """Of the last call."""
        return self.error(result[0], result[1], -1)

    def error(self, T: np.ndarray, J: np.ndarray, which: Any) -> float:
        """The largest entry that differs, lengths ÷ reach."""
        weight = np.array([1.0] * 3 + [1 / self.reach])
        pose = np.abs(T - self.poses[which])[..., :3, :] * weight
        columns = np.abs(J - self.columns[which]) * np.repeat(weight[2:], 3)[:, None]
        return float(max(pose.max(), columns.max()))


def _pinocchio(
    found: peers.Found, arm: peers.Arm, q: np.ndarray, judge: Judged
) -> tuple[list[Case], list[Case], str]:
    """Pinocchio's loop into two arrays, its calls, and what is wrong with it."""
    if found.problem or found.peer.kinematics is None:
        return [], [], found.problem
    make = found.peer.kinematics
    peer, problem = peers.attempt(lambda: make(arm))
    if problem:
        return [], [], problem
    call, each = peer.fk_jacobian, peer.native(q)

    def loop(configurations: list[np.ndarray]) -> Arrays:
        poses, columns = _arrays(len(configurations), arm.chain.dof)
        for k, one in enumerate(configurations):
            poses[k], columns[k] = call(one)
        return poses, columns

    def calls(configurations: list[np.ndarray]) -> Any:
        return deque(map(call, configurations), maxlen=1)[0]

    def of_many(state: Any, result: Arrays) -> float:
        some = [
            peer.arrays(T, J) for T, J in zip(result[0][:JUDGED], result[1][:JUDGED], strict=True)
        ]
        return judge.error(
            np.stack([T for T, _ in some]), np.stack([J for _, J in some]), slice(JUDGED)
        )

    return (
        [Case(f"{found.label}, loop", lambda: each, loop, of_many)],
        [Case(f"{found.label}, one call", lambda: each[:CALLS], calls,
              lambda state, result: judge.one(state, peer.arrays(*result)))],
        "",
    )  # fmt: skip


def _threads(chain: Any, arm: Any, judge: Judged, quick: bool) -> Figure:
    """All processors that this process may use ÷ one, by the wall clock."""
    cores = processors()
    words = "two threads" if cores == 2 else f"{cores} threads"
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (MILLION, chain.dof))
    q[:JUDGED] = np.random.default_rng(0).uniform(-np.pi, np.pi, (JUDGED, chain.dof))
    out, parallel = _arrays(MILLION, chain.dof), chain.compile(parallel=True)
    cases = [
        Case(name, lambda: q, lambda q, a=a: a.fk_jacobian(q, "hybrid", out=out), judge.many)
        for name, a in (("threads", parallel), ("one", arm))
    ]
    c = compare(*cases, pairs=3 if quick else 11, clock=time.perf_counter)
    return Figure(
        f"Panda, {MILLION} configurations: {words} ÷ one", c.ratio.median, 0.75,
        spread=(c.ratio.lower, c.ratio.upper), error=f"{short(c.first_error)} (one thread {short(c.second_error)})",
        note=f"by the wall clock, so only an otherwise idle machine shows what threads are worth; one thread takes "
        f"{short(1e3 * c.second.median)} ms; load of the machine before: {_load()}",
    )  # fmt: skip


def _load() -> str:
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def _arrays(count: Any, dof: int) -> Arrays:
    shape = count if isinstance(count, tuple) else (count,)
    return np.empty((*shape, 4, 4)), np.empty((*shape, 6, dof))


def _written(arrays: Arrays) -> None:
    for array in arrays:
        array.fill(1.0)


def _figures(
    what: str,
    own: Timed,
    peer: list[Timed],
    bar: float | None = None,
    bar_text: str = "",
    note: str = "",
) -> list[Figure]:
    """The ratio to a peer, or a row that says why there is none."""
    return [
        _figure(what, own, peer[0], bar, bar_text) if peer else Figure(what, None, bar, note=note)
    ]


def _figure(
    what: str, own: Timed, other: Timed, bar: float | None = None, bar_text: str = ""
) -> Figure:
    found = ratio(own, other)
    error = short(own.error) + (
        f" (Pinocchio {short(other.error)})" if other.error == other.error else ""
    )
    return Figure(
        what, found.median, bar, spread=(found.lower, found.upper), error=error,
        bar_shown=bar_text and f"≤ {bar_text}",
    )  # fmt: skip


def _times(t: Timed, count: int) -> tuple[str | float, ...]:
    numbers = [1e9 * value / count for value in (t.time.median, t.time.lower, t.time.upper)]
    return (t.name, *numbers, short(t.error) if t.error == t.error else "")
