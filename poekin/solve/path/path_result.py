"""Joints along a path, and a report of where it was hard or impossible."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ...analysis.dexterity.jacobian_part import scaled, svd
from ...analysis.dexterity.singularity import singularity
from ...errors import InputError, quote
from ...formats.text.atomic_write import FilePath
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.readings.coupled import joint_values
from ...results import Result
from ..ik.solution import BAD_TARGET, Solution
from ..ik.task import Task
from ..joint_units import joint_units
from ..motion.csv_io import write_joints
from ..motion.parameterization.time_optimal import time_optimal
from ..motion.plot import plot_joints
from ..motion.trajectory.trajectory import Trajectory
from .path_events import PathEvent, at_limit, events_of, exceeds, joint_at_limit, points
from .path_interval import PathInterval, intervals, intervals_at_limits

NEAR_SINGULAR = 1e-2
"""Smallest ÷ largest singular value of the Jacobian, lengths ÷ reach, below which a singularity is
met: the rates of some joints are then some hundred times those of others."""


@dataclass(frozen=True, eq=False)
class PathResult(Result):
    """Joints along a path of N poses, as `follow` finds them, and a report about them.

    Attributes
    ----------
    chain : Chain
        The arm.
    solution : Solution
        Solutions of all poses.
    branch_switches : tuple of int
        Numbers of the poses before which the branch changed, so that q jumps.
    task : Task
        Part of the poses that the tool had to reach.
    limits : (m, 2) ndarray
        Limits of the coordinates, rad or m; infinite where they do not count.
    times : (N,) ndarray or None
        Time of each pose, s.
    speed, acceleration : (m,) ndarray or None
        Limits of each coordinate, per s and s².
    lock : dict of str to float
        Locked coordinates and their values, rad or m.
    joint_limits : (n, 2) ndarray or None
        Limits of the joints' own values, rad or m; None where there are none or they do not count.
    """

    derived = (
        "q",
        "success",
        "reason",
        "position_error",
        "rotation_error",
        "ok",
        "largest_step",
        "at_limits",
        "joints_at_limits",
        "speed_violations",
        "acceleration_violations",
        "near_singular",
    )
    left_out = ("chain", "solution")

    chain: Chain
    solution: Solution
    branch_switches: tuple[int, ...]
    task: Task
    limits: Array
    times: Array | None
    speed: Array | None
    acceleration: Array | None
    lock: Mapping[str, float] = field(default_factory=dict)
    joint_limits: Array | None = None

    @property
    def q(self) -> Array:
        """Coordinates (N, m), rad or m: the nearest found where `success` is False, else of a bad NaN."""
        return self.solution.q

    @property
    def success(self) -> np.ndarray:
        """Whether the pose of q is the target within the tolerances (N,)."""
        return self.solution.success

    @property
    def reason(self) -> np.ndarray:
        """Reason of each pose (N,), as `Solution.reason`."""
        return self.solution.reason

    @property
    def position_error(self) -> Array:
        """Error of each position (N,), m, by `Chain.fk`."""
        return self.solution.position_error

    @property
    def rotation_error(self) -> Array:
        """Error of each rotation (N,), rad, by `Chain.fk`."""
        return self.solution.rotation_error

    @property
    def ok(self) -> bool:
        """Whether the arm can do it.

        Every pose is solved, no branch changes, and speed and acceleration are within limits.
        """
        return bool(self.success.all()) and not (
            self.branch_switches or self.speed_violations or self.acceleration_violations
        )

    @cached_property
    def steps(self) -> Array:
        """Largest change of a coordinate from each point to the next (N - 1,), rad or m."""
        steps = np.abs(np.diff(self.q, axis=0))
        return steps.max(axis=1, initial=0.0)

    @property
    def largest_step(self) -> float:
        """The largest of `steps`, changes of branch among them; 0 for a single pose."""
        return float(np.nanmax(self.steps, initial=0.0))

    @cached_property
    def rates(self) -> Array | None:
        """Mean rates (N - 1, m), (q_{k+1} - q_k) / (t_{k+1} - t_k); None without times."""
        if self.times is None:
            return None
        dt = np.diff(self.times)
        with np.errstate(divide="ignore", invalid="ignore"):  # of equal times
            return np.diff(self.q, axis=0) / dt[:, None]

    @cached_property
    def accelerations(self) -> Array | None:
        """Differences (N - 2, m) of `rates` ÷ the time from the middle of one step to the next.

        None without times. An error of 1e-9 in q is 4e-9 / dt^2 here.
        """
        if self.times is None or self.rates is None:
            return None
        middles = 0.5 * (self.times[1:] + self.times[:-1])
        dt = np.diff(middles)
        return np.diff(self.rates, axis=0) / dt[:, None]

    @cached_property
    def at_limits(self) -> tuple[PathInterval, ...]:
        """Intervals in which a coordinate is at its limit, `bound`; `worst` is the first point."""
        return intervals_at_limits(self.q, self.limits, self.chain.q_names)

    @cached_property
    def joints_at_limits(self) -> tuple[PathInterval, ...]:
        """Intervals in which a joint is at its own limit, `bound`; `worst` is the first point."""
        if self.joint_limits is None:
            return ()
        x = joint_values(self.chain, self.q)
        return intervals_at_limits(x, self.joint_limits, self.chain.joint_names)

    @cached_property
    def speed_violations(self) -> tuple[PathInterval, ...]:
        """Intervals in which |rates| is above the limit of speed, at the first point of a step."""
        return self._above(self.rates, self.speed, 0)

    @cached_property
    def acceleration_violations(self) -> tuple[PathInterval, ...]:
        """Intervals in which |accelerations| is above the limit, at the point between two steps."""
        return self._above(self.accelerations, self.acceleration, 1)

    @cached_property
    def inverse_condition(self) -> Array:
        """Smallest ÷ largest singular value (N,) of the Jacobian that the task asks; 0: singular.

        Smallest of the motions that the arm has at all, what is locked at rest; 1 where it has none
        that the task asks. In rad and m of the joints, lengths ÷ reach.
        Computed when it is first asked for, which takes longer than to follow the path.
        """
        units = joint_units(self.chain.compile(), bool(self.lock))
        locked = self._locked
        held = locked * units.of(np.ones(len(locked)))
        rank = self.task.generic_rank(units.fast.chain, held)
        if not rank:
            return np.ones(len(self.q))
        T, J = units.fast.chain.fk_jacobian(units.of(self.q), "hybrid")
        J = np.where(np.isnan(locked), self.task.jacobian(T, J), 0.0)
        _, s, _ = svd(scaled(J, -2, self.task.part, self.chain.reach))
        largest = s[:, 0]
        least = s[:, rank - 1]
        return np.divide(least, largest, out=np.zeros(len(s)), where=largest != 0)

    @cached_property
    def near_singular(self) -> tuple[PathInterval, ...]:
        """Intervals in which `inverse_condition` is below 0.01."""
        value = self.inverse_condition
        return tuple(intervals(value < NEAR_SINGULAR, value, -value, NEAR_SINGULAR))

    def to_csv(self, path: FilePath) -> None:
        """Writes q, and times where there are any, as `motion.read_joints` reads it.

        Parameters
        ----------
        path : path_like
            The file; it appears whole or not at all.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        write_joints(path, self.q, self.chain, times=self.times)

    def time_optimal(self, acceleration: Any, *, speed: Any = None) -> Trajectory:
        """Fastest trajectory through q within limits, as `motion.time_optimal` finds it.

        Parameters
        ----------
        acceleration : float, (m,) array_like or dict
            Largest |ddq| of each coordinate, per s².
        speed : float, (m,) array_like or dict, optional
            Largest |dq| of each coordinate, per s; by default `Chain.velocity_limits`.

        Returns
        -------
        trajectory : Trajectory
            Times, q and dq.

        Raises
        ------
        InputError
            If a pose is not reached, the branch changes, or `motion.time_optimal` refuses.
        ShapeError, UnknownName
            As `motion.time_optimal`.
        """
        missed = [event.text for event in self._missed()]
        fault = next(iter((*missed, *map(self._switch, self.branch_switches))), "")
        if fault:
            raise InputError(f"time_optimal: expected a path without a break; {fault}")
        return time_optimal(self.chain, self.q, acceleration=acceleration, speed=speed)

    def plot(self, path: FilePath | None = None) -> str:
        """Plot of the joints over time, as `motion.plot_joints` draws it.

        Parameters
        ----------
        path : path_like, optional
            File that it is written to.

        Returns
        -------
        svg : str
            The plot as SVG text.

        Raises
        ------
        MissingExtra
            If Matplotlib (extra `report`) is not installed.
        FileError
            If the file cannot be written.
        """
        return plot_joints(
            self.q,
            self.chain,
            times=self.times,
            breaks=self.branch_switches,
            path=path,
        )

    def summary(self) -> str:
        """Report, one sentence a line: poses not reached, changes of branch, limits, singularities.

        Returns
        -------
        text : str
            Errors in mm and degrees, coordinates in rad and m.
        """
        return "\n".join([self._reached(), *(event.text for event in self.events)])

    @cached_property
    def events(self) -> tuple[PathEvent, ...]:
        """All that happens on the way, kind by kind, each with its sentence."""
        return (
            *self._missed(),
            *(PathEvent(k, k, "switch", self._switch(k)) for k in self.branch_switches),
            *events_of("limit", self.at_limits, at_limit),
            *events_of("limit", self.joints_at_limits, joint_at_limit),
            *events_of("speed", self.speed_violations, lambda s: exceeds(s, "speed", "s")),
            *events_of(
                "acceleration",
                self.acceleration_violations,
                lambda s: exceeds(s, "acceleration", "s^2"),
            ),
            *events_of("singular", self.near_singular, self._singular),
        )

    def __repr__(self) -> str:
        count = len(self.branch_switches)
        changed = ""
        if count:
            changed = f", {count} change{'s' * (count > 1)} of branch"
        solved = f"{int(self.success.sum())} of {len(self.q)} poses"
        return f"<PathResult {solved}, largest step {self.largest_step:.3g}{changed}>"

    def _reached(self) -> str:
        words = f"{int(self.success.sum())} of {len(self.q)} poses reached"
        if not self.success.any():
            return words
        position = float(np.max(self.position_error[self.success]))
        rotation = float(np.max(self.rotation_error[self.success]))
        return (
            f"{words}, within {1e3 * position:.2g} mm and {np.degrees(rotation):.2g}°; "
            f"largest step {self.largest_step:.3g} (rad or m)"
        )

    def _missed(self) -> Iterator[PathEvent]:
        """Each run of poses that are not reached; bad targets are runs of their own."""
        size = np.nan_to_num(self.position_error + self.rotation_error)
        bad = self.reason == BAD_TARGET
        missed = ~self.success & ~bad
        for s in sorted(intervals(bad, size, size) + intervals(missed, size, size)):
            where = "" if s.first == s.last else f", least of all {s.worst}"
            text = f"{points(s)} not reached{where}: {self.solution.summary(s.worst)}"
            yield PathEvent(s.first, s.last, "missed", text)

    def _switch(self, k: int) -> str:
        known = np.isfinite(self.q[:k]).all(axis=1)
        before = int(np.flatnonzero(known)[-1])
        jump = np.abs(self.q[k] - self.q[before])
        return (
            f"the branch changes before pose {k}: no way on from pose {before}; the joints jump by "
            f"{jump.max():.3g}, most of it in {quote(self.chain.q_names[int(np.argmax(jump))])}"
        )

    def _singular(self, s: PathInterval) -> str:
        where = f"{points(s)}: near a singularity, most at {s.worst}"
        # `singularity` has no part with the rows of the other tasks
        if self.task.name in ("pose", "position", "rotation"):
            free = np.isnan(self._locked)
            found = singularity(
                self._moving_chain(free),
                self.q[s.worst, free],
                part=self.task.part,
            )
            if found.singular:
                return f"{where}: {found}"
            # farther off there is none: the arm is badly conditioned all the way
            if found.distance <= 1:
                return f"{where} {str(found).removeprefix('regular ')}"
        return f"{where} (smallest ÷ largest singular value {s.value:.3g})"

    @property
    def _locked(self) -> Array:
        """Values (m,) of locked coordinates, NaN for those that move."""
        return np.array([self.lock.get(name, np.nan) for name in self.chain.q_names])

    def _moving_chain(self, free: np.ndarray) -> Chain:
        """Arm whose coordinates are the free ones alone; the locked ones are constants of it."""
        if free.all():
            return self.chain
        chain = self.chain
        return chain.replace(
            coupling=chain.coupling[:, free],
            offset=chain.offset + chain.coupling @ np.where(free, 0.0, self._locked),
            q_names=[name for name in chain.q_names if name not in self.lock],
            limits=chain.limits[free],
            velocity_limits=chain.velocity_limits[free],
        )

    def _above(
        self,
        values: Array | None,
        bounds: Array | None,
        shift: int,
    ) -> tuple[PathInterval, ...]:
        """Intervals in which values are above their bounds; value number i belongs to point i +
        shift.
        """
        if values is None or bounds is None:
            return ()
        found = []
        for k, name in enumerate(self.chain.q_names):
            size = np.abs(values[:, k])
            found += intervals(size > bounds[k], size, size, bounds[k], name, shift)
        return tuple(sorted(found))
