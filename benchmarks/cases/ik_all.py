"""Every solution of a pose: the search alone against EAIK's closed form, and how near all are to
their targets.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.ik_all.all_solutions import AllSolutions
from poekin.solve.ik_all.ik_all import ik_all

from ..report import Figure, Table, Topic, short

ARMS = {"ur5": "UR5", "puma560": "Puma 560"}
SEED, COUNT = 5, 1000

# Two solvers' ends of one solution: poses 1e-10 off make 1e-4 rad where the arm is singular within
# 1e-6.
SAME = 1e-4
# EAIK's own solutions are nearer to their target than this [m and rad], its least squares ones are
# not.
ITS_OWN = 1e-6


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


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The largest difference of angles between each configuration of a and each of b, by the
    shorter way round.
    """
    return np.abs((a[:, None] - b[None] + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)


def equal(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether each configuration of a is one of b, each of b one of a, and there are as many of
    them.
    """
    if not len(a) or len(a) != len(b):
        return len(a) == len(b)
    near = apart(a, b) <= SAME
    return bool(near.any(axis=0).all() and near.any(axis=1).all())


def eaik_sets(chain: Chain, T: np.ndarray) -> tuple[list[np.ndarray], float]:
    """EAIK's solutions of each target, each once, and its own time (processor seconds) for all of
    them.
    """
    from eaik.IK_HP import HPRobot

    form = chain.to_hp()
    robot = HPRobot(form.H, form.P)
    targets = T.copy()
    targets[:, :3, :3] = T[:, :3, :3] @ form.R_nt.T
    start = time.process_time()
    answers = [robot.IK(target) for target in targets]
    seconds = time.process_time() - start
    sets = []
    for answer, target in zip(answers, T, strict=True):
        Q = np.asarray(answer.Q, float).reshape(-1, chain.dof)
        Q = Q[np.abs(chain.fk(Q) - target).max(axis=(1, 2)) <= ITS_OWN]
        sets.append(Q[[not (apart(Q[:k], Q[k : k + 1]) <= SAME).any() for k in range(len(Q))]])
    return sets, seconds


def errors(chain: Chain, result: AllSolutions, T: np.ndarray) -> tuple[float, float]:
    """The largest distance (m) and angle (rad) between solutions' poses, by `fk`, and their
    targets.
    """
    Q = result.q
    ours, wanted = chain.fk(Q), np.repeat(T, result.counts, axis=0)
    turn = pk.so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ wanted[:, :3, :3])
    return (
        float(np.linalg.norm((ours - wanted)[:, :3, 3], axis=1).max()),
        float(np.linalg.norm(turn, axis=1).max()),
    )


def judged(name: str, count: int) -> Judged:
    """One arm at targets of configurations drawn from one turn of every joint."""
    chain = pk.load(name).chain()
    T = chain.fk(np.random.default_rng(SEED).uniform(-np.pi, np.pi, (count, chain.dof)))
    theirs, seconds = eaik_sets(chain, T)
    times, results = {"EAIK alone": seconds / count}, {}
    for method in ("search", "closed"):
        ik_all(chain, T[:1], method=method, limits=False)
        start = time.process_time()
        results[method] = ik_all(chain, T, method=method, limits=False)
        times[method] = (time.process_time() - start) / count
    worst = [errors(chain, result, T) for result in results.values()]
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
        numbers | {"EAIK alone": sum(map(len, theirs))},
    )


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    count = 100 if quick else COUNT
    title = "Every solution of a pose"
    try:
        import eaik  # noqa: F401
    except ImportError:
        missing = Figure(
            "search alone against EAIK's solution sets",
            None,
            note="EAIK is not installed",
            holds=False,
        )
        return Topic(title, "EAIK is the judge of this topic.", figures=[missing], tables=[])
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
            )
        ],
    )
