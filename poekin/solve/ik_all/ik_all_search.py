"""All ends of many tries: what the kernel finds for each target, and which of it is a continuum.

Arms and configurations are in joint units (`joint_units`).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.compiled import CompiledChain
from ...model.sampling import sampling_range
from ..ik.ik_problem import kernel_options
from ..ik.task import Task
from ..joint_units import bounds, periods

POSE = Task(
    "pose",
    axis=np.zeros(3),
    weights=np.ones(6),
)


def accepted(chain: Chain) -> float:
    """m and rad: how far the pose of a solution may be from its target; a pose of a long arm is not
    known better.
    """
    return max(1e-10, 1e-12 * chain.reach)


_EDGE = 1e-12  # rad or m: a solution that is outside the limits by less is at them
# m per metre of reach, and rad: where a try ends, some 100 times the rounding of a pose
_AIM = 1e-13
# solutions of one target that are kept: isolated ones of six revolute joints are at most 16
_ROOM = 40
_AT_ONCE = 32  # targets between which an interrupt is seen
_SINGULAR = 1e-5  # of the largest singular value: below it a solution may be one of a continuum
_MOVES = 0.02  # of the largest change: what changes by less does not move along a continuum
_STEP = 0.05  # rad or m: how far a walk along a continuum goes


@dataclass(frozen=True, eq=False)
class Found:
    """Solutions found for one target, limits apart.

    Attributes: solutions (s, m); hits (s,), how often each was found; ends, how many tries ended at
    any of them; restarts, 0 where the given starts were enough; full, whether there was no room for
    more; singular, whether any of them is singular; self_motion_coordinates, those that move along a
    continuum of solutions, of which one solution
    is listed; none where there is no continuum.
    """

    solutions: Array
    hits: Array
    ends: int
    restarts: int
    full: bool
    singular: bool = False
    self_motion_coordinates: tuple[str, ...] = ()


@dataclass(frozen=True)
class Rule:
    """Length of a search: until each solution was found `min_hits` times, within `restarts` tries
    of `iterations`.

    It gives up after `max_misses` tries without any; the seed is that of the random starts.
    """

    min_hits: int
    restarts: int
    iterations: int
    max_misses: int = 0
    seed: int = 0


def turns_within(chain: Chain, Q: Array, limits: bool) -> tuple[Array, Array]:
    """The fewest and the most periods (S, m) that may be added to configurations within the limits.

    The fewest are more than the most where there is no way, infinite where there is no limit.
    """
    turn = periods(chain)
    low, high = bounds(chain, limits).T
    turns = turn > 0
    step = np.where(turns, turn, 1.0)
    lowest = low - _EDGE
    highest = high + _EDGE
    first = np.ceil((lowest - Q) / step)
    last = np.floor((highest - Q) / step)
    inside = (lowest <= Q) & (highest >= Q)
    first = np.where(turns, first, ~inside)
    last = np.where(turns, last, 0.0)
    return first, last


def joined(found: list[Found], dof: int) -> tuple[Array, np.ndarray]:
    """Solutions (S, m) of all targets, and the number of the target of each."""
    none = np.empty((0, dof))
    parts = [f.solutions for f in found]
    numbers = np.arange(len(found))
    counts = [len(q) for q in parts]
    owner = np.repeat(numbers, counts)
    return np.concatenate([none, *parts]), owner


def search(
    fast: CompiledChain,
    T: Array,
    starts: Sequence[Array],
    rule: Rule,
    limits: bool,
) -> list[Found]:
    """Solutions of targets (N, 4, 4) from given starts (s, m) of each and then from random ones, by
    the rule.
    """
    found: list[Found] = []
    for first in range(0, len(T), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        found += _search(fast, T[some], starts[some], rule, first)
    return _looked_at(fast, T, found, limits)


def _search(
    fast: CompiledChain,
    T: Array,
    starts: Sequence[Array],
    rule: Rule,
    first: int = 0,
) -> list[Found]:
    from ...engine.kernels import ik_all_kernel as kernel  # which imports Numba

    chain = fast.chain
    N = len(T)
    m = fast.dof
    rows, given = _padded(starts, m)
    turn = periods(chain)
    # a coordinate that turns is free, and brought into its limits at the end; another one has only
    # its own range
    ranges = np.stack(sampling_range(chain), axis=1)
    turns = turn > 0
    ranges[turns] = turn[turns, None] * [-0.5, 0.5]
    rules = np.zeros(kernel.RULE)
    rules[kernel.MAX_ERROR] = accepted(chain)
    rules[kernel.MIN_HITS] = rule.min_hits
    rules[kernel.RESTARTS] = rule.restarts
    rules[kernel.MAX_MISSES] = rule.max_misses
    q = np.empty((N, _ROOM, m))
    hits = np.empty((N, _ROOM))
    info = np.empty((N, kernel.INFO))
    free = bounds(chain, False)
    indices = np.arange(first, first + N, dtype=np.float64)
    options = kernel_options(POSE, _AIM * chain.reach, _AIM, rule.iterations)
    tries = (rows, given, free, ranges, turn, options, rules, indices, rule.seed)
    T = np.ascontiguousarray(T)
    kernel.search.call(fast.hybrid_address, T, *tries, q, hits, info)
    found = []
    for k, numbers in enumerate(info.astype(int).tolist()):
        count = numbers[kernel.FOUND]
        one = Found(
            solutions=q[k, :count].copy(),
            hits=hits[k, :count].copy(),
            ends=numbers[kernel.AT_ENDS],
            restarts=numbers[kernel.AT_RESTARTS],
            full=numbers[kernel.FULL] > 0,
        )
        found.append(one)
    return found


def _padded(starts: Sequence[Array], dof: int) -> tuple[Array, Array]:
    """Starts of all targets (N, s, m), filled up to as many of each, and how many are given (N,)."""
    given = np.array([len(Q) for Q in starts], np.float64)
    most = int(given.max(initial=0))
    rows = np.zeros((len(starts), most, dof))
    for k, Q in enumerate(starts):
        rows[k, : len(Q)] = Q
    return rows, given


def _looked_at(
    fast: CompiledChain,
    T: Array,
    found: list[Found],
    limits: bool,
) -> list[Found]:
    """Which targets have singular solutions; of those that belong to a continuum only one is kept,
    within the limits if one is.
    """
    result = list(found)
    q, owner = joined(found, fast.dof)
    J = fast.chain.jacobian(q, frame="hybrid")
    J[:, 3:] /= _size(fast.chain)  # so that the unit of length is of no matter
    sizes = np.linalg.svd(J, compute_uv=False)
    singular = sizes[:, -1] < _SINGULAR * sizes[:, 0]
    for k in np.unique(owner[singular]):
        f = replace(found[k], singular=True)
        result[k] = f
        ways: dict[int, Array] = {}
        for j, i in enumerate(np.flatnonzero(owner == k)):
            way = None
            if singular[i]:
                way = _way_along(fast, T[k], q[i], J[i])
            if way is not None:
                change = np.abs(way)
                ways[j] = change / change.max()
        if ways:
            met = list(ways)
            first, last = turns_within(fast.chain, f.solutions[met], limits)
            within = (first <= last).all(axis=1)
            kept = met[int(np.argmax(within))]
            every = range(len(f.hits))
            alone = [j for j in every if j == kept or j not in ways]
            changes = np.max(list(ways.values()), axis=0)
            moving = itertools.compress(fast.q_names, changes > _MOVES)
            result[k] = replace(
                f,
                solutions=f.solutions[alone],
                hits=f.hits[alone],
                self_motion_coordinates=tuple(moving),
            )
    return result


def _size(chain: Chain) -> float:
    """Length of all links together (m), 1 where all are points."""
    offsets = chain.local.frames[1:, :3, 3]
    links = np.linalg.norm(offsets, axis=1)
    return float(links.sum()) or 1.0


def _way_along(
    fast: CompiledChain,
    T: Array,
    q: Array,
    J: Array,
) -> Array | None:
    """Changes of the coordinates along a continuum of solutions through q, or None where there is
    none.

    A step in a direction that does not move the tool to first order is tried down to the target
    again: of a double solution it comes back, along a continuum it stays a step away.
    """
    _, sizes, V = np.linalg.svd(J)
    singular = sizes < _SINGULAR * sizes[0]
    lost = V[: len(sizes)][singular]
    turn = periods(fast.chain)
    divisor = np.where(turn > 0, turn, np.inf)
    rule = Rule(min_hits=1, restarts=0, iterations=200)
    for way in lost:
        start = q + _STEP * way
        (end,) = _search(fast, T[None], [start[None]], rule)
        if len(end.solutions):
            step = end.solutions[0] - q
            step -= turn * np.round(step / divisor)
            length = np.linalg.norm(step)
            if _STEP / 4 < length < 2 * _STEP:
                return step
    return None
