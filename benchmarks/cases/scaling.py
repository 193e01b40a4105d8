"""Time against the number of joints, against the size of the batch, and with threads; poekin,
compiled, Pinocchio.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from poekin import Chain, load, screw

from .. import exact_arm, peers
from ..draw import lines
from ..harness import Case, Timed, in_turn
from ..report import Picture, Table, Topic
from ..workers import processors

JOINTS = (1, 2, 3, 5, 7, 10, 15, 20, 30, 50)
SIZES = (1, 10, 100, 1000, 10_000, 100_000, 1_000_000)
ROWS, CALLS, JUDGED = 2000, 20, 5

Arrays = tuple[np.ndarray, np.ndarray]


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    joints, over_joints = (1, 7, 50) if quick else JOINTS, []
    found = next(f for f in peers.find([peers.STANDARD["pinocchio"]]))
    for n in joints:
        over_joints.append(_at_joints(n, found, quick))
        say(f"{n} joint{'s' * (n > 1)}")
    sizes = SIZES[:5] if quick else SIZES
    over_sizes, threads = _at_sizes(sizes, quick, say)
    columns = [size for size, _ in threads], [row for _, row in threads]
    return Topic(
        "Time against joints, batch and threads",
        "Pose and hybrid Jacobian. Joints: random chains of revolute joints; one call each at another q, or "
        f"{ROWS} configurations at once, into arrays that are there. Batches: the Panda's hand. The floor is the time "
        "to write the same arrays and to compute nothing; above some hundred thousand configurations they are longer "
        "than the processor's caches. Cases run in turn; time is the processor's, over all threads of the process, but "
        "where threads are compared: there it is the wall clock's, and the machine has to be idle. The error is the "
        f"largest entry that differs from 60 digits at up to {JUDGED} configurations, lengths ÷ R. "
        + (f"Pinocchio is not shown: {found.problem}." if found.problem else ""),
        pictures=[
            _picture("Time against the number of joints (both axes logarithmic)", joints, over_joints, "joints"),
            _picture("Time against the size of the batch, Panda's hand (both axes logarithmic)", sizes, over_sizes,
                     "configurations at once"),
            *([_picture("Threads: time against the size of the batch, by the wall clock (both axes logarithmic)",
                        *columns,
                        "configurations at once")] if len(threads) > 1 else []),
        ],
        tables=[
            _table("Time against joints", "joints", joints, over_joints),
            _table("Time against batch", "configurations", sizes, over_sizes),
            _table("With threads, by the wall clock", "configurations", *columns),
        ],
    )  # fmt: skip


Row = dict[str, tuple[Timed, int]]
"""{what: (its time, configurations in a run)}"""


def random_chain(n: int) -> Chain:
    """n revolute joints about random lines within a metre or so."""
    rng = np.random.default_rng(n)
    axes, points = rng.normal(size=(2, n, 3))
    home = np.eye(4)
    home[:3, 3] = rng.normal(size=3)
    return Chain.from_space(
        [screw.revolute(w / np.linalg.norm(w), p / 3) for w, p in zip(axes, points, strict=True)], home,
        joint_names=[f"joint{k + 1}" for k in range(n)],
    )  # fmt: skip


def _at_joints(n: int, found: peers.Found, quick: bool) -> Row:
    chain = random_chain(n)
    arm = chain.compile()
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (ROWS, n))
    one, many = _arrays((), n), _arrays((ROWS,), n)
    judge = Judge(chain, q)
    few = list(q[:CALLS].copy())
    calls = {
        "poekin, one call": lambda x: chain.fk_jacobian(x, "hybrid", out=one),
        "compiled, one call": lambda x: arm.fk_jacobian(x, "hybrid", out=one),
    }
    cases = [
        (Case(name, lambda: few, _each(call), judge.of_calls(call)), CALLS)
        for name, call in calls.items()
    ]
    cases += [(case, CALLS) for case in _pinocchio(found, chain, q, judge)]
    cases += [
        (
            Case(
                "poekin, many",
                lambda: q,
                lambda q: chain.fk_jacobian(q, "hybrid", out=many),
                judge.of_many,
            ),
            ROWS,
        ),
        (
            Case(
                "compiled, many",
                lambda: q,
                lambda q: arm.fk_jacobian(q, "hybrid", out=many),
                judge.of_many,
            ),
            ROWS,
        ),
        (_floor(many), ROWS),
    ]
    return _measured(cases, rounds=3 if quick else 7)


def _pinocchio(found: peers.Found, chain: Chain, q: np.ndarray, judge: Judge) -> list[Case]:
    if found.problem or found.peer.kinematics is None:
        return []
    k = found.peer.kinematics(peers.Arm(chain))
    few = k.native(q[:CALLS])
    call: Any = k.fk_jacobian
    return [
        Case(
            "Pinocchio, one call",
            lambda: few,
            _each(call),
            judge.of_calls(lambda x: k.arrays(*call(x))),
        )
    ]


def _at_sizes(
    sizes: tuple[int, ...], quick: bool, say: Callable[[str], None]
) -> tuple[list[Row], list[Any]]:
    chain = load("erd:panda").chain(tip="panda_hand")
    arm, parallel = chain.compile(), chain.compile(parallel=True)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (sizes[-1], chain.dof))
    T, J = _arrays((sizes[-1],), chain.dof)
    judge = Judge(chain, q)
    cores = processors()
    rows, threads = [], []
    for size in sizes:
        some, out = q[:size], (T[:size], J[:size])

        def case(
            name: str, made: Any, some: np.ndarray = some, out: Arrays = out
        ) -> tuple[Case, int]:
            return (
                Case(name, lambda: some, lambda x: made.fk_jacobian(x, "hybrid", out=out), judge.of_many), len(some)
            )  # fmt: skip

        rounds = 3 if quick or size > 100_000 else 7
        rows.append(
            _measured(
                [case("poekin", chain), case("compiled", arm), (_floor(out), size)], rounds=rounds
            )
        )
        if size >= 10_000:
            both = [case("one thread", arm), case(f"{cores} threads", parallel)]
            threads.append((size, _measured(both, rounds=rounds, clock=time.perf_counter)))
        say(f"{size} at once")
    return rows, threads


class Judge:
    """The error of the first configurations against 60 digits, lengths ÷ R."""

    def __init__(self, chain: Chain, q: np.ndarray):
        self.exact = exact_arm.of_screws(chain.screws, chain.home, q[:JUDGED])
        self.weight = np.array([1.0] * 3 + [1 / chain.reach] * 3)

    def of_many(self, state: Any, result: Arrays) -> float:
        """Of a batch."""
        poses, columns = (part[:JUDGED] for part in result)
        pose = np.abs(poses - self.exact[0][: len(poses)])[:, :3] * self.weight[2:]
        both = np.abs(columns - self.exact[1][: len(poses)]) * self.weight[:, None]
        return float(max(pose.max(), both.max()))

    def of_calls(self, call: Callable[[Any], Arrays]) -> Callable[[Any, Any], float]:
        """Of one call each."""

        def error(state: Any, result: Any) -> float:
            some = [tuple(np.array(part) for part in call(one)) for one in state[:JUDGED]]
            return self.of_many(
                state, (np.stack([T for T, _ in some]), np.stack([J for _, J in some]))
            )

        return error


def _each(call: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda states: deque(map(call, states), maxlen=1)[0]


def _arrays(shape: tuple[int, ...], dof: int) -> Arrays:
    # Written to, so that the first case does not pay for the memory.
    return np.zeros((*shape, 4, 4)) + 0.0, np.zeros((*shape, 6, dof)) + 0.0


def _floor(arrays: Arrays) -> Case:
    def write(arrays: Arrays) -> None:
        for array in arrays:
            array.fill(1.0)

    return Case("writing alone", lambda: arrays, write, lambda state, result: float("nan"))


def _measured(cases: list[tuple[Case, int]], rounds: int, clock: Any = time.process_time) -> Row:
    timed = in_turn([case for case, _ in cases], rounds=rounds, slice_s=0.005, clock=clock)
    return {t.name: (t, count) for t, (_, count) in zip(timed, cases, strict=True)}


def _us(row: Row, name: str) -> float:
    timed, count = row[name]
    return 1e6 * timed.time.median / count


def _picture(caption: str, x: Any, rows: list[Row], x_label: str) -> Picture:
    curves = {name: [_us(row, name) for row in rows] for name in rows[0]}
    return lines(caption, x, curves, x_label=x_label, y_label="time (µs a configuration)", log=True)


def _table(caption: str, head: str, x: Any, rows: list[Row]) -> Table:
    cells = [
        (at, name, 1e6 * t.time.median / count, 1e6 * t.time.lower / count, 1e6 * t.time.upper / count,
         t.error if t.error == t.error else "")
        for at, row in zip(x, rows, strict=True) for name, (t, count) in row.items()
    ]  # fmt: skip
    columns = (
        head,
        "what",
        "time (µs a configuration)",
        "lower quartile",
        "upper quartile",
        "error",
    )
    return Table(caption, columns, cells, folded=True)
