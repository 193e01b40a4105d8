"""All ends of many tries: what the kernel finds for each target, and which of it is a continuum.

Arms and configurations are in joint units (`joint_units`).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...engine.jit import threads
from ...groups.arrays import Array
from ...groups.vectors import norms, translation_part
from ...model.chain import Chain
from ...model.kinematics.compiled import CompiledChain
from ...model.sampling import sampling_range
from ..ik.ik_problem import kernel_options
from ..ik.task import Task
from ..ragged import Ragged
from .solution_sets.found import Found, joined
from .solution_sets.places import Box, turns_within
from .solution_sets.self_motion import SelfMotion

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


# m per metre of reach, and rad: where a try ends, some 100 times the rounding of a pose
AIM = 1e-13
# solutions of one target that are kept: isolated ones of six revolute joints are at most 16
_ROOM = 40
_AT_ONCE = 4096  # targets whose solutions are in memory with all their room
_UNINTERRUPTED = 32  # targets between which an interrupt is seen
_SINGULAR = 1e-5  # of the largest singular value: below it a solution may be one of a continuum
_MOVES = 0.02  # of the largest change: what changes by less does not move along a continuum
_STEP = 0.05  # rad or m: how far a walk along a continuum goes


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


@dataclass(frozen=True, eq=False)
class SearchedArm:
    """The kernel's search of one arm: fast, the arm in joint units; box, the domain within which
    solutions are wanted; free (m,), whether coordinates may move; parallel, whether long batches
    are shared out among threads.
    """

    fast: CompiledChain
    box: Box
    free: np.ndarray
    parallel: bool = False

    @cached_property
    def ranges(self) -> Array:
        """Ranges of random starts (m, 2): a coordinate that turns is free, and brought into its
        limits at the end; another one has only its own range.
        """
        turn = self.box.periods
        ranges = np.stack(sampling_range(self.fast.chain), axis=1)
        turns = turn > 0
        ranges[turns] = turn[turns, None] * [-0.5, 0.5]
        return ranges


def search(
    arm: SearchedArm,
    T: Array,
    values: Array,
    starts: Ragged,
    rule: Rule,
) -> Found:
    """Solutions of targets (N, 4, 4) from given starts (s, m) of each and then from random ones, by
    the rule. `values` (N, m) are those of coordinates that are not free.
    """
    parts = [
        _search(
            arm,
            T[first : first + _AT_ONCE],
            values[first : first + _AT_ONCE],
            starts.part(first, first + _AT_ONCE),
            rule,
            first,
        )
        for first in range(0, len(T), _AT_ONCE)
    ]
    found = joined([part for part, _ in parts], arm.fast.dof)
    bounds = np.concatenate([np.empty(0), *(bound for _, bound in parts)])
    return _examined(arm, T, values, found, bounds)


def _search(
    arm: SearchedArm,
    T: Array,
    values: Array,
    starts: Ragged,
    rule: Rule,
    first: int = 0,
) -> tuple[Found, Array]:
    """Solutions of targets, and a bound of the condition of each (S,)."""
    from ...engine.kernels import ik_all_kernel as kernel  # which imports Numba

    fast = arm.fast
    chain = fast.chain
    N = len(T)
    m = fast.dof
    rules = np.zeros(kernel.RULE)
    rules[kernel.MAX_ERROR] = accepted(chain)
    rules[kernel.MIN_HITS] = rule.min_hits
    rules[kernel.RESTARTS] = rule.restarts
    rules[kernel.MAX_MISSES] = rule.max_misses
    room = max(_ROOM if rule.restarts else 0, int(starts.counts.max(initial=1)))
    q = np.empty((N, room, m))
    hits = np.empty((N, room))
    bounds = np.empty((N, room))
    info = np.empty((N, kernel.INFO))
    limits = np.tile([-np.inf, np.inf], (m, 1))
    options = kernel_options(POSE, AIM * chain.reach, AIM, rule.iterations)
    fixed = (limits, arm.ranges, arm.box.periods, arm.free.astype(float))

    def run(
        T: Array, starts: Array, given: Array, values: Array, indices: Array, *out: Any
    ) -> None:
        for k in range(0, len(T), _UNINTERRUPTED):
            some = slice(k, k + _UNINTERRUPTED)
            kernel.search.call(
                fast.hybrid_address, T[some], starts[some], given[some], *fixed, values[some],
                options, rules, indices[some], rule.seed, *(array[some] for array in out),
            )  # fmt: skip

    given = starts.counts.astype(np.float64)
    indices = np.arange(first, first + N, dtype=np.float64)
    arrays = (np.ascontiguousarray(T), starts.padded(0.0), given, values, indices)
    results = (q, hits, bounds, info)
    if arm.parallel:
        threads.share_out(run, *arrays, *results, rows=_UNINTERRUPTED)
    else:
        run(*arrays, *results)
    numbers = info.astype(int)
    counts = numbers[:, kernel.FOUND]
    there = np.arange(room) < counts[:, None]
    found = Found(
        q=Ragged(q[there], counts),
        hits=hits[there],
        ends=numbers[:, kernel.AT_ENDS],
        restarts=numbers[:, kernel.AT_RESTARTS],
        full=numbers[:, kernel.FULL] > 0,
        singular=np.zeros(N, bool),
    )
    return found, bounds[there]


def _examined(
    arm: SearchedArm,
    T: Array,
    values: Array,
    found: Found,
    bounds: Array,
) -> Found:
    """Which targets have singular solutions; of those that belong to a continuum only one is kept,
    within the limits if one is.
    """
    size = _size(arm.fast.chain)
    suspect = np.flatnonzero(bounds < _SINGULAR * max(size, 1.0 / size))
    if not len(suspect):
        return found
    q = found.q
    J = arm.fast.chain.jacobian(q.rows[suspect], frame="hybrid")[:, :, arm.free]
    J[:, 3:] /= size  # so that the unit of length is of no matter
    sizes = np.linalg.svd(J, compute_uv=False)
    is_singular = sizes[:, -1] < _SINGULAR * sizes[:, 0]
    singular = found.singular.copy()
    kept = np.ones(len(q.rows), bool)
    self_motion = {}
    owner = q.owner[suspect]
    for k in np.unique(owner[is_singular]).tolist():
        singular[k] = True
        one = Target(T[k], values[k])
        ways = {
            int(suspect[i]): _way_along(arm, one, q.rows[suspect[i]], J[i])
            for i in np.flatnonzero(is_singular & (owner == k))
        }
        along = {row: way for row, way in ways.items() if way is not None}
        if along:
            met = list(along)
            fewest, most = turns_within(arm.box, q.rows[met])
            within = (fewest <= most).all(axis=1)
            listed = met[int(np.argmax(within))]
            kept[met] = False
            kept[listed] = True
            sizes_of = np.abs(list(along.values()))
            changes = np.max(sizes_of / sizes_of.max(axis=1, keepdims=True), axis=0)
            names = tuple(itertools.compress(arm.fast.q_names, changes > _MOVES))
            self_motion[k] = SelfMotion(names, along[listed])
    return replace(found.kept(kept), singular=singular, self_motion=self_motion)


class Target(NamedTuple):
    """Pose (4, 4) that is wanted, and the values (m,) of coordinates that are not free."""

    T: Array
    values: Array


def _size(chain: Chain) -> float:
    """Length of all links together (m), 1 where all are points."""
    offsets = translation_part(chain.local.frames[1:])
    links = norms(offsets)
    return float(links.sum()) or 1.0


def _way_along(
    arm: SearchedArm,
    target: Target,
    q: Array,
    J: Array,
) -> Array | None:
    """Changes of the coordinates along a continuum of solutions through q, or None where there is
    none. J is that of the free coordinates.

    A step in a direction that does not move the tool to first order is tried down to the target
    again: of a double solution it comes back, along a continuum it stays a step away.
    """
    _, sizes, V = np.linalg.svd(J)
    singular = sizes < _SINGULAR * sizes[0]
    lost = V[: len(sizes)][singular]
    turn = arm.box.periods
    divisor = np.where(turn > 0, turn, np.inf)
    rule = Rule(min_hits=1, restarts=0, iterations=200)
    for way in lost:
        start = q.copy()
        start[arm.free] += _STEP * way
        one = Ragged(start[None], np.array([1]))
        end, _ = _search(arm, target.T[None], target.values[None], one, rule)
        if len(end.q.rows):
            step = end.q.rows[0] - q
            step -= turn * np.round(step / divisor)
            length = np.linalg.norm(step)
            if _STEP / 4 < length < 2 * _STEP:
                return step
    return None
