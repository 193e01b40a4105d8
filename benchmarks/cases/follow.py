"""A straight path of 1000 poses, half a metre long: the largest step, each pose, and the time ÷
solving them alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin import load
from poekin.model.chain import Chain
from poekin.model.kinematics.compiled import CompiledChain
from poekin.solve import motion
from poekin.solve.ik.ik import ik
from poekin.solve.path.follow import follow

from ..harness import Case, Timed, in_turn, ratio
from ..report import Figure, Table, Topic, short
from .inverse_kinematics_judge import TOLERANCE, judged

POSES, LENGTH = 1000, 0.5
STEP, TIMES = 0.1, 2.0

# The pose in the middle, by its joints; the path runs along the base's y axis, a quarter of a metre
# to either side.
ARMS = (
    ("Panda", "panda", "panda_hand", (0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.8)),
    ("UR5", "ur5", None, (0.0, -1.2, 1.6, -1.9, -1.57, 0.0)),
)


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    figures: list[Figure] = []
    rows: list[tuple[Any, ...]] = []
    ends = []
    for label, name, tip, middle in ARMS:
        chain = load(name).chain(tip=tip)
        T = path(chain, np.array(middle))
        fast = chain.compile()
        free, given, alone = _measured(fast, T, quick)
        found, started = follow(fast, T), follow(fast, T, q0=follow(fast, T).q[0])
        true = judged(chain, T, found.q, found.success)
        worst = float(max(true.position.max(), true.rotation.max()))
        what = f"{label}, {POSES} poses on a straight line of {LENGTH} m, no q0"
        jumps = float(np.abs(np.diff(ik(fast, T).q, axis=0)).max())
        figures += [
            Figure(f"{what}: largest joint step", found.largest_step, STEP, "rad",
                   note=f"{len(found.branch_switches)} changes of branch; the same poses solved alone: "
                        f"{short(jumps)} rad",
                   holds=found.largest_step <= STEP and not found.branch_switches),
            Figure(f"{what}: largest error of a pose", worst, TOLERANCE, "m, rad",
                   holds=bool(true.solved.all()), note=f"{int(true.solved.sum())} of {POSES} poses, within the limits"),
            _figure(f"{what}: time ÷ {POSES} solutions of ik in a batch", free, alone, TIMES),
            _figure(f"{label}, the same from a given q0: time ÷ {POSES} solutions of ik", given, alone, None),
        ]  # fmt: skip
        rows += [
            (label, t.name, *(1e6 * x / POSES for x in (t.time.median, t.time.lower, t.time.upper)), step, t.error)
            for t, step in ((free, found.largest_step), (given, started.largest_step), (alone, jumps))
        ]  # fmt: skip
        ends += [
            (label, end, *(short(float(x)) for x in T[k, :3, 3]))
            for k, end in ((0, "first"), (-1, "last"))
        ]
        say(
            f"{label}: largest step {short(found.largest_step)}, × {short(figures[-2].value or 0.0)}"
        )
    return Topic(
        "A path followed without a jump",
        "follow solves each pose from the joints of the one before it; without a q0 it takes, of eight starting "
        "branches, the one whose largest step is smallest. The poses solved alone, in one batch of ik, jump between "
        "the branches. All within the limits, to 1e-9 m and 1e-9 rad; the error is the largest true one by fk (m or "
        "rad). Cases run in turn, each on one thread; time is the processor's.",
        figures=figures,
        tables=[
            Table("Time and steps", ("arm", "what", "time (µs a pose)", "lower quartile", "upper quartile",
                                     "largest step (rad)", "error (m, rad)"), rows),
            Table("Where the paths begin and end, in the base; the rotation stays",
                  ("arm", "end", "x (m)", "y (m)", "z (m)"), ends, folded=True),
        ],
    )  # fmt: skip


def path(chain: Chain, middle: np.ndarray) -> np.ndarray:
    """The poses of a straight path along y about the pose of the joints in the middle."""
    T_s0 = chain.fk(middle)
    T_s1 = T_s0.copy()
    T_s0[1, 3] -= LENGTH / 2
    T_s1[1, 3] += LENGTH / 2
    return motion.line(T_s0, T_s1, np.linspace(0, 1, POSES))


def _measured(fast: CompiledChain, T: np.ndarray, quick: bool) -> list[Timed]:
    q0 = follow(fast, T).q[0]

    def error(state: Any, result: Any) -> float:
        true = judged(fast.chain, T, result.q, result.success)
        return float(max(true.position.max(), true.rotation.max()))

    cases = [
        Case("follow", lambda: T, lambda T: follow(fast, T), error),
        Case("follow, q0 given", lambda: T, lambda T: follow(fast, T, q0=q0), error),
        Case("ik, all poses in a batch", lambda: T, lambda T: ik(fast, T), error),
    ]
    return in_turn(cases, rounds=5 if quick else 31)


def _figure(what: str, own: Timed, other: Timed, bar: float | None) -> Figure:
    found = ratio(own, other)
    return Figure(
        what, found.median, bar, spread=(found.lower, found.upper), error=short(own.error)
    )
