"""Maps of a workspace: time a sample beside the compiled batch, threads, a hundred million samples, and a
million poses by inverse kinematics.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

import poekin as pk
from poekin.model.chain import Chain
from poekin.sweep import Cells, Random, Sweep, SweepMap, run
from poekin.sweep.samples import Samples

from ..harness import Case, Timed, in_turn, ratio
from ..report import Figure, Table, Topic, short
from ..workers import processors

SEED, COUNT, JUDGED = 3, 200_000, 2000
WHOLE, QUICK_WHOLE = 100_000_000, 1_000_000
POSES, QUICK_POSES = 1_000_000, 20_000
SAMPLE_BAR, BATCH_BAR, THREADS_BAR, WHOLE_BAR = 60.0, 1.6, 0.55, 8.0  # ns, ratios, s
POSES_BAR = 10.0  # s
BATCH = "compiled batch, pose and Jacobian into arrays"
MANIPULABILITY = "sweep: pose, manipulability, cube"
REACH = "sweep: pose, cube"
DIRECTIONS = "sweep: pose, cube, one of 192 directions"


@dataclass(frozen=True)
class Question:
    """A sweep that is timed."""

    name: str
    sweep: Sweep

    def case(self) -> Case:
        """The sweep on one thread."""
        return Case(
            self.name,
            lambda: self.sweep,
            lambda sweep: run(sweep, workers=1, chunk=COUNT),
            lambda _, found: error(self.sweep, found),
        )


def error(sweep: Sweep, found: SweepMap) -> float:
    """Share of the first samples that single configurations put into a cell that has none, or, of
    the measure, the largest difference from that of singular values.
    """
    q = _judged(sweep)
    T = sweep.chain.fk(q)
    lost = float(np.mean((found.query(T) == 0) & (found.cells.find(T) >= 0)))
    if found.best is None:
        return lost
    filled = np.flatnonzero(found.counts)[:JUDGED]
    best = found.best.reshape(-1)[filled]
    attained = found.configurations().reshape(-1, q.shape[1])[filled]
    own = pk.manipulability(sweep.chain, attained).pose.yoshikawa
    off = np.nan_to_num(np.abs(best - own), nan=np.inf)
    return max(lost, float(off.max()))


def _judged(sweep: Sweep) -> np.ndarray:
    """The first configurations (JUDGED, m)."""
    assert isinstance(sweep.samples, Samples)
    return sweep.samples.configurations(np.arange(JUDGED))


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    chain = pk.load("panda").chain(tip="panda_hand")
    timed = measured(chain, 5 if quick else 21)
    say("time a sample")
    batch, manipulability, reach, directions = timed
    figures = [
        _figure(manipulability, SAMPLE_BAR),
        _figure(reach),
        _figure(directions),
        _ratio(manipulability, batch),
    ]
    if processors() > 1:
        figures.append(_threads(chain))
        say("threads")
    figures.append(_whole(chain, QUICK_WHOLE if quick else WHOLE))
    say("a whole map")
    figures.append(_poses(QUICK_POSES if quick else POSES))
    rows = [(one.name, 1e9 * one.time.median / COUNT, short(one.error)) for one in timed]
    return Topic(
        "Maps of a workspace",
        "The Panda's hand. A sample is drawn, its pose and measure computed and its cell counted, with nothing written "
        "between; the compiled batch takes configurations that are there and writes poses and Jacobians. Ways run in "
        "turn, time is the processor's. Errors: the share of samples whose cell is empty, and what the best "
        "manipulability of a cell differs from the product of singular values.",
        figures=figures,
        tables=[Table("Time a configuration, one thread", ("what", "ns", "error"), rows)],
    )


def measured(chain: Chain, rounds: int) -> list[Timed]:
    """The compiled batch, and three sweeps."""
    fast = chain.compile()
    samples = Random.of(chain, COUNT, SEED)
    q = samples.configurations(np.arange(COUNT))
    out = np.empty((COUNT, 4, 4)), np.empty((COUNT, 6, chain.dof))

    def batch_error(_: None, result: tuple[np.ndarray, np.ndarray]) -> float:
        return float(np.abs(result[0][:JUDGED] - chain.fk(q[:JUDGED])).max())

    cases = [
        Case(BATCH, lambda: None, lambda _: fast.fk_jacobian(q, "hybrid", out=out), batch_error),
        Question(MANIPULABILITY, Sweep(chain, samples, _cells(0), "manipulability")).case(),
        Question(REACH, Sweep(chain, samples, _cells(0))).case(),
        Question(DIRECTIONS, Sweep(chain, samples, _cells(4))).case(),
    ]
    return in_turn(cases, rounds=rounds)


def _cells(side: int) -> Cells:
    return Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.1, side)


def _figure(one: Timed, bar: float | None = None) -> Figure:
    each = 1e9 / COUNT
    spread = one.time.lower * each, one.time.upper * each
    return Figure(
        f"{one.name}, a sample", one.time.median * each, bar, "ns", spread=spread, error=short(one.error)
    )  # fmt: skip


def _ratio(one: Timed, batch: Timed) -> Figure:
    against = ratio(one, batch)
    note = f"the batch takes {short(1e9 * batch.time.median / COUNT)} ns, its worst error {short(batch.error)}"
    what = f"{one.name} ÷ {BATCH}"
    return Figure(
        what, against.median, BATCH_BAR, spread=(against.lower, against.upper), error=short(one.error), note=note
    )  # fmt: skip


def _threads(chain: Chain) -> Figure:
    """Two threads beside one, by the wall clock."""
    sweep = Sweep(chain, Random.of(chain, 10 * COUNT, SEED), _cells(0), "manipulability")
    cases = [
        Case(
            f"{n}",
            lambda: None,
            lambda _, n=n: run(sweep, workers=n, chunk=COUNT // 2),
            lambda *_: 0.0,
        )
        for n in (2, 1)
    ]
    two, one = in_turn(cases, rounds=7, clock=time.perf_counter)
    against = ratio(two, one)
    return Figure(
        "sweep: two threads ÷ one, by the wall clock", against.median, THREADS_BAR,
        spread=(against.lower, against.upper), error="the same bytes",
    )  # fmt: skip


def _whole(chain: Chain, count: int) -> Figure:
    """A whole map, by the wall clock."""
    start = time.perf_counter()
    found = pk.sweep.reach(chain, samples=count, resolution=0.05, side=4, seed=SEED)
    seconds = time.perf_counter() - start
    return Figure(
        f"{count} samples, cubes of 50 mm, 192 directions, {processors()} threads", seconds,
        WHOLE_BAR if count == WHOLE else None, "s",
        note=f"{100 * found.new_cell_chance:.2g} % of further samples would fall into an empty cell",
    )  # fmt: skip


def _poses(count: int) -> Figure:
    """A map by all solutions of the inverse kinematics of each pose, by the wall clock; its error is the
    largest difference of reached poses from those of their best solutions.
    """
    chain = pk.load("ur5e").chain(tip="tool0")
    start = time.perf_counter()
    found = pk.sweep.reach(chain, samples=count, by="poses", measure="solutions", seed=SEED)
    seconds = time.perf_counter() - start
    cells = np.flatnonzero(found.counts)[:JUDGED]
    T = found.poses().reshape(-1, 4, 4)[cells]
    off = np.abs(chain.fk(found.configurations().reshape(-1, chain.dof)[cells]) - T)
    share = found.counts.sum() / count
    most = int(np.nanmax(np.asarray(found.best)))
    return Figure(
        f"UR5e: {count} poses by all solutions of the inverse kinematics, {processors()} threads", seconds,
        POSES_BAR if count == POSES else None, "s", error=short(float(off.max())),
        note=f"{100 * share:.3g} % are reached, with up to {most} solutions",
    )  # fmt: skip
