"""Reasons why there is no solution: the arm is too short, its limits forbid it, or no try found it
in time.
"""

from __future__ import annotations

import itertools
from functools import partial
from typing import NamedTuple

import numpy as np

from ...engine.kernels import ik_codes as codes
from ...errors import InputError
from ...groups.arrays import Array
from ...groups.vectors import norms, translation_part
from ...model.chain import Chain
from ...model.readings.coupled import beyond_own_limits
from ..joint_units import bounds
from .ik_problem import AGAIN, APART, IKProblem
from .joint_domain import JointDomain, free_ranges
from .least_error import least_error, slope_at
from .solution import BAD_TARGET, ITERATIONS, LIMITS, SOLVED, UNREACHABLE, Names
from .task import Task, TaskName, TaskNames

KIND = "<U12"  # of an array of reasons
AT_LIMIT = 1e-9  # rad or m

OTHER_TASKS: dict[TaskName, TaskNames] = {
    "pose": ("direction", "planar", "position", "rotation"),
    "direction": ("planar", "position"),
    "planar": ("position", "rotation"),
    "position": ("planar",),
    "rotation": ("planar",),
}
"""Tasks that are tried for a target out of reach of an arm with too few coordinates."""

OTHER_RESTARTS = 20


class Causes(NamedTuple):
    """Entries of `Solution` that say why targets are not solved."""

    reason: np.ndarray
    distance_beyond_reach: Array
    limits_hit: tuple[Names, ...] = ()
    reachable_tasks: tuple[TaskNames, ...] = ()


def diagnose(
    problem: IKProblem,
    targets: Array,
    first: Array,
    q: Array,
    info: Array,
    success: np.ndarray,
) -> Causes:
    """Causes for which targets are not solved, by tries that began at `first` and ended at q.

    A target that is solved after all, from other starts without limits, or where the arm comes to
    rest, gets that solution in q.
    """
    if not problem.underactuated:
        return find_causes(problem, targets, q, info, success)
    known = info[:, codes.AT_STATE] != codes.BAD_TARGET
    unsolved = np.flatnonzero(~success & known)
    settle(problem, targets, q, info, unsolved)
    _, success = problem.pose_errors(targets, problem.coordinates(q))
    causes = find_causes(problem, targets, q, info, success)
    unreached = np.flatnonzero(causes.reason == UNREACHABLE)
    tasks = reachable_tasks(problem, targets, first, unreached)
    return causes._replace(reachable_tasks=tasks)


def find_causes(
    problem: IKProblem,
    targets: Array,
    q: Array,
    info: Array,
    success: np.ndarray,
) -> Causes:
    """Reason of each target, its distance beyond the reach, and the limits that were hit.

    A target that is solved within the limits after all, from other starts, gets that solution in q.
    One that is solved outside is tried within them once more, from there.
    """
    domain = problem.domain
    chain = problem.fast.chain
    state = info[:, codes.AT_STATE]
    beyond = distance_beyond_reach(chain, problem.task, targets, domain.limits)
    beyond[state == codes.BAD_TARGET] = 0.0
    reason = np.full(len(q), UNREACHABLE, dtype=KIND)
    reason[(state == codes.OUT_OF_ITERATIONS) & (beyond == 0)] = ITERATIONS
    reason[state == codes.BAD_TARGET] = BAD_TARGET
    reason[success] = SOLVED
    hit: list[Names] = [()] * len(q)
    open_ones = np.flatnonzero(~success & (state != codes.BAD_TARGET) & (beyond == 0))
    limited = problem.has_joint_limits or np.isfinite(domain.limits).any()
    if not (len(open_ones) and limited):
        return Causes(reason, beyond, tuple(hit))
    free, ends = problem.solve(
        targets[open_ones],
        open_ones.astype(float),
        domain.anywhere(len(open_ones)),
        limits=bounds(chain, False),
        ranges=free_ranges(chain),
    )
    solved = ends[:, codes.AT_STATE] == codes.SOLVED
    found = free[solved]
    which = open_ones[solved]
    near = np.clip(found, *domain.limits.T)
    within = np.array([domain.wrapped(*pair) for pair in zip(found, near, strict=True)])
    kept = np.array([problem.contains(one) for one in within], bool)
    if problem.options[codes.RESTARTS] and not kept.all():
        # as many tries again, the first from there
        left = np.flatnonzero(~kept)
        numbers = (which[left] + AGAIN * APART).astype(float)
        again, ends = problem.solve(targets[which[left]], numbers, near[left])
        is_solved = ends[:, codes.AT_STATE] == codes.SOLVED
        within[left[is_solved]] = again[is_solved]
        kept[left[is_solved]] = [problem.contains(one) for one in again[is_solved]]
    for k, one, is_within in zip(which, within, kept, strict=True):
        if is_within:
            q[k] = one
            reason[k] = SOLVED
            continue
        reason[k] = LIMITS
        hit[k] = limits_hit(domain, q[k], one, problem.fast.q_names)
        if (one == np.clip(one, *chain.limits.T)).all():
            joints = beyond_own_limits(chain, one)
            hit[k] = tuple(itertools.compress(chain.joint_names, joints))
    return Causes(reason, beyond, tuple(hit))


