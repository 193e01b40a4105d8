"""Inverse kinematics of one arm, asked in one way: all that does not change between targets."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...checks import KERNEL_INT, positive, true_or_false, whole
from ...engine.jit import threads
from ...engine.kernels import ik_codes as codes
from ...errors import InputError
from ...groups.arrays import Array, numbers
from ...model.chain import Chain
from ...model.kinematics.compiled import CompiledChain
from ...model.readings.coupled import beyond_own_limits
from ..chain_cache import ChainCache
from ..joint_units import JointUnits, bounds, has_sums, in_joints, joint_units
from .joint_domain import JointDomain, make_joint_domain
from .plane import plane_normal
from .task import Task, TaskName, make_task, pose_errors

STEPS = 800_000
"""Most steps of one call of a kernel, which no interrupt ends: some tenths of a second."""

MARGIN = 0.9
"""Share of a tolerance that the kernel solves to: the errors are computed anew by other kernels,
whose rounding is another."""

AGAIN = 30
"""Most times that a target is solved from other starts where a joint is beyond its own limits."""

APART = 1e9
"""Indices of a target that is solved again are so far apart: its starts are others."""

SHARED = 256
"""Most targets that a thread takes at a time."""


class Settings(NamedTuple):
    """Arguments of `ik` but for the targets and the start; arrays as tuples."""

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
    """Tuple of a user's array, to be part of a key; `make_task` refuses what is no vector."""
    if isinstance(values, (list, tuple, np.ndarray)):
        values = numbers(values, what)
        return tuple(values.tolist()) if values.ndim == 1 else values
    return values


class IKProblem:
    """Task, domain of the joints and kernel options of one arm, in joint units (`joint_units`).

    Attributes: settings; given, the user's chain; units; fast, the compiled chain in joint units;
    task; domain; underactuated, whether the task constrains more degrees of freedom than the arm
    has; has_joint_limits, whether joints have limits that the domain does not say; locked (m,), 1
    where a coordinate keeps its value; options, as the kernels take them.
    """

    def __init__(self, fast: CompiledChain, settings: Settings) -> None:
        _check_numbers(settings)
        from ...engine.kernels import ik_kernels  # imports Numba

        self.settings = settings
        self.given = fast.chain
        self.units = joint_units(fast, bool(settings.lock))
        self.fast = self.units.fast
        self.domain = make_joint_domain(self.units, settings.lock, settings.limits)
        self.task = _task(settings, self.fast.chain, self.domain)
        free = int((~self.domain.locked).sum())
        self.underactuated = free < self.task.constrained_dof
        self.locked = self.domain.locked.astype(float)
        self.options = kernel_options(
            self.task,
            MARGIN * settings.tol_position,
            MARGIN * settings.tol_rotation,
            settings.iterations,
            settings.restarts,
        )
        self._solve = ik_kernels.solve_many
        self._error_parts = ik_kernels.error_parts
        own = self.fast.chain.joint_limits
        limited = np.isfinite(own).any()
        self.has_joint_limits = bool(settings.limits and limited)
        self._address = self.fast.hybrid_address
        self._tolerances = np.array([settings.tol_position, settings.tol_rotation])
        self._rows = _rows(settings.restarts, settings.iterations)

    @cached_property
    def generic_rank(self) -> int:
        """Number of the task's degrees of freedom that the arm can serve by what may move."""
        return self.task.generic_rank(self.fast.chain, self.domain.locked_values)

    @cached_property
    def by_joints(self) -> JointUnits | None:
        """The arm in the values of its joints, where they have limits that the domain does not say."""
        chain = self.fast.chain
        if not self.has_joint_limits or self.domain.locked.any():
            return None
        return in_joints(chain) if has_sums(chain) else None

    def coordinates(self, u: Array) -> Array:
        """The user's coordinates q (..., m) of joint units u (..., m)."""
        if self.units.scale is None:
            return u
        limits = bounds(self.given, self.settings.limits)
        q = self.units.coordinates(u, limits)
        for name, value in self.settings.lock or ():  # to the last digit
            k = self.given.q_names.index(name)
            unknown = np.isnan(q).any(axis=-1)
            q[..., k] = np.where(unknown, np.nan, value)
        return q

    def pose_errors(self, targets: Array, q: Array) -> tuple[Array, np.ndarray]:
        """Errors of q (N, 2) in m and rad by the kernels of any chain; whether the tolerances
        hold (N,), and the joints' own limits.
        """
        errors = pose_errors(self.given, self.task, q, targets)
        within = errors <= self._tolerances
        accepted = within[:, 0] & within[:, 1]
        return errors, accepted & self.keeps_joints(self.units.of(q))

    def keeps_joints(self, u: Array) -> np.ndarray:
        """Whether joints are within their own limits (...), where the domain does not say them."""
        if not self.has_joint_limits:
            return np.array(True)
        beyond = beyond_own_limits(self.fast.chain, u)
        return np.asarray(~beyond.any(axis=-1))

    def contains(self, u: Array) -> np.ndarray:
        """Whether configurations (..., m) are within the limits (...), the joints' own too."""
        return self.domain.contains(u) & self.keeps_joints(u)

    def error(self, T: Array, target: Array, J: Array) -> Array:
        """Error (6,), rotation first, between two poses; J loses what the task leaves free."""
        e = np.empty(6)
        task = self.task
        self._error_parts(task.code, task.axis, T, target, J, e)
        return e

    def with_task(self, name: TaskName) -> IKProblem:
        """Problem that differs in its task. Raises: InputError where the arm has no plane for it."""
        settings = self.settings._replace(task=name, axis=None)
        return make_problem(self.given.compile(), settings)

    def solve_one(self, target: Array, start: Array) -> tuple[Array, Array] | None:
        """q (m,) and info of one target (4, 4) that the first try reaches from a start (m,); None
        where it does not, or `solve` is needed.
        """
        if self._one is None:
            return None
        q = np.empty(self.fast.dof)
        info = np.empty(codes.INFO)
        kernel, before, after = self._one
        if kernel.call(*before, target, start, *after, q, info):
            return q, info
        return None

    @cached_property
    def _one(self) -> Any:
        """Kernel of `solve_one` and its arguments before and after target and start; None where q
        has other units than the kernel's, or joints have limits of their own.
        """
        if self.has_joint_limits or self.units.scale is not None:
            return None
        from ...engine.kernels import ik_kernels  # imports Numba

        domain = self.domain
        limits = np.ascontiguousarray(domain.limits)
        before = (self._address, self.given.kernel_table)
        asked = (limits, self.locked, self.options, self._tolerances)
        return ik_kernels.solve_one, before, (*asked, domain.unbounded_periods)

    def solve(
        self,
        targets: Array,
        indices: Array,
        q0: Array,
        **options: Any,
    ) -> tuple[Array, Array]:
        """q and info of targets, whose indices in the batch are given, from q0; NaN there means
        anywhere. Options: restarts, limits, ranges.
        """
        q, info = self._solved(targets, indices, q0, **options)
        checked = self.has_joint_limits and options.get("limits") is None
        for turn in range(1, AGAIN if checked else 1):
            solved = info[:, codes.AT_STATE] == codes.SOLVED
            beyond = solved & ~self.keeps_joints(q)
            if not beyond.any():
                break
            other = indices[beyond] + turn * APART
            start = self.domain.anywhere(len(other))
            again = self._solved(targets[beyond], other, start, **options)
            q[beyond], info[beyond] = again
        return q, info

    def _solved(
        self,
        targets: Array,
        indices: Array,
        q0: Array,
        *,
        restarts: int | None = None,
        limits: Array | None = None,
        ranges: Array | None = None,
    ) -> tuple[Array, Array]:
        """q and info of the best try of each target."""
        options = self.options
        rows = self._rows
        if restarts is not None:
            options = options.copy()
            options[codes.RESTARTS] = restarts
            rows = _rows(restarts, self.settings.iterations)
        count = len(targets)
        q = np.empty((count, self.fast.dof))
        info = np.empty((count, codes.INFO))
        limits = self.domain.limits if limits is None else limits
        ranges = self.domain.ranges if ranges is None else ranges

        def run(targets: Array, q0: Array, indices: Array, q: Array, info: Array) -> None:
            asked = (limits, ranges, self.locked, options, indices)
            solved = (self.settings.seed, q, info)
            self._solve.call(self._address, targets, q0, *asked, *solved)

        arrays = (targets, q0, indices, q, info)
        if len(targets) <= rows:
            run(*arrays)
        elif self.settings.parallel:
            threads.share_out(run, *arrays, rows=min(rows, SHARED))
        else:
            for start in range(0, len(targets), rows):
                run(*(a[start : start + rows] for a in arrays))
        return q, info


