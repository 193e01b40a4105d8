"""Null-space optimisation of an arm with joints to spare: steps in the null space of its task, each
followed by a new solve.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from ....checks import choice
from ....engine.kernels import ik_codes as codes
from ....errors import InputError
from ....groups.arrays import Array
from ..ik_problem import Problem

Objective = Literal["middle", "nearest", "manipulability"]
OBJECTIVES: tuple[Objective, ...] = get_args(Objective)
STEPS = 25
STEP = 0.5  # of the way that the objective asks for
# rad or m, for the gradient of the manipulability: its error is far below what a step needs
DIFFERENCE = 1e-6


def check_objective(objective: Any, q0: Any) -> None:
    """Raises InputError for what is no objective, and for "nearest" to nothing."""
    if objective is not None:
        choice(objective, OBJECTIVES, "secondary_objective")
    if objective == "nearest" and q0 is None:
        raise InputError("secondary_objective: 'nearest' needs q0, what to be near to")


def optimise(problem: Problem, targets: Array, q: Array, q0: Array, objective: Objective) -> Array:
    """Solutions with a better value of the objective, of targets that are solved already."""
    known = ~np.isnan(q).any(axis=1)
    if not known.all():  # of a bad target nothing is known
        best = q.copy()
        best[known] = optimise(problem, targets[known], q[known], q0[known], objective)
        return best
    q0 = np.where(np.isnan(q0), q, q0)
    best = q.copy()
    value = _value(problem, q, q0, objective)
    step = np.full(len(q), STEP)
    indices = np.arange(len(q), dtype=float)
    for _ in range(STEPS):
        tried = _moved(problem, best, q0, objective, step)
        found, info = problem.solve(targets, indices, tried, restarts=0)
        new = _value(problem, found, q0, objective)
        better = (info[:, codes.AT_STATE] == codes.SOLVED) & (new < value)
        best[better] = found[better]
        value[better] = new[better]
        step = np.where(better, step, 0.5 * step)
    return best


def _value(problem: Problem, q: Array, q0: Array, objective: Objective) -> Array:
    """Value that the objective makes small: the manipulability is that of the task, by the
    coordinates that may move, in as many motions as they have at all.
    """
    if objective == "manipulability":
        sizes = np.linalg.svd(_jacobian(problem, q), compute_uv=False)[:, : problem.generic_rank]
        with np.errstate(divide="ignore"):
            return -np.log(sizes).sum(axis=1)
    off = q - _goal(problem, q0, objective)
    return (off**2 * _weights(problem, objective)).sum(axis=1)


def _moved(problem: Problem, q: Array, q0: Array, objective: Objective, step: Array) -> Array:
    """Configurations one step downhill in the null space of the task's Jacobian."""
    if objective == "manipulability":
        z = _gradient(problem, q, q0, objective)
        z /= np.maximum(np.linalg.norm(z, axis=1, keepdims=True), 1.0)
    else:
        z = (_goal(problem, q0, objective) - q) * _weights(problem, objective)
    J = _jacobian(problem, q)
    within_task = (np.linalg.pinv(J) @ (J @ z[..., None]))[..., 0]
    moved = q + step[:, None] * (z - within_task)
    return np.where(problem.domain.locked, q, np.clip(moved, *problem.domain.limits.T))


def _gradient(problem: Problem, q: Array, q0: Array, objective: Objective) -> Array:
    """Downhill gradient of the objective by central differences; 0 at a singularity, where no
    direction is better.
    """
    z = np.empty_like(q)
    for k, h in enumerate(DIFFERENCE * np.eye(q.shape[1])):
        with np.errstate(invalid="ignore"):  # infinite less infinite
            less = _value(problem, q - h, q0, objective)
            z[:, k] = less - _value(problem, q + h, q0, objective)
    return np.where(np.isfinite(z), z, 0.0) * (0.5 / DIFFERENCE)


def _jacobian(problem: Problem, q: Array) -> Array:
    """Jacobian of what the task constrains; a locked coordinate moves nothing."""
    T, J = problem.fast.fk_jacobian(q, "hybrid")
    rows = problem.task.jacobian(T, J)[:, problem.task.weights > 0]
    return np.where(problem.domain.locked, 0.0, rows)


def _goal(problem: Problem, q0: Array, objective: Objective) -> Array:
    if objective == "nearest":
        return q0
    limited = _limited(problem)
    bounds = np.where(limited[:, None], problem.domain.limits, 0.0)
    return np.where(limited, bounds.mean(axis=1), q0)


def _weights(problem: Problem, objective: Objective) -> Array:
    limited = _limited(problem)
    return np.ones(len(limited)) if objective == "nearest" else limited.astype(float)


def _limited(problem: Problem) -> np.ndarray:
    """Whether a coordinate has both limits (m,)."""
    return np.asarray(np.isfinite(problem.domain.limits).all(axis=1))