def distance_beyond_reach(
    chain: Chain,
    task: Task,
    targets: Array,
    limits: Array,
) -> Array:
    """Distance of each target from the first joint, less the length of all links and slides (m); 0
    within the reach.

    Never more than the truth: consecutive points of the axes are no farther apart than the link is
    long.
    """
    nothing = np.zeros(len(targets))
    if task.name == "rotation" or not len(chain.screws):
        return nothing
    frames = chain.local.frames
    offsets = translation_part(targets) - translation_part(frames[0])
    if task.name == "planar":
        heights = offsets @ task.axis
        offsets = offsets - np.outer(heights, task.axis)
    links = norms(translation_part(frames[1:]))
    length = links.sum()
    ratios = np.abs(chain.coupling)
    farthest = np.abs(limits).max(axis=1, initial=0.0)
    slides = np.abs(chain.local.slides)
    for k in np.flatnonzero(slides):
        moves = ratios[k] > 0
        ways = ratios[k, moves] * farthest[moves]
        length += slides[k] * (abs(chain.offset[k]) + ways.sum())
    if not np.isfinite(length):
        return nothing
    with np.errstate(over="ignore"):
        far = np.hypot(np.hypot(*offsets[:, :2].T), offsets[:, 2])
    return np.maximum(far - length * (1 + 1e-12), 0.0)


def settle(
    problem: IKProblem,
    targets: Array,
    q: Array,
    info: Array,
    rows: np.ndarray,
) -> None:
    """Takes the joints of these rows on to the least error, where they come to rest.

    The tries end where a step hardly helps: enough for a target that is reached, and not where the
    arm has too few coordinates to reach most.
    """
    domain = problem.domain
    low, high = map(domain.held, domain.limits.T)
    for k in rows:
        slope = partial(slope_at, problem, targets[k])
        nearest = least_error(slope, q[k], low, high)
        q[k] = domain.wrapped(nearest, q[k])
        info[k, codes.AT_STATE] = codes.STALLED


def reachable_tasks(
    problem: IKProblem,
    targets: Array,
    first: Array,
    rows: np.ndarray,
) -> tuple[TaskNames, ...]:
    """Other tasks that reach these rows of the targets, found by trying; () for all others."""
    tasks: list[TaskNames] = [()] * len(targets)
    for name in OTHER_TASKS[problem.task.name]:
        try:
            other = problem.with_task(name)
        except InputError:  # the arm has no plane
            continue
        q, _ = other.solve(
            targets[rows],
            rows.astype(float),
            first[rows],
            restarts=min(OTHER_RESTARTS, problem.settings.restarts),
        )
        _, success = other.pose_errors(targets[rows], other.coordinates(q))
        for k in rows[success]:
            tasks[k] = (*tasks[k], name)
    return tuple(tasks)


def limits_hit(
    domain: JointDomain,
    q: Array,
    found: Array,
    names: Names,
) -> Names:
    """Coordinates at a limit in the nearest pose within them; where there is none, those outside in
    the solution without limits.
    """
    lower, upper = domain.limits.T
    off = np.minimum(
        np.abs(q - lower),
        np.abs(q - upper),
    )
    hit = (off <= AT_LIMIT) & ~domain.locked
    if not hit.any():
        hit = (found < lower) | (found > upper)
    return tuple(itertools.compress(names, hit))
