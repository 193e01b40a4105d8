"""Every solution of targets, in closed form or by elimination, beside given configurations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms
from ...chain_cache import ChainCache
from ...ik_all.ik_all import ik_all
from ...ik_all.sources import solvers_for
from ..ik_problem import IKProblem


class EverySolution(NamedTuple):
    """Solutions of N targets: u (S, m) within the limits, in joint units, and the target (S,) of
    each; those of a target together, the nearest first. complete (N,), whether they are surely all.
    """

    u: Array
    owner: np.ndarray
    complete: np.ndarray


_SOLVED: ChainCache[bool] = ChainCache()


def every_solution(problem: IKProblem, targets: Array, near: Array) -> EverySolution | None:
    """Every solution of targets (N, 4, 4), whole turns away as near to configurations (N, m) as the
    limits allow; None where the task is not the pose, or only a search finds them all.
    """
    if problem.task.name != "pose":
        return None
    lock = problem.settings.lock
    solved = _SOLVED.get(problem.fast, lock)
    if solved is None:
        solved = _SOLVED.keep(problem.fast, _is_solved(problem), lock)
    if not solved:
        return None
    found = ik_all(
        problem.given,
        targets,
        limits=problem.settings.limits,
        lock=None if lock is None else dict(lock),
        seed=problem.settings.seed,
        parallel=problem.settings.parallel,
    )
    owner = found.target_number
    u = problem.domain.wrapped(problem.units.of(found.q), near[owner])
    away = norms(u - near[owner])
    order = np.lexsort((away, owner))
    order = order[problem.contains(u)[order]]
    return EverySolution(u[order], owner[order], np.asarray(found.complete))


def _is_solved(problem: IKProblem) -> bool:
    """Whether an arm of up to six coordinates has a closed form or is solved by elimination."""
    values = problem.domain.locked_values[None]
    free = ~problem.domain.locked
    return bool(solvers_for(problem.fast.chain, values, free, "auto"))
