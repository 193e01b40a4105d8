"""A solver for one arm and one way of asking, kept with the arm: one call costs little more than
the solving.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ...engine.jit import threads
from ...engine.kernels import ik_codes as codes
from ...errors import InputError, safe_repr
from ...groups.arrays import Array, numbers
from ...model.kinematics.compiled import CompiledChain
from . import diagnosis, redundancy
from .joint_domain import Room, first_tries, for_targets, room_of
from .joint_units import joint_units
from .memory import keep
from .solution import SOLVED, UNREACHABLE, Solution
from .task import Task, check_joints, task_of

AT_ONCE = 20_000
"""Targets between two calls of `progress`."""

STEPS = 800_000
"""The most steps that one call of a kernel takes, which no interrupt ends: some tenths of a second.
"""

NEAREST_OF = 48
"""So many tries for each target are looked at for the one nearest to `nearest_to`."""

NEAREST_TRIES = tuple(itertools.product((True, False), repeat=2))
"""Whether each of them is made with limits, and whether it starts not far away; they take turns.
More of those without limits arrive, and many of these within the limits but for whole turns."""


class Settings(NamedTuple):
    """What `ik` is asked, but for the targets and where to begin; arrays as tuples."""

    task: Any
    axis: Any
    limits: Any
    tol_position: Any
    tol_rotation: Any
    lock: Any
    weights: Any
    restarts: Any
    iterations: Any
    seed: Any
    parallel: Any


def hashable(values: Any, what: str) -> Any:
    """What a user gives as an array, so that it can be part of a key; what is no vector is told by
    `task_of`.
    """
    if isinstance(values, (list, tuple, np.ndarray)):
        values = numbers(values, what)
        return tuple(values.tolist()) if values.ndim == 1 else values
    return values


def items(lock: Any) -> Any:
    """The names and values that a user gives as a dict, so that they can be part of a key. Raises:
    InputError.
    """
    if lock is not None and not isinstance(lock, Mapping):
        raise InputError(f"lock: expected a dict of names and values, got {safe_repr(lock)}")
    return None if lock is None else tuple(lock.items())


def solver_of(fast: CompiledChain, settings: Settings) -> Solver:
    """The arm's solver for these settings. Raises: InputError, UnknownName, ShapeError for settings
    that are none.
    """
    key = (
        settings,
        *map(type, settings),
    )  # 1 == True, and 100.0 == 100: what is no setting must find none
    try:
        kept = fast.memory.get(key)
    except TypeError:  # something that is no number, and so no key: the checks say what
        kept = None
    return keep(fast, key, Solver(fast, settings)) if kept is None else kept


class Solver:
    """The kernel with all that does not change from target to target."""

    def __init__(self, fast: CompiledChain, settings: Settings):
        _check_numbers(settings)
        self.settings, self.given, self.units = settings, fast.chain, joint_units(fast)
        self.fast = fast = self.units.fast
        self.task: Task = task_of(settings.task, settings.axis, settings.weights)
        self.room: Room = room_of(self.units, settings.lock, settings.limits)
        check_joints(fast.chain, self.task, int((~self.room.fixed).sum()))
        self.fixed = self.room.fixed.astype(float)  # as the kernels take it
        from ...engine.kernels import ik_kernels  # imports Numba

        self._solve, self._judge = ik_kernels.solve_many, ik_kernels.judge
        self._arm = fast.hybrid_address
        self.options = np.zeros(codes.OPTIONS)
        # A little less than asked for: the errors are computed anew by other kernels, whose
        # rounding is another.
        self.options[codes.TOL_POSITION] = 0.9 * settings.tol_position
        self.options[codes.TOL_ROTATION] = 0.9 * settings.tol_rotation
        self.options[codes.ITERATIONS], self.options[codes.RESTARTS] = (
            settings.iterations,
            settings.restarts,
        )
        self._rows = _rows(settings.restarts, settings.iterations)
        self.options[codes.TASK] = self.task.code
        self.options[codes.AXIS : codes.AXIS + 3], self.options[codes.WEIGHTS :] = (
            self.task.axis,
            self.task.weights,
        )

    def run(self, T: Array, q0: Any, nearest_to: Any, aim: str | None,
            progress: Callable[[int, int], None] | None) -> Solution:  # fmt: skip
        """The solutions of targets (..., 4, 4)."""
        batch, rows = T.shape[:-2], np.ascontiguousarray(T.reshape(-1, 4, 4))
        if not (rows.flags.writeable and rows.flags.aligned):  # the kernels take no others
            rows = rows.copy()
        count, room = len(rows), self.room
        first = first_tries(self.units, room, batch, count, q0)
        near = None
        if nearest_to is not None:
            near = self.units.of(for_targets(self.given, batch, count, nearest_to, "nearest_to"))
        indices = np.arange(count, dtype=float)
        if count <= AT_ONCE and near is None and aim is None and progress is None:
            u, info = self.solve(rows, indices, first)
        else:
            u, info = self._in_parts(rows, indices, first, near, aim, progress)
        if room.winds and nearest_to is None:
            u = room.unwound(u)
        q = u if self.units.scale is None else self.coordinates(u)
        errors, success = self.judged(rows, q)
        reason = np.full(count, SOLVED, dtype=diagnosis.KIND)
        beyond, blocked = np.zeros(count), ()
        if not success.all():
            reason, beyond, blocked = diagnosis.of(self, rows, u, info, success)
            q = self.coordinates(u)
            errors, success = self.judged(rows, q)
            reason[(reason == SOLVED) & ~success] = (
                UNREACHABLE  # by a rounding, where the tolerance is no larger
            )
        return Solution(
            q.reshape(*batch, self.fast.dof),
            success.reshape(batch),
            reason.reshape(batch),
            errors[:, 0].reshape(batch),
            errors[:, 1].reshape(batch),
            info[:, codes.AT_ITERATIONS].astype(np.int64).reshape(batch),
            info[:, codes.AT_RESTARTS].astype(np.int64).reshape(batch),
            beyond.reshape(batch),
            blocked,
        )

    def coordinates(self, u: Array) -> Array:
        """The user's coordinates q (..., m) of joint units u (..., m); the rest of a solver works
        with u alone.
        """
        if self.units.scale is None:
            return u
        q = (
            self.units.coordinates(u, self.given.limits)
            if self.settings.limits
            else u / self.units.scale
        )
        for name, value in self.settings.lock or ():  # to the last digit
            q[..., self.given.q_names.index(name)] = np.where(
                np.isnan(q).any(axis=-1), np.nan, value
            )
        return q

    def judged(self, targets: Array, q: Array) -> tuple[Array, np.ndarray]:
        """The errors of q (N, 2) in m and rad by the kernels of any chain, and whether the
        tolerances hold.
        """
        errors = np.empty((len(q), 2))
        self._judge.call(self.given._table, q, targets, self.task.code, self.task.axis, errors)
        return errors, (errors[:, 0] <= self.settings.tol_position) & (
            errors[:, 1] <= self.settings.tol_rotation
        )

    def _in_parts(self, rows: Array, indices: Array, first: Array, near: Array | None, aim: str | None,
                  progress: Callable[[int, int], None] | None) -> tuple[Array, Array]:  # fmt: skip
        """q and info of many targets, some at a time, each with all that is asked of it."""
        count = len(rows)
        q, info = np.empty((count, self.fast.dof)), np.empty((count, codes.INFO))
        for start in range(0, count, AT_ONCE):
            part = slice(start, min(start + AT_ONCE, count))
            if near is None:
                q[part], info[part] = self.solve(rows[part], indices[part], first[part])
            else:
                q[part], info[part] = self.nearest(
                    rows[part], indices[part], first[part], near[part]
                )
            if aim is not None:
                q[part] = redundancy.improved(self, rows[part], q[part], first[part], aim)
            if progress is not None:
                progress(part.stop, count)
        return q, info

    def solve(self, targets: Array, indices: Array, q0: Array, *, restarts: int | None = None,
              limits: Array | None = None, ranges: Array | None = None) -> tuple[Array, Array]:  # fmt: skip
        """q and info of targets, whose indices in the batch are given, from q0; NaN there means
        anywhere.
        """
        options, rows = self.options, self._rows
        if restarts is not None:
            options = options.copy()
            options[codes.RESTARTS] = restarts
            rows = _rows(restarts, self.settings.iterations)
        q, info = np.empty((len(targets), self.fast.dof)), np.empty((len(targets), codes.INFO))
        limits = self.room.limits if limits is None else limits
        ranges = self.room.ranges if ranges is None else ranges
        arm, fixed, seed = self._arm, self.fixed, self.settings.seed
        if len(targets) <= rows:
            self._solve.call(
                arm, targets, q0, limits, ranges, fixed, options, indices, seed, q, info
            )
            return q, info

        def run(targets: Array, q0: Array, indices: Array, q: Array, info: Array) -> None:
            self._solve.call(
                arm, targets, q0, limits, ranges, fixed, options, indices, seed, q, info
            )

        if self.settings.parallel:
            threads.share_out(run, targets, q0, indices, q, info, rows=min(rows, 256))
        else:
            for start in range(0, len(targets), rows):
                run(*(a[start : start + rows] for a in (targets, q0, indices, q, info)))
        return q, info

    def nearest(
        self, targets: Array, indices: Array, q0: Array, near: Array
    ) -> tuple[Array, Array]:
        """Of some tries for each target, the first from q0 or, where that is anywhere, from `near`
        within the limits: the solution nearest to the configuration `near`.
        """
        within = np.where(self.room.fixed, self.room.held, np.clip(near, *self.room.limits.T))
        q, kept = self.solve(targets, indices, np.where(np.isnan(q0), within, q0))
        best = self.room.unwound(q, near)
        distance = _distance(best, near, kept)
        rng = np.random.default_rng(self.settings.seed)
        low, high = self.room.ranges.T
        anywhere = np.full_like(self.room.limits, [-np.inf, np.inf])
        for limits, close in itertools.islice(itertools.cycle(NEAREST_TRIES), NEAREST_OF):
            start = np.where(self.room.fixed, within, low + (high - low) * rng.random(near.shape))
            if close:
                start = within + 0.25 * (start - within)
            other, said = self.solve(
                targets, indices, start, restarts=0, limits=None if limits else anywhere
            )
            other = self.room.unwound(other, near)
            far = np.where(self.room.holds(other), _distance(other, near, said), np.inf)
            nearer = far < distance
            best[nearer], distance[nearer] = other[nearer], far[nearer]
            kept[:, codes.AT_ITERATIONS] += said[:, codes.AT_ITERATIONS]
        return best, kept


def _rows(restarts: int, iterations: int) -> int:
    """How many targets are solved in one call of a kernel."""
    return int(max(STEPS // ((restarts + 1) * iterations), 1))


def _distance(q: Array, near: Array, info: Array) -> Array:
    """How far solutions are from a configuration; infinitely where they are none."""
    return np.where(
        info[:, codes.AT_STATE] == codes.SOLVED, np.linalg.norm(q - near, axis=1), np.inf
    )


def _check_numbers(settings: Settings) -> None:
    for what in ("tol_position", "tol_rotation"):
        tol = getattr(settings, what)
        real = isinstance(tol, (int, float, np.integer, np.floating)) and not isinstance(tol, bool)
        if not real or not 0 < tol < np.inf:
            raise InputError(f"{what}: expected a positive number, got {safe_repr(tol)}")
    for what, least in (("restarts", 0), ("iterations", 1), ("seed", 0)):
        number = getattr(settings, what)
        if (
            not isinstance(number, (int, np.integer))
            or isinstance(number, bool)
            or not least <= number < 2**62
        ):
            raise InputError(
                f"{what}: expected a whole number from {least} on, got {safe_repr(number)}"
            )
    for what in ("limits", "parallel"):
        if not isinstance(getattr(settings, what), (bool, np.bool_)):
            raise InputError(
                f"{what}: expected True or False, got {safe_repr(getattr(settings, what))}"
            )
