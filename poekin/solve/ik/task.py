"""Tasks: the part of a target's pose that the tool has to reach."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from ...analysis.dexterity.jacobian_part import Part, largest_rank, random_configurations
from ...checks import choice
from ...engine.kernels import ik_codes as codes
from ...errors import InputError, PoseError, safe_repr
from ...formulas.inverse import pose_error
from ...groups.arrays import Array, poses, shaped
from ...groups.vectors import norm, rotation_part
from ...model.chain import Chain

TASKS: dict[str, tuple[int, int, Part]] = {
    "pose": (codes.POSE, 6, "pose"),
    "position": (codes.POSITION, 3, "translation"),
    "rotation": (codes.ROTATION, 3, "rotation"),
    "direction": (codes.DIRECTION, 5, "pose"),
    "planar": (codes.PLANAR, 3, "pose"),
}
"""Each task's code, how many degrees of freedom it constrains, and the part with its rows."""

TaskName = Literal["pose", "position", "rotation", "direction", "planar"]
TaskNames = tuple[TaskName, ...]


@dataclass(frozen=True, eq=False)
class Task:
    """Part of a pose to be reached.

    name, one of `TASKS`; axis (3,), the unit direction in the tool frame that the task "direction"
    aligns, or the unit normal in the base frame of the plane of the task "planar"; weights (6,) of
    the error's parts (rotation; position), the largest 1, 0 for those that the task leaves free.
    """

    name: TaskName
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

    @property
    def part(self) -> Part:
        """Part of the tool's motion with the rows of `jacobian` that count."""
        return TASKS[self.name][2]

    def generic_rank(self, chain: Chain, locked: Array | float = np.nan) -> int:
        """Number of degrees of freedom that an arm in joint units can serve at all: the largest
        rank of `jacobian`. `locked` (m,): values of locked coordinates, NaN for those that move.
        """
        moves = np.isnan(locked)
        q = np.where(moves, random_configurations(chain), locked)
        T, J = chain.fk_jacobian(q, "hybrid")
        J = np.where(moves, self.jacobian(T, J), 0.0)
        return largest_rank(J, chain.reach, self.part)

    def jacobian(self, T: Array, J: Array) -> Array:
        """Hybrid Jacobians J (..., 6, m) at poses T (..., 4, 4), without the turn about a
        direction, or without what leads out of the plane.
        """
        if self.name not in ("direction", "planar"):
            return J
        columns = np.moveaxis(J, (-2, -1), (0, 1)).copy()
        if self.name == "planar":
            pose_error.keep_in_plane(self.axis, columns, J.shape[-1])
        else:
            a = rotation_part(T) @ self.axis
            axes = np.moveaxis(a, -1, 0)
            pose_error.remove_turn_about(axes, columns, J.shape[-1])
        return np.moveaxis(columns, (0, 1), (-2, -1))

    def differentiate(self, T: Array, e: Array, J: Array) -> None:
        """Makes J (6, m), of a pose T (4, 4) and without what the task leaves free, -de/dq."""
        if self.name == "direction":
            a = rotation_part(T) @ self.axis
            pose_error.differentiate_direction(a, e, J, J.shape[1])
        else:
            pose_error.differentiate(e, J, J.shape[1])


def pose_errors(chain: Chain, task: Task, q: Array, T: Array) -> Array:
    """Errors (N, 2), m and rad, of the poses of q (N, m) by the kernels of `Chain.fk` against
    targets (N, 4, 4).
    """
    errors = np.empty((len(q), 2))
    rows = np.ascontiguousarray(T)
    _kernel().call(chain.kernel_table, q, rows, task.code, task.axis, errors)
    return errors


@cache
def _kernel() -> Any:
    from ...engine.kernels import ik_kernels  # imports Numba

    return ik_kernels.pose_errors


def targets(T: ArrayLike, what: str) -> Array:
    """Poses (..., 4, 4); what is infinite is no error, but NaN. Raises: PoseError, ShapeError,
    InputError.
    """
    try:
        return poses(T, what)
    except PoseError:
        rows = shaped(T, (4, 4), what).copy()
        finite = np.isfinite(rows).all(axis=(-2, -1))
        rows[~finite] = np.nan
        return poses(rows, what)


def make_task(name: Any, axis: Any, weights: Any) -> Task:
    """Task by the name that a user gives. Raises: InputError."""
    choice(name, TASKS, "task")
    if axis is not None and name != "direction":
        raise InputError(f"axis: only the task 'direction' has one, the task is {name!r}")
    if axis is None:
        axis = [0.0, 0.0, 1.0]
    a = shaped(axis, (3,), "axis")
    if a.ndim != 1 or not np.isfinite(a).all() or not a.any():
        raise InputError(f"axis: expected a direction (3,) that is not zero, got {safe_repr(axis)}")
    a = a / np.abs(a).max()  # so that no square of it overflows
    if weights is None:
        weights = np.ones(6)
    w = shaped(weights, (6,), "weights").copy()
    positive = np.isfinite(w).all() and (w > 0).all()
    if w.ndim != 1 or not positive:
        raise InputError(
            f"weights: expected six positive numbers (rotation; position), got {safe_repr(weights)}"
        )
    if name == "position":
        w[:3] = 0.0
    if name == "rotation":
        w[3:] = 0.0
    return Task(cast(TaskName, name), a / norm(a), w / w.max())
