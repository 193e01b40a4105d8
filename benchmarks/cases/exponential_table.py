"""The paper's alternative to computing e^{A_i x_i}: a table of them at regular steps of the angle,
looked up.

Poses of an arm by the product of the exponentials, each taken from its joint's table (the nearest
entry, or a straight line between two) or computed from the sine and cosine: error, memory and time
over the step.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from poekin import Chain, dh
from poekin.algebra import compose, pose
from poekin.engine.straight_line.sincos import sincos
from poekin.formulas.lie.exponential import joint
from poekin.testing.oracles import exact

from ..draw import lines
from ..harness import Case, Comparison, compare
from ..report import Figure, Table, Topic, short

ARM, WHAT = "puma560", "Puma 560"
STEPS = (
    360,
    1_440,
    5_760,
    23_040,
    92_160,
)  # entries a turn: 1 degree, and a quarter of that each time
CONFIGURATIONS, JUDGED = 10_000, 100


@dataclass(frozen=True)
class Tables:
    """e^{A_i x} of each joint at regular steps from 0 to 2 pi, both ends included: (n, entries + 1,
    12).
    """

    entries: int
    rows: np.ndarray

    @property
    def megabytes(self) -> float:
        return self.rows.nbytes / 1e6


def tables(chain: Chain, entries: int) -> Tables:
    """The tables of a chain of revolute joints."""
    x = np.linspace(0.0, 2 * math.pi, entries + 1)
    rows = [joint(A[:3], A[3:], x, np.sin(x), np.cos(x)) for A in chain.screws.tolist()]
    return Tables(entries, np.stack([np.stack(np.broadcast_arrays(*T), axis=-1) for T in rows]))


def by_sines(screws, home, table, q, out):  # type: ignore[no-untyped-def]
    """Poses (N, 12) by computing each exponential."""
    for j in range(len(q)):
        T = pose(home)
        for i in range(q.shape[1]):
            A = screws[i]
            s, c = sincos(q[j, i])
            E = joint((A[0], A[1], A[2]), (A[3], A[4], A[5]), q[j, i], s, c)
            T = compose(T, E) if i else E
        _write(out[j], compose(T, home))


def by_nearest(screws, home, table, q, out):  # type: ignore[no-untyped-def]
    """Poses (N, 12) from the nearest entries."""
    entries = table.shape[1] - 1
    per_radian = entries / (2.0 * math.pi)
    for j in range(len(q)):
        T = pose(home)
        for i in range(q.shape[1]):
            E = pose(table[i, math.floor(q[j, i] * per_radian + 0.5) % entries])
            T = compose(T, E) if i else E
        _write(out[j], compose(T, home))


def by_line(screws, home, table, q, out):  # type: ignore[no-untyped-def]
    """Poses (N, 12) from straight lines between two entries; rotations are no longer orthonormal."""
    entries = table.shape[1] - 1
    per_radian = entries / (2.0 * math.pi)
    for j in range(len(q)):
        T = pose(home)
        for i in range(q.shape[1]):
            steps = q[j, i] * per_radian
            low = math.floor(steps)
            a, k = steps - low, low % entries
            E = _between(pose(table[i, k]), pose(table[i, k + 1]), a)
            T = compose(T, E) if i else E
        _write(out[j], compose(T, home))


def _between(a, b, t):  # type: ignore[no-untyped-def]
    """a + t (b - a) of two rows of twelve numbers."""
    return (
        a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]), a[3] + t * (b[3] - a[3]),
        a[4] + t * (b[4] - a[4]), a[5] + t * (b[5] - a[5]), a[6] + t * (b[6] - a[6]), a[7] + t * (b[7] - a[7]),
        a[8] + t * (b[8] - a[8]), a[9] + t * (b[9] - a[9]), a[10] + t * (b[10] - a[10]), a[11] + t * (b[11] - a[11]),
    )  # fmt: skip


def _write(row, T):  # type: ignore[no-untyped-def]
    for k in range(12):
        row[k] = T[k]


WAYS = {"nearest entry": by_nearest, "straight line": by_line}
COST = {"nearest entry": "0 × and 0 + a joint", "straight line": "12 × and 24 + a joint"}


@dataclass(frozen=True)
class Row:
    """One way at one step: error of the tool's position (m), and time beside computing the sines."""

    way: str
    table: Tables
    error: float
    measured: Comparison


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    chain = dh.to_chain(dh.published(ARM))
    rng = np.random.default_rng(0)
    q = rng.uniform(-math.pi, math.pi, (CONFIGURATIONS, chain.dof))
    say("references to 60 digits")
    references = np.stack(
        [exact.rounded(exact.forward(chain.screws, chain.home, x)) for x in q[:JUDGED]]
    )[:, :3, 3]
    home = np.concatenate([chain.home[:3, :3].ravel(), chain.home[:3, 3]])
    kernels = _kernels()

    def case(name: str, run: Callable, table: Tables) -> Case:
        def setup() -> Any:
            return (chain.screws, home, table.rows, q, np.empty((CONFIGURATIONS, 12)))

        def fill(state: Any) -> Any:
            kernels[run](*state)
            return state[-1]

        return Case(
            name, setup, fill, lambda state, T: float(np.abs(T[:JUDGED, 9:] - references).max())
        )

    rows = []
    for entries in STEPS[:3] if quick else STEPS:
        table = tables(chain, entries)
        for way, run in WAYS.items():
            measured = compare(
                case(way, run, table),
                case("sines", by_sines, table),
                pairs=5 if quick else 21,
                slice_s=0.01,
            )
            rows.append(Row(way, table, measured.first_error, measured))
        say(f"step {360 / entries:.3g}°")
    return _topic(rows)


