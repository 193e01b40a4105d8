"""Inverse kinematics: how many reachable poses are solved, how fast, and whether the reasons given
are right.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from poekin import Chain, load
from poekin.solve.ik.ik import ik
from poekin.solve.ik.solution import LIMITS, UNREACHABLE

from ..draw import bars
from ..harness import Case, Timed, in_turn, ratio
from ..report import Figure, Picture, Table, Topic, short
from . import inverse_kinematics_list as named_list
from . import inverse_kinematics_peers as peers
from . import inverse_kinematics_reasons as reasons
from .inverse_kinematics_arms import LEFT_OUT
from .inverse_kinematics_judge import Judgement, judged, share
from .inverse_kinematics_rows import Row, Solve, peer_row

Say = Callable[[str], None]
Line = list[str | int | float]

TARGETS, LIST_TARGETS, CALLS, WITHOUT = 10_000, 5000, 2000, 2000
ONE_CALL, RIGHT = 3.6, 99.0  # a ratio; percent

MAIN = (("Panda", "erd:panda", "panda_hand", 99.97, 1 / 5), ("UR5", "ur5", "tool", 99.99, 1 / 4))
TIGHT = (("UR5", "ur5", 0.25), ("Puma 560", "puma560", 0.6))
"""Parts of the limits that are left: ±90° of a UR5, and a Puma's range shorter by two fifths."""