_PROBLEMS: ChainCache[IKProblem] = ChainCache()


def make_problem(fast: CompiledChain, settings: Settings) -> IKProblem:
    """Problem of an arm with these settings, made once and kept. Raises: InputError, UnknownName,
    ShapeError.
    """
    # 1 == True, and 100.0 == 100: settings of another type must not be found
    key = (settings, *map(type, settings))
    try:
        kept = _PROBLEMS.get(fast, key)
    except TypeError:  # no number, and so no key: the checks say what it is
        kept = None
    return kept or _PROBLEMS.keep(fast, IKProblem(fast, settings), key)


def _task(settings: Settings, chain: Chain, domain: JointDomain) -> Task:
    task = make_task(settings.task, settings.axis, settings.weights)
    if domain.locked.all():
        which = "none" if not chain.dof else "all of them locked"
        raise InputError(f"expected an arm with a coordinate that may move, the chain has {which}")
    if task.name != "planar":
        return task
    return replace(task, axis=plane_normal(chain, domain))


def kernel_options(
    task: Task,
    tol_position: float,
    tol_rotation: float,
    iterations: int,
    restarts: int = 0,
) -> Array:
    """Options of the kernel's descent, see `ik_codes`."""
    options = np.zeros(codes.OPTIONS)
    options[codes.TOL_POSITION] = tol_position
    options[codes.TOL_ROTATION] = tol_rotation
    options[codes.ITERATIONS] = iterations
    options[codes.RESTARTS] = restarts
    options[codes.TASK] = task.code
    options[codes.AXIS : codes.AXIS + 3] = task.axis
    options[codes.WEIGHTS :] = task.weights
    return options


def _rows(restarts: int, iterations: int) -> int:
    """Number of targets of one call of a kernel."""
    return max(STEPS // ((restarts + 1) * iterations), 1)


def _check_numbers(settings: Settings) -> None:
    values = settings._asdict()
    for what in ("tol_position", "tol_rotation"):
        positive(values[what], what)
    for what, least in (("restarts", 0), ("iterations", 1), ("seed", 0)):
        whole(values[what], what, least, KERNEL_INT)
    for what in ("limits", "parallel"):
        true_or_false(values[what], what)
