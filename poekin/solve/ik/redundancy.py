"""What an arm does with joints to spare: steps in the null space of its task, each followed by a
new solve.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine.kernels import ik_codes as codes
from ...errors import InputError, safe_repr
from ...groups.arrays import Array

if TYPE_CHECKING:
    from .solver import Solver

AIMS = ("middle", "nearest", "manipulability")
STEPS = 25
STEP = 0.5  # of the way that the aim asks for
# rad or m, for the gradient of the manipulability: its error is far below what a step needs
DIFFERENCE = 1e-6


def check_aim(aim: Any, q0: Any) -> None:
    """Raises InputError for what is no aim, and for "nearest" to nothing."""
    if aim is not None and (not isinstance(aim, str) or aim not in AIMS):
        raise InputError(f"aim: expected one of {', '.join(AIMS)}, got {safe_repr(aim)}")
    if aim == "nearest" and q0 is None:
        raise InputError("aim: 'nearest' needs q0, what to be near to")


def improved(solver: Solver, targets: Array, q: Array, q0: Array, aim: str) -> Array:
    """Solutions that serve the aim better, of those targets that are solved already."""
    known = ~np.isnan(q).any(axis=1)
    if not known.all():  # of a bad target nothing is known
        best = q.copy()
        best[known] = improved(solver, targets[known], q[known], q0[known], aim)
        return best
    q0 = np.where(np.isnan(q0), q, q0)
    best, value = q.copy(), _value(solver, q, q0, aim)
    step = np.full(len(q), STEP)
    for _ in range(STEPS):
        tried = _moved(solver, best, q0, aim, step)
        found, said = solver.solve(targets, np.arange(len(q), dtype=float), tried, restarts=0)
        new = _value(solver, found, q0, aim)
        better = (said[:, codes.AT_STATE] == codes.SOLVED) & (new < value)
        best[better], value[better] = found[better], new[better]
        step = np.where(better, step, 0.5 * step)
    return best


def _value(solver: Solver, q: Array, q0: Array, aim: str) -> Array:
    """What the aim makes small; of the manipulability that of the task, by the coordinates that may
    move.
    """
    if aim == "manipulability":
        sizes = np.linalg.svd(_jacobian(solver, q), compute_uv=False)[:, : solver.task.holds]
        with np.errstate(divide="ignore"):
            return -np.log(sizes).sum(axis=1)
    return ((q - _goal(solver, q0, aim)) ** 2 * _weights(solver, aim)).sum(axis=1)


def _moved(solver: Solver, q: Array, q0: Array, aim: str, step: Array) -> Array:
    """Downhill in the null space of the task's Jacobian."""
    if aim == "manipulability":
        z = np.empty_like(q)
        for k in range(q.shape[1]):
            h = np.zeros(q.shape[1])
            h[k] = DIFFERENCE
            with np.errstate(
                invalid="ignore"
            ):  # infinite less infinite, at a singularity: no way is better there
                z[:, k] = _value(solver, q - h, q0, aim) - _value(solver, q + h, q0, aim)
        z = np.where(np.isfinite(z), z, 0.0) * (0.5 / DIFFERENCE)
        z /= np.maximum(np.linalg.norm(z, axis=1, keepdims=True), 1.0)
    else:
        z = (_goal(solver, q0, aim) - q) * _weights(solver, aim)
    J = _jacobian(solver, q)
    moved = q + step[:, None] * (z - (np.linalg.pinv(J) @ (J @ z[..., None]))[..., 0])
    return np.where(solver.room.fixed, q, np.clip(moved, *solver.room.limits.T))


def _jacobian(solver: Solver, q: Array) -> Array:
    """The Jacobian of what the task takes hold of; what is locked moves nothing."""
    J = solver.task.jacobian(*solver.fast.fk_jacobian(q, "hybrid"))[:, solver.task.weights > 0]
    return np.where(solver.room.fixed, 0.0, J)


def _goal(solver: Solver, q0: Array, aim: str) -> Array:
    if aim == "nearest":
        return q0
    both = np.asarray(np.isfinite(solver.room.limits).all(axis=1))
    return np.where(both, np.where(both[:, None], solver.room.limits, 0.0).mean(axis=1), q0)


def _weights(solver: Solver, aim: str) -> Array:
    both = np.asarray(np.isfinite(solver.room.limits).all(axis=1))
    return np.ones(len(both)) if aim == "nearest" else both.astype(float)