def topic(quick: bool, say: Say, solve: Solve = ik) -> Topic:
    """The page; solve is what is judged: `ik`, or what a test plants in its place."""
    less = 20 if quick else 1
    figures: list[Figure] = []
    lines: list[Line] = []
    lies = 0
    for name, source, tip, bar, most in MAIN:
        chain = load(source).chain(tip=tip)
        T = chain.fk(chain.random(np.random.default_rng(0), TARGETS // less))
        judgement = _judge(chain, T, solve(chain, T))
        lies += judgement.false_claims
        figures += [_solved(name, judgement, bar)]
        figure, pair = _beside(name, chain, T, judgement, most, 1 if quick else 3, solve)
        figures += [figure, _one_call(name, chain, T[:CALLS], 3 if quick else 9, solve)]
        lines += [*pair, *_others(name, chain, T)]
        say(f"{name}: {len(T)} targets")
    rows = named_list.measured(LIST_TARGETS // less, quick, say, solve)
    figures += named_list.figures(rows)
    lies += sum(
        judgement.false_claims for _, row in rows if (judgement := row[named_list.OWN].judgement)
    )
    figures += _without_solution(WITHOUT // less, solve)
    say("targets that have no solution")
    figures.append(
        Figure("inverse kinematics, all reachable targets of this page: success claimed that the true pose error or "
               "the limits do not bear out", lies, 0)
    )  # fmt: skip
    notes = [
        " ".join(note.split()) for note in [LEFT_OUT, *(peers.__doc__ or "").split("\n- ")[1:]]
    ]
    return Topic(
        "Inverse kinematics",
        "Targets are T = f(q) with q uniform within the limits, and over one turn where a joint has none. "
        "poekin begins near the middle of the limits, all other starts are random; limits are on. Solved means: "
        "success is claimed, the pose of q by `fk` is within 1e-9 m and 1e-9 rad of the target, and q is within the "
        "limits. All of that is computed anew from q: nothing is taken from what a solver says about itself. Time is "
        "the processor's, a target. poekin solves a batch in one call; Robotics "
        "Toolbox and EAIK are compiled and called for each target from Python; Pinocchio's loop is its example's, "
        "in Python. The UR5 is the catalogue's: all joints within ±2π. The Panda has the limits of its URDF.",
        figures=figures,
        pictures=[_picture(lines)],
        tables=[
            Table("Panda and UR5 by every library, limits on",
                  ("arm", "solver", "targets", "time (µs a target)", "success claimed (%)", "to 1e-9 in truth (%)",
                   "and within the limits (%)", "largest error of what is claimed (m)", "(rad)"), lines),
            named_list.table(rows),
            Table("What the list leaves out, and how the peers are called", ("note",), [[note] for note in notes],
                  folded=True),
        ],
    )  # fmt: skip


def _judge(chain: Chain, T: np.ndarray, solution: Any) -> Judgement:
    return judged(chain, T, solution.q, solution.success)


def _solved(name: str, judgement: Judgement, bar: float) -> Figure:
    count, solved = len(judgement.solved), share(judgement.solved)
    return Figure(
        f"inverse kinematics, {name}, {count} reachable targets, limits on: solved to 1e-9 m and 1e-9 rad", solved,
        shown=f"{solved:.2f} %", bar_shown=f"≥ {bar} %", holds=solved >= bar, error=judgement.said,
    )  # fmt: skip


def _own(chain: Chain, T: np.ndarray, solve: Solve) -> Case:
    return Case(
        "poekin", lambda: T, lambda T: solve(chain, T), lambda T, s: _judge(chain, T, s).worst[0]
    )


def _beside(name: str, chain: Chain, T: np.ndarray, judgement: Judgement, most: float, rounds: int,
            solve: Solve) -> tuple[Figure, list[Line]]:  # fmt: skip
    """Time beside Robotics Toolbox' C solver as it comes, in turn, on the same targets."""
    what = f"inverse kinematics, {name}: time of {len(T)} targets ÷ Robotics Toolbox' C solver, its default tolerance"
    solver, problem = peers.ready("robotics_toolbox", partial(peers.robotics_toolbox, chain))
    if solver is None:
        (own,) = in_turn([_own(chain, T, solve)], rounds=rounds)
        return Figure(what, None, most, note=problem), [_line(name, "poekin", _row(own, judgement))]
    kept: list[Judgement] = []

    def error(_: Any, found: Any) -> float:
        kept.append(judged(chain, T, *solver.joints(found, T)))
        return kept[0].worst[0]

    own, theirs = in_turn(
        [
            _own(chain, T, solve),
            Case("Robotics Toolbox", lambda: solver.native(T), solver.run, error),
        ],
        rounds=rounds,
    )
    between = ratio(own, theirs)
    figure = Figure(
        what, between.median, most, spread=(between.lower, between.upper),
        error=f"{judgement.said}; Robotics Toolbox {kept[0].said}",
        note=f"{_us(own, T)} ÷ {_us(theirs, T)} µs a target; Robotics Toolbox claims {share(kept[0].claimed):.2f} % "
        f"and solves {share(kept[0].solved):.2f} % to 1e-9",
    )  # fmt: skip
    return figure, [
        _line(name, "poekin", _row(own, judgement)),
        _line(name, "Robotics Toolbox, E = 1e-6 (default)", _row(theirs, kept[0])),
    ]


def _one_call(name: str, chain: Chain, T: np.ndarray, rounds: int, solve: Solve) -> Figure:
    """The same targets, one after the other and all at once."""
    each = list(T)
    calls = Case(
        "calls", lambda: each, lambda each: [solve(chain, one) for one in each],
        lambda _, found: max((float(s.position_error) for s in found if s.success), default=float("nan")),
    )  # fmt: skip
    single, batch = in_turn([calls, _own(chain, T, solve)], rounds=rounds)
    between = ratio(single, batch)
    return Figure(
        f"inverse kinematics, {name}: one call from Python ÷ the batch's time a pose", between.median, ONE_CALL,
        spread=(between.lower, between.upper), error=f"{single.error:.1e} m; batch {batch.error:.1e} m",
        note=f"{_us(single, T)} ÷ {_us(batch, T)} µs, the same {len(T)} targets",
    )  # fmt: skip


def _others(name: str, chain: Chain, T: np.ndarray) -> list[Line]:
    """The peers at equal tolerance, and Pinocchio's loop as documented; slow ones on fewer targets."""
    few, fewest = T[: max(len(T) // 10, 20)], T[: max(len(T) // 100, 5)]
    ways = [
        ("Robotics Toolbox, E = 5e-19 (equal tolerance)", "robotics_toolbox", few,
         partial(peers.robotics_toolbox, chain, tol=peers.EQUAL_E)),
        ("Pinocchio's loop, eps = 1e-4 (as documented)", "pinocchio", fewest, partial(peers.pinocchio_clik, chain)),
        ("Pinocchio's loop, eps = 1e-9 (equal tolerance)", "pinocchio", fewest,
         partial(peers.pinocchio_clik, chain, eps=1e-9)),
        ("EAIK, all solutions", "eaik", few, lambda: peers.ClosedForm(chain).solver()),
    ]  # fmt: skip
    return [
        _line(name, label, peer_row(peer, make, chain, targets))
        for label, peer, targets, make in ways
    ]


def _without_solution(count: int, solve: Solve) -> list[Figure]:
    """Success claimed, and the reason right, where there is no solution."""
    rng = np.random.default_rng(1)
    beyond, wrong, silent = [], 0, 0
    for _, source, tip, *_rest in MAIN:
        chain = load(source).chain(tip=tip)
        T = reasons.beyond_reach(chain, rng, count // 2)
        solution = solve(chain, T)
        beyond.append(solution.reason == UNREACHABLE)
        wrong += int(solution.success.sum())
        silent += int((~(solution.distance_beyond_reach > 0)).sum())
    figures = _pair(
        f"{count} targets beyond the reach bound of Panda and UR5", wrong, np.concatenate(beyond), UNREACHABLE,
        f"{silent} of them without the distance beyond the reach",
    )  # fmt: skip
    for name, source, part in TIGHT:
        what = f"{count // 2} {name} poses none of whose EAIK solutions is within {100 * part:g} % of the limits"
        chain = reasons.tightened(load(source).chain(), part)
        found, problem = peers.ready(
            "eaik", lambda chain=chain: reasons.blocked_poses(chain, rng, count // 2)
        )
        if found is None:
            figures += [
                Figure(f"inverse kinematics, {what}", None, note=f"left out: EAIK is {problem}")
            ]
            continue
        T, passed = found
        solution = solve(chain, T)
        true = int(_judge(chain, T, solution).solved.sum())
        figures += _pair(
            what, int(solution.success.sum()), solution.reason == LIMITS, LIMITS,
            f"passed over, as EAIK missed the configuration that they were made of: {passed}; claims that `fk` bears "
            f"out: {true}",
        )  # fmt: skip
    return figures


def _pair(what: str, claimed: int, right: np.ndarray, reason: str, note: str) -> list[Figure]:
    part = share(right)
    return [
        Figure(f"inverse kinematics, {what}: success claimed", claimed, 0, note=note),
        Figure(f"inverse kinematics, {what}: the reason is {reason!r}", part, shown=f"{part:.2f} %",
               bar_shown=f"≥ {RIGHT:g} %", holds=part >= RIGHT),
    ]  # fmt: skip


def _picture(lines: list[Line]) -> Picture:
    """Time of a target by each solver, of both arms."""
    times: dict[str, dict[str, float | None]] = {}
    for name, label, count, time, *_ in lines:
        times.setdefault(str(label), {})[str(name)] = float(time) if count else None
    drawn = bars(
        "Time of a target, limits on (µs, logarithmic; shorter is faster); how near each comes stands in the table",
        times, x_label="time (µs a target)",
    )  # fmt: skip
    return drawn.answering("solve")


def _us(timed: Timed, T: np.ndarray) -> str:
    return short(1e6 * timed.time.median / len(T))


def _row(timed: Timed, judgement: Judgement) -> Row:
    return Row(len(judgement.claimed), timed.time.median, judgement)


def _line(name: str, label: str, row: Row) -> Line:
    j = row.judgement
    if j is None:
        return [name, label, "", row.problem, "", "", "", "", ""]
    return [
        name,
        label,
        row.count,
        row.us,
        share(j.claimed),
        share(j.claimed & j.within),
        share(j.solved),
        *j.worst,
    ]
