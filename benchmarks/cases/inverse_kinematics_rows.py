"""One library on the targets of one arm: its time, and what its joints are worth."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from poekin import Chain

from ..peers import attempt
from . import inverse_kinematics_peers as peers
from .inverse_kinematics_judge import Judgement, judged, share

Solve = Callable[..., Any]


@dataclass(frozen=True)
class Row:
    """Targets, seconds of all of them, and the judgement; problem says why there is none."""

    count: int = 0
    seconds: float = 0.0
    judgement: Judgement | None = None
    problem: str = ""

    @property
    def us(self) -> float:
        """Time of a target (µs)."""
        return 1e6 * self.seconds / max(self.count, 1)

    @property
    def solved(self) -> float:
        """Share that is solved in truth (%)."""
        return 0.0 if self.judgement is None else share(self.judgement.solved)


def poekin_row(
    chain: Chain, T: np.ndarray, solve: Solve, task: str = "pose", axis: np.ndarray | None = None
) -> Row:
    """poekin's batch, compiled before."""
    solve(chain, T[:1], task=task)
    start = time.process_time()
    solution = solve(chain, T, task=task)
    seconds = time.process_time() - start
    return Row(len(T), seconds, judged(chain, T, solution.q, solution.success, axis=axis))


def peer_row(peer: str, make: Callable[[], peers.Solver], chain: Chain, T: np.ndarray) -> Row:
    """A peer, once over the targets after a first one; what it cannot do is said."""
    solver, problem = peers.ready(peer, make)
    if solver is None:
        return Row(problem=problem)
    row, problem = attempt(lambda: _timed(solver, chain, T))
    return row if not problem else Row(problem=problem)


def _timed(solver: peers.Solver, chain: Chain, T: np.ndarray) -> Row:
    targets = solver.native(T)
    solver.run(targets[:1])
    start = time.process_time()
    found = solver.run(targets)
    seconds = time.process_time() - start
    return Row(len(T), seconds, judged(chain, T, *solver.joints(found, T)))