def _topic(rows: list[Row]) -> Topic:
    best = {way: [r for r in rows if r.way == way][-1] for way in WAYS}
    steps = sorted({360 / r.table.entries for r in rows}, reverse=True)
    sines = rows[-1].measured
    return Topic(
        "The paper's alternative: a table of exponentials at regular steps",
        f"Poses of the {WHAT} at {CONFIGURATIONS} configurations, uniform over whole turns, by the product of the "
        "exponentials. Each e^{A x} is computed from its sine and cosine, or looked up in its joint's table, which the "
        "paper names as the way to save that. All three are compiled alike. The error is that of the tool's position, "
        f"the largest of {JUDGED} configurations, from the pose to 60 digits.\n\n"
        "The nearest entry is wrong in proportion to the step, a straight line between two entries in proportion to "
        "its square; memory grows as one over the step, and time with it as soon as the processor's caches are too "
        "small. Computing the sines needs no memory and is right to the last digits.",
        figures=[
            Figure(
                f"poses by a table of {short(r.table.megabytes)} MB, {way} ÷ by computing the sines: time",
                r.measured.ratio.median, spread=(r.measured.ratio.lower, r.measured.ratio.upper),
                error=f"{r.error:.1e} m (sines {r.measured.second_error:.1e})",
                note=f"a step of {360 / r.table.entries:.2g}°",
            )
            for way, r in best.items()
        ],
        tables=[
            Table(
                "Error, memory and time over the step",
                ("way", "step (°)", "operations beside the product", "memory (MB)", "error (m)", "time (ns a pose)",
                 "time ÷ sines"),
                [
                    *((r.way, f"{360 / r.table.entries:.3g}", COST[r.way], f"{r.table.megabytes:.3g}", f"{r.error:.1e}",
                       f"{1e9 * r.measured.first.median / CONFIGURATIONS:.0f}", f"{r.measured.ratio.median:.2f}")
                      for r in sorted(rows, key=lambda r: r.way)),
                    ("sines computed", "none", "15 × and 13 + a joint", "0", f"{sines.second_error:.1e}",
                     f"{1e9 * sines.second.median / CONFIGURATIONS:.0f}", "1"),
                ],
            )
        ],
        pictures=[
            lines(
                "Largest error of the tool's position by tables of exponentials", steps,
                {way: [r.error for r in rows if r.way == way] for way in WAYS}
                | {"sines computed": [sines.second_error] * len(steps)},
                x_label="step of the table (°)", y_label="error (m)", log=True,
            ),
        ],
    )  # fmt: skip


@functools.cache
def _kernels() -> dict[Callable, Callable]:
    """The functions of this file as the package compiles its formulas."""
    import numba
    from numba.extending import register_jitable

    from poekin.engine.jit import compile as engine_compile

    for helper in (_between, _write):
        register_jitable(helper)
    return {run: numba.njit(**engine_compile.OPTIONS)(run) for run in (by_sines, *WAYS.values())}
