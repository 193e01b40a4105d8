"""Tasks: the part of a target's pose that the tool has to reach."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...engine.kernels import ik_codes as codes
from ...errors import InputError, PoseError, safe_repr
from ...groups.arrays import Array, poses, shaped
from ...model.chain import Chain

TASKS = {
    "pose": (codes.POSE, 6),
    "position": (codes.POSITION, 3),
    "rotation": (codes.ROTATION, 3),
    "direction": (codes.DIRECTION, 5),
}
"""Each task's code, and how many degrees of freedom it constrains: a chain needs at least as many
free coordinates.
"""


@dataclass(frozen=True, eq=False)
class Task:
    """Part of a pose to be reached.

    name, one of `TASKS`; axis (3,), the unit direction in the tool frame that the task "direction"
    aligns; weights (6,) of the error's parts (rotation; position), the largest 1, 0 for those that the task
    leaves free.
    """

    name: str
    axis: Array
    weights: Array

    @property
    def code(self) -> int:
        """Code by which the kernel knows the task."""
        return TASKS[self.name][0]

    @property
    def constrained_dof(self) -> int:
        """Number of degrees of freedom that the task constrains."""
        return TASKS[self.name][1]

    def jacobian(self, T: Array, J: Array) -> Array:
        """Hybrid Jacobians J (..., 6, m) at poses T (..., 4, 4), of a direction without the turn
        about it.
        """
        if self.name != "direction":
            return J
        a = T[..., :3, :3] @ self.axis
        turns = J[..., :3, :] - a[..., :, None] * (a[..., None, :] @ J[..., :3, :])
        return np.concatenate([turns, J[..., 3:, :]], axis=-2)


def targets(T: ArrayLike, what: str) -> Array:
    """Poses (..., 4, 4); what is infinite is no error, but NaN. Raises: PoseError, ShapeError,
    InputError.
    """
    try:
        return poses(T, what)
    except PoseError:
        rows = shaped(T, (4, 4), what).copy()
        rows[~np.isfinite(rows).all(axis=(-2, -1))] = np.nan
        return poses(rows, what)


def make_task(name: Any, axis: Any, weights: Any) -> Task:
    """Task by the name that a user gives. Raises: InputError."""
    if not isinstance(name, str) or name not in TASKS:
        raise InputError(f"task: expected one of {', '.join(TASKS)}, got {safe_repr(name)}")
    if axis is not None and name != "direction":
        raise InputError(f"axis: only the task 'direction' has one, the task is {name!r}")
    a = shaped([0.0, 0.0, 1.0] if axis is None else axis, (3,), "axis")
    if a.ndim != 1 or not np.isfinite(a).all() or not a.any():
        raise InputError(f"axis: expected a direction (3,) that is not zero, got {safe_repr(axis)}")
    a = a / np.abs(a).max()  # so that no square of it overflows
    w = shaped(np.ones(6) if weights is None else weights, (6,), "weights").copy()
    if w.ndim != 1 or not np.isfinite(w).all() or (w <= 0).any():
        raise InputError(
            f"weights: expected six positive numbers (rotation; position), got {safe_repr(weights)}"
        )
    if name == "position":
        w[:3] = 0.0
    if name == "rotation":
        w[3:] = 0.0
    return Task(name, a / np.linalg.norm(a), w / w.max())


def check_joints(chain: Chain, task: Task, free: int) -> None:
    """Raises InputError where a chain has too few coordinates for a task; says which tasks fit."""
    needed = task.constrained_dof
    if free >= needed:
        return
    locked = f", {chain.dof - free} of them locked" if free < chain.dof else ""
    fit = [name for name, (_, number) in TASKS.items() if number <= free]
    others = f"; what fits: {', '.join(map(repr, fit))}" if fit else ""
    raise InputError(
        f"task {task.name!r} constrains {needed} degrees of freedom, and the chain has "
        f"{chain.dof} coordinates{locked}{others}"
    )
