"""Null-space optimisation of an arm with joints to spare: steps in the null space of its task, each
followed by a new solve.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from ....checks import choice
from ....engine.kernels import ik_codes as codes
from ....errors import InputError
from ....groups.arrays import Array
from ..ik_problem import IKProblem

Objective = Literal["middle", "nearest", "manipulability"]
STEPS = 25
STEP = 0.5  # of the way that the objective asks for, at first
LENGTH = 0.5  # rad or m, of a step along the gradient of the manipulability
# rad or m, for the gradient of the manipulability: its error is far below what a step needs
DIFFERENCE = 1e-6


def check_objective(objective: Any, q0: Any) -> None:
    """Raises InputError for what is no objective, and for "nearest" to nothing."""
    if objective is not None:
        choice(objective, get_args(Objective), "secondary_objective")
    if objective == "nearest" and q0 is None:
        raise InputError("secondary_objective: 'nearest' needs q0, what to be near to")


def optimise(
    problem: IKProblem,
    targets: Array,
    q: Array,
    q0: Array,
    objective: Objective,
) -> Array:
    """Solutions with a better value of the objective, of targets that are solved already."""
    best = q.copy()
    known = ~np.isnan(q).any(axis=1)  # of a bad target nothing is known
    start = q[known]
    near = q0[known]
    near = np.where(np.isnan(near), start, near)
    if objective == "nearest":
        start = problem.domain.wrapped(start, near)
    aim = make_aim(problem, near, objective)
    best[known] = _improved(aim, targets[known], start)
    return best


def _improved(aim: Aim, targets: Array, best: Array) -> Array:
    value = aim.value(best)
    step = np.full(len(best), STEP)
    indices = np.arange(len(best), dtype=float)
    for _ in range(STEPS):
        tried = aim.moved(best, step)
        found, info = aim.problem.solve(targets, indices, tried, restarts=0)
        new = aim.value(found)
        solved = info[:, codes.AT_STATE] == codes.SOLVED
        better = solved & (new < value)
        best[better] = found[better]
        value[better] = new[better]
        step *= np.where(better, 2.0, 0.5)
    return best


class Aim(NamedTuple):
    """An objective of some configurations q (N, m): the weighted square of the distance from `goal`
    (N, m), or without a goal the manipulability.
    """

    problem: IKProblem
    goal: Array | None = None
    weights: Array | float = 1.0

    def value(self, q: Array) -> Array:
        """Value that is made small: the manipulability is that of the task, by the coordinates that
        may move, in as many motions as they have at all.
        """
        if self.goal is not None:
            squares = (q - self.goal) ** 2
            return (squares * self.weights).sum(axis=1)
        J = _jacobian(self.problem, q)
        sizes = np.linalg.svd(J, compute_uv=False)
        sizes = sizes[:, : self.problem.generic_rank]
        with np.errstate(divide="ignore"):
            return -np.log(sizes).sum(axis=1)

    def moved(self, q: Array, step: Array) -> Array:
        """Configurations one step downhill in the null space of the task's Jacobian."""
        domain = self.problem.domain
        J = _jacobian(self.problem, q)
        z = self._way(q)
        of_task = J @ z[..., None]
        within_task = np.linalg.pinv(J) @ of_task
        moves = step[:, None] * (z - within_task[..., 0])
        if self.goal is None:
            length = np.linalg.norm(moves, axis=1, keepdims=True)
            moves *= LENGTH / np.maximum(length, LENGTH)
        return domain.held(np.clip(q + moves, *domain.limits.T))

    def _way(self, q: Array) -> Array:
        """Way downhill: to the goal, or along the gradient by central differences, of size 1 at
        most; 0 at a singularity, where no direction is better.
        """
        if self.goal is not None:
            return (self.goal - q) * self.weights
        z = np.empty_like(q)
        steps = DIFFERENCE * np.eye(q.shape[1])
        for k, h in enumerate(steps):
            with np.errstate(invalid="ignore"):  # infinite less infinite
                before = self.value(q - h)
                z[:, k] = before - self.value(q + h)
        finite = np.where(np.isfinite(z), z, 0.0)
        z = finite * (0.5 / DIFFERENCE)
        size = np.linalg.norm(z, axis=1, keepdims=True)
        return z / np.maximum(size, 1.0)


def make_aim(problem: IKProblem, q0: Array, objective: Objective) -> Aim:
    """Aim of an objective; a coordinate without both limits has no middle."""
    if objective == "manipulability":
        return Aim(problem)
    if objective == "nearest":
        return Aim(problem, q0)
    limits = problem.domain.limits
    limited = np.asarray(np.isfinite(limits).all(axis=1))
    finite = np.where(limited[:, None], limits, 0.0)
    middles = finite.mean(axis=1)
    goal = np.where(limited, middles, q0)
    return Aim(problem, goal, limited.astype(float))


def _jacobian(problem: IKProblem, q: Array) -> Array:
    """Jacobian of what the task constrains; a locked coordinate moves nothing."""
    task = problem.task
    T, J = problem.fast.fk_jacobian(q, "hybrid")
    rows = task.jacobian(T, J)[:, task.weights > 0]
    return np.where(problem.domain.locked, 0.0, rows)
