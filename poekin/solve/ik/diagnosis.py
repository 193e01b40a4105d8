"""Why there is no solution: the arm is too short, its limits are in the way, or it was not found in
time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...engine.kernels import ik_codes as codes
from ...groups.arrays import Array
from ...model.chain import Chain
from .joint_domain import free_ranges
from .solution import BAD_TARGET, ITERATIONS, LIMITS, SOLVED, UNREACHABLE
from .task import Task

if TYPE_CHECKING:
    from .joint_domain import Room
    from .solver import Solver

KIND = "<U12"  # of an array of reasons
AT_LIMIT = 1e-9  # rad or m


def of(
    solver: Solver, targets: Array, q: Array, info: Array, success: np.ndarray
) -> tuple[np.ndarray, Array, tuple[tuple[str, ...], ...]]:
    """The reason of each target, how far it is beyond the reach, and which limits are in the way.

    A target that is solved within the limits after all, from other starts, gets that solution in q.
    """
    chain, room, count = solver.fast.chain, solver.room, len(q)
    reason = np.full(count, UNREACHABLE, dtype=KIND)
    blocked: list[tuple[str, ...]] = [()] * count
    state = info[:, codes.AT_STATE]
    beyond = beyond_reach(chain, solver.task, targets, room.limits)
    beyond[state == codes.BAD_TARGET] = 0.0
    reason[(state == codes.OUT_OF_ITERATIONS) & (beyond == 0)] = ITERATIONS
    reason[state == codes.BAD_TARGET], reason[success] = BAD_TARGET, SOLVED
    open_ones = np.flatnonzero(~success & (state != codes.BAD_TARGET) & (beyond == 0))
    if len(open_ones) and np.isfinite(room.limits).any():
        free = np.tile([-np.inf, np.inf], (chain.dof, 1))
        ranges = free_ranges(chain)
        anywhere = room.anywhere(len(open_ones))
        other, said = solver.solve(
            targets[open_ones], open_ones.astype(float), anywhere, limits=free, ranges=ranges
        )
        for found, k, ended in zip(other, open_ones, said[:, codes.AT_STATE], strict=True):
            if ended == codes.SOLVED:
                within = room.unwound(found, np.clip(found, *room.limits.T))
                if room.holds(within):
                    q[k], reason[k] = within, SOLVED
                else:
                    reason[k], blocked[k] = (
                        LIMITS,
                        _in_the_way(room, q[k], within, solver.fast.q_names),
                    )
    return reason, beyond, tuple(blocked)


def beyond_reach(chain: Chain, task: Task, targets: Array, limits: Array) -> Array:
    """By how much each target is farther from the first joint than the links and slides together
    are long (m).

    Never more than the truth: consecutive points of the axes are no farther apart than the link is
    long.
    """
    if task.name == "rotation" or not len(chain.screws):
        return np.zeros(len(targets))
    frames, slides = chain.local.frames, np.abs(chain.local.slides)
    length = np.linalg.norm(frames[1:, :3, 3], axis=1).sum()
    for slide, row, shift in zip(slides, np.abs(chain.coupling), np.abs(chain.offset), strict=True):
        if slide:
            bounds = np.abs(limits[row > 0]).max(axis=1)
            length += slide * (shift + (row[row > 0] * bounds).sum())
    far = np.linalg.norm(targets[:, :3, 3] - frames[0, :3, 3], axis=1)
    return (
        np.maximum(far - length * (1 + 1e-12), 0.0)
        if np.isfinite(length)
        else np.zeros(len(targets))
    )


def _in_the_way(room: Room, q: Array, found: Array, names: tuple[str, ...]) -> tuple[str, ...]:
    """Coordinates at a limit in the nearest pose within them, and those outside in the solution
    without them.
    """
    lower, upper = room.limits.T
    at = ((np.abs(q - lower) <= AT_LIMIT) | (np.abs(q - upper) <= AT_LIMIT)) & ~room.fixed
    outside = (found < lower) | (found > upper)
    return tuple(
        name for name, stops in zip(names, at if at.any() else outside, strict=True) if stops
    )
