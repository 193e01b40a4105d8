"""The named list of arms: each solved by poekin and, where they can, by the peers at the same true
tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from ..report import Figure, Table
from . import inverse_kinematics_peers as peers
from .inverse_kinematics_arms import NamedArm, named_arms
from .inverse_kinematics_judge import TOLERANCE, share
from .inverse_kinematics_rows import Row, Solve, peer_row, poekin_row

OVER_ALL, EACH = 99.9, 99.5  # percent
TOOL_Z = np.array([0.0, 0.0, 1.0])
OWN, RTB, PIN, EAIK = "poekin", "Robotics Toolbox", "Pinocchio's loop", "EAIK"
PEERS = (RTB, PIN, EAIK)
FEW = {RTB: 200, PIN: 10, EAIK: 200}

Measured = Sequence[tuple[NamedArm, Mapping[str, Row]]]


def measured(count: int, quick: bool, say: Callable[[str], None], solve: Solve) -> Measured:
    """Every arm of the list by every library; the peers on the first few of the same targets."""
    found = []
    for number, arm in enumerate(named_arms(), 1):
        chain = arm.chain
        T = chain.fk(chain.random(np.random.default_rng(number), count))
        axis = None if arm.task == "pose" else TOOL_Z
        rows = {OWN: poekin_row(chain, T, solve, arm.task, axis)}
        for name in PEERS:
            few = T[: max(FEW[name] // (5 if quick else 1), 2)]
            rows[name] = Row(problem="has no such task")
            if axis is None:
                rows[name] = peer_row(*_ways(arm)[name], chain, few)
        found.append((arm, rows))
        if number % 10 == 0:
            say(f"{number} arms of the list")
    return found


def _ways(arm: NamedArm) -> dict[str, tuple[str, Callable[[], peers.Solver]]]:
    chain = arm.chain
    return {
        RTB: ("robotics_toolbox", partial(peers.robotics_toolbox, chain, tol=peers.EQUAL_E)),
        PIN: ("pinocchio", partial(peers.pinocchio_clik, chain, eps=TOLERANCE)),
        EAIK: ("eaik", lambda: peers.ClosedForm(chain).solver()),
    }


def figures(rows: Measured) -> list[Figure]:
    """Solved over all, and of the arm with the fewest."""
    own = [(arm.name, row[OWN]) for arm, row in rows]
    judgements = [row.judgement for _, row in own if row.judgement is not None]
    over_all = 100.0 * float(np.mean(np.concatenate([j.solved for j in judgements])))
    name, worst = min(own, key=lambda pair: pair[1].solved)
    error = f"{max(j.worst[0] for j in judgements):.1e} m, {max(j.worst[1] for j in judgements):.1e} rad"
    missed = {
        name: row.count - int(row.judgement.solved.sum())
        for name, row in own
        if row.judgement is not None
    }
    which = ", ".join(f"{name} {number}" for name, number in missed.items() if number)
    what = f"inverse kinematics, {len(own)} named arms of 5 to 7 joints, {own[0][1].count} targets each, limits on:"
    return [
        Figure(f"{what} solved to 1e-9 over all", over_all, shown=f"{over_all:.3f} %", bar_shown=f"≥ {OVER_ALL} %",
               holds=over_all >= OVER_ALL, error=error, note=f"unsolved: {which or 'none'}"),
        Figure(f"{what} the arm with the fewest", worst.solved, shown=f"{worst.solved:.2f} %", bar_shown=f"≥ {EACH} %",
               holds=worst.solved >= EACH, error=error, note=name),
    ]  # fmt: skip


def table(rows: Measured) -> Table:
    """An arm a line: what each library solves to 1e-9, its time, and the largest position error of
    what it claims.
    """
    columns = ["arm", "joints", "task", *(
        f"{name}: {what}" for name in (OWN, *PEERS) for what in ("solved (%)", "µs", "largest error (m)")
    )]  # fmt: skip
    lines = []
    for arm, row in rows:
        line: list[str | int | float] = [arm.name, arm.chain.dof, arm.task]
        for name in (OWN, *PEERS):
            one = row[name]
            if one.judgement is None:
                line += [one.problem, "", ""]
            else:
                right = (
                    share(one.judgement.claimed & one.judgement.within)
                    if name == PIN
                    else one.solved
                )
                line += [right, one.us, one.judgement.worst[0]]
        lines.append(line)
    return Table(
        "The named list, limits on, every library asked for 1e-9. Robotics Toolbox: E = 5e-19, the first "
        f"{FEW[RTB]} targets; Pinocchio: eps = 1e-9, the first {FEW[PIN]}, its limits are not looked at; EAIK: all "
        f"solutions, the first {FEW[EAIK]}, solved where one is within the limits (a fifth of them with --quick)",
        columns, lines,
    )  # fmt: skip
