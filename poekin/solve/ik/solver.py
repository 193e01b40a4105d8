"""Solutions of a batch of targets: tries, the choice among them, and a reason for each failure."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...engine.kernels import ik_codes as codes
from ...groups.arrays import Array
from ...model.coordinates import coordinates
from ...results import Progress
from .choice.nearest import nearest
from .choice.redundancy import Objective, optimise
from .diagnosis import KIND, Causes, diagnose
from .ik_problem import IKProblem
from .joint_domain import first_tries, for_targets
from .solution import SOLVED, UNREACHABLE, Solution

AT_ONCE = 20_000
"""Targets between two calls of `progress`."""


def solve(
    problem: IKProblem,
    T: Array,
    q0: Any = None,
    *,
    nearest_to: Any = None,
    objective: Objective | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Solutions of targets (..., 4, 4); `nearest_to`, a configuration (m,) or (..., m)."""
    batch = T.shape[:-2]
    if not batch and nearest_to is None and objective is None and progress is None:
        found = _one(problem, T, q0)
        if found is not None:
            return found
    rows = np.ascontiguousarray(T.reshape(-1, 4, 4))
    if not (rows.flags.writeable and rows.flags.aligned):  # the kernels take no others
        rows = rows.copy()
    count = len(rows)
    if q0 is None and nearest_to is None:
        first = problem.domain.middle(count)
    else:
        first = first_tries(problem.given, problem.units, problem.domain, batch, count, q0)
    near = None
    if nearest_to is not None:
        near = for_targets(problem.given, batch, count, nearest_to, "nearest_to")
        near = problem.units.of(near)
    if count <= AT_ONCE and near is None and objective is None and progress is None:
        u, info = problem.solve(rows, np.arange(count, dtype=float), first)
    else:
        u, info = _in_parts(problem, rows, first, near, objective, progress)
    if near is None and objective != "nearest":
        u = problem.domain.principal(u)
    q = problem.coordinates(u)
    errors, success = problem.pose_errors(rows, q)
    causes = Causes(np.full(count, SOLVED, dtype=KIND), np.zeros(count))
    if not success.all():
        causes = diagnose(problem, rows, first, u, info, success)
        q = problem.coordinates(u)
        errors, success = problem.pose_errors(rows, q)
        # by a rounding, where the tolerance is no larger
        causes.reason[(causes.reason == SOLVED) & ~success] = UNREACHABLE
    return Solution(
        q=q.reshape(*batch, problem.fast.dof),
        success=success.reshape(batch),
        reason=causes.reason.reshape(batch),
        position_error=errors[:, 0].reshape(batch),
        rotation_error=errors[:, 1].reshape(batch),
        iterations=info[:, codes.AT_ITERATIONS].astype(np.int64).reshape(batch),
        restarts=info[:, codes.AT_RESTARTS].astype(np.int64).reshape(batch),
        distance_beyond_reach=causes.distance_beyond_reach.reshape(batch),
        limits_hit=causes.limits_hit,
        reachable_tasks=causes.reachable_tasks,
        chain=problem.given,
        target=T,
    )


def _one(problem: IKProblem, T: Array, q0: Any) -> Solution | None:
    """Solution of one target that the first try reaches, without all that many targets need."""
    start = problem.domain.beside_middle
    if q0 is not None:
        start = coordinates(q0, problem.given.q_names, "q0")
        if start.shape != problem.domain.locked_values.shape:
            return None
        start = problem.domain.held(start)
    found = problem.solve_one(T, start)
    if found is None:
        return None
    q, info = found
    return Solution(
        q=q,
        success=np.array(True),
        reason=np.array(SOLVED, KIND),
        position_error=np.array(info[codes.AT_POSITION]),
        rotation_error=np.array(info[codes.AT_ROTATION]),
        iterations=np.array(int(info[codes.AT_ITERATIONS])),
        restarts=np.array(0),
        distance_beyond_reach=np.array(0.0),
        chain=problem.given,
        target=T,
    )


def _in_parts(
    problem: IKProblem,
    rows: Array,
    first: Array,
    near: Array | None,
    objective: Objective | None,
    progress: Progress | None,
) -> tuple[Array, Array]:
    """q and info of many targets, some at a time, each with all that is asked of it."""
    count = len(rows)
    indices = np.arange(count, dtype=float)
    q = np.empty((count, problem.fast.dof))
    info = np.empty((count, codes.INFO))
    for start in range(0, count, AT_ONCE):
        part = slice(start, min(start + AT_ONCE, count))
        asked = (rows[part], indices[part], first[part])
        if near is None:
            q[part], info[part] = problem.solve(*asked)
        else:
            q[part], info[part] = nearest(problem, *asked, near[part])
        if objective is not None:
            q[part] = optimise(problem, rows[part], q[part], first[part], objective)
        if progress is not None:
            progress(part.stop, count)
    return q, info
