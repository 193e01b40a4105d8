"""What became of a path that was followed: the joints, and a report of where it was hard or
impossible.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...analysis.dexterity.manipulability import scaled, svd
from ...analysis.dexterity.singularity import singularity
from ...errors import quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ..ik.diagnosis import AT_LIMIT
from ..ik.joint_units import joint_units
from ..ik.solution import BAD_TARGET, Solution
from ..ik.task import Task
from ..motion.csv_io import write_joints
from ..motion.plot import plot_joints

NEAR_SINGULAR = 1e-2
"""Smallest ÷ largest singular value of the Jacobian, lengths ÷ reach, below which a singularity is
met: the rates of some joints are then some hundred times those of others."""


class Stretch(NamedTuple):
    """Points first ... last of a path, in a row: name, of the coordinate ("" for all of them
    together); value, the worst of them, at the point `worst`; bound, what it is held against.
    """

    first: int
    last: int
    name: str
    worst: int
    value: float
    bound: float


@dataclass(frozen=True, eq=False)
class Followed:
    """Joints along a path of N poses, as `follow` finds them, and what is to be said about them.

    chain; solution, of all poses: `q` (N, m), rad or m, `success`, `reason`, `position_error`,
    `rotation_error` (N,) are also attributes here; changes, the numbers of the poses before which
    the branch changed, so that q jumps; task, what the poses ask for; limits (m, 2); times (N,), s,
    speed and acceleration, limits (m,), where they were given. `print` of it says all of this in
    words.
    """

    chain: Chain
    solution: Solution
    changes: tuple[int, ...]
    task: Task
    limits: Array
    times: Array | None
    speed: Array | None
    acceleration: Array | None

    @property
    def q(self) -> Array:
        """(N, m), rad or m; where `success` is False, the nearest that was found; NaN for a bad
        target.
        """
        return self.solution.q

    @property
    def success(self) -> np.ndarray:
        """(N,): the pose of q is the target within the tolerances."""
        return self.solution.success

    @property
    def reason(self) -> np.ndarray:
        """(N,): one of `solution.REASONS`."""
        return self.solution.reason

    @property
    def position_error(self) -> Array:
        """(N,), m, by `Chain.fk`."""
        return self.solution.position_error

    @property
    def rotation_error(self) -> Array:
        """(N,), rad, by `Chain.fk`."""
        return self.solution.rotation_error

    @property
    def ok(self) -> bool:
        """Whether the arm can do it: every pose solved, no change of branch, speed and acceleration
        within limits.
        """
        return bool(self.success.all()) and not (self.changes or self.too_fast or self.too_hard)

    @cached_property
    def steps(self) -> Array:
        """(N - 1,): how far the coordinate that moves most moves from each point to the next, rad
        or m.
        """
        return np.abs(np.diff(self.q, axis=0)).max(axis=1, initial=0.0)

    @property
    def largest_step(self) -> float:
        """The largest of `steps`, changes of branch among them; 0 for a single pose."""
        return float(np.nanmax(self.steps, initial=0.0))

    @cached_property
    def rates(self) -> Array | None:
        """(N - 1, m): (q_{k+1} - q_k) / (t_{k+1} - t_k), the mean rate between two points; None
        without times.
        """
        return (
            None if self.times is None else np.diff(self.q, axis=0) / np.diff(self.times)[:, None]
        )

    @cached_property
    def accelerations(self) -> Array | None:
        """(N - 2, m): differences of `rates` ÷ the time from the middle of one step to that of the
        next.

        An error of 1e-9 in q is 4e-9 / dt^2 here.
        """
        if self.times is None or self.rates is None:
            return None
        middles = 0.5 * (self.times[1:] + self.times[:-1])
        return np.diff(self.rates, axis=0) / np.diff(middles)[:, None]

    @cached_property
    def at_limits(self) -> tuple[Stretch, ...]:
        """Where a coordinate is at its limit: `worst` is the first point, `bound` the limit."""
        found = []
        for k, name in enumerate(self.chain.q_names):
            for bound in self.limits[k]:
                off = (
                    np.abs(self.q[:, k] - bound)
                    if np.isfinite(bound)
                    else np.full(len(self.q), np.inf)
                )
                found += _stretches(
                    off <= AT_LIMIT, -off, name, lambda i, k=k, bound=bound: (self.q[i, k], bound)
                )
        return tuple(sorted(found))

    @cached_property
    def too_fast(self) -> tuple[Stretch, ...]:
        """Where |rates| is above the limit of speed, at the first point of a step."""
        return self._above(self.rates, self.speed, 0)

    @cached_property
    def too_hard(self) -> tuple[Stretch, ...]:
        """Where |accelerations| is above the limit, at the point between two steps."""
        return self._above(self.accelerations, self.acceleration, 1)

    @cached_property
    def regularity(self) -> Array:
        """(N,): smallest ÷ largest singular value of the Jacobian of what the task asks, in rad and
        m of the joints, lengths ÷ reach; 0: singular.

        Computed when it is first asked for, which takes longer than to follow the path.
        """
        units = joint_units(self.chain.compile())
        J = self.task.jacobian(*units.fast.chain.fk_jacobian(units.of(self.q), "hybrid"))
        s = svd(scaled(J, -2, self._part(), self.chain.reach))[1]
        last = min(self.task.holds, self.chain.dof) - 1
        return np.divide(s[..., last], s[..., 0], out=np.zeros(len(s)), where=s[..., 0] != 0)

    @cached_property
    def near_singular(self) -> tuple[Stretch, ...]:
        """Where `regularity` is below 0.01."""
        value = self.regularity
        return tuple(
            _stretches(value < NEAR_SINGULAR, -value, "", lambda i: (value[i], NEAR_SINGULAR))
        )

    def why(self, k: int) -> str:
        """What is to be said of pose k, in words. Raises: IndexError."""
        return self.solution.why(range(len(self.q))[k])

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write q, and times where there are any, as `motion.read_joints` reads it. Raises:
        FileError.
        """
        write_joints(path, self.q, self.chain, times=self.times)

    def plot(self, path: str | os.PathLike[str] | None = None) -> str:
        """The joints over time as SVG text, and into a file; as `motion.plot_joints`. Raises as
        that.
        """
        return plot_joints(self.q, self.chain, times=self.times, breaks=self.changes, path=path)

    def sentences(self) -> list[str]:
        """The report, a sentence each."""
        count, solved = len(self.q), int(self.success.sum())
        off = [
            float(np.max(e[self.success], initial=0.0))
            for e in (self.position_error, self.rotation_error)
        ]
        said = [
            f"{solved} of {count} poses reached, within {1e3 * off[0]:.2g} mm and {1e3 * off[1]:.2g} mrad; "
            f"largest step {self.largest_step:.3g} (rad or m)"
        ]
        size = np.nan_to_num(self.position_error + self.rotation_error)
        bad = self.reason == BAD_TARGET
        for first, last in sorted(_runs(bad) + _runs(~self.success & ~bad)):
            worst = first + int(np.argmax(size[first : last + 1]))
            where = "" if first == last else f", least of all {worst}"
            said.append(f"{_points(first, last)} not reached{where}: {self.why(worst)}")
        for k in self.changes:
            before = int(np.flatnonzero(np.isfinite(self.q[:k]).all(axis=1))[-1])
            jump = np.abs(self.q[k] - self.q[before])
            said.append(
                f"the branch changes before pose {k}: no way on from pose {before}; the joints jump by "
                f"{jump.max():.3g}, most of it in {quote(self.chain.q_names[int(np.argmax(jump))])}"
            )
        for s in self.at_limits:
            said.append(f"{_points(s.first, s.last)}: {quote(s.name)} at its limit {s.bound:.6g}")
        for what, unit, stretches in (
            ("speed", "s", self.too_fast),
            ("acceleration", "s^2", self.too_hard),
        ):
            for s in stretches:
                said.append(
                    f"{_points(s.first, s.last)}: {quote(s.name)} exceeds its {what}, {s.value:.4g} of {s.bound:.4g} "
                    f"(rad or m)/{unit} at {s.worst}"
                )
        for s in self.near_singular:
            words = singularity(self.chain, self.q[s.worst], part=self._part()).words
            said.append(
                f"{_points(s.first, s.last)}: near a singularity, most at {s.worst}: {words}"
            )
        return said

    def __str__(self) -> str:
        return "\n".join(self.sentences())

    def __repr__(self) -> str:
        count = len(self.changes)
        changed = f", {count} change{'s' * (count > 1)} of branch" if count else ""
        solved = f"{int(self.success.sum())} of {len(self.q)} poses"
        return f"<Followed {solved}, largest step {self.largest_step:.3g}{changed}>"

    def _part(self) -> str:
        return {"position": "translation", "rotation": "rotation"}.get(self.task.name, "pose")

    def _above(self, values: Array | None, bounds: Array | None, shift: int) -> tuple[Stretch, ...]:
        """Where values are above their bounds; value number i belongs to point i + shift."""
        found = []
        if values is not None and bounds is not None:
            for k, name in enumerate(self.chain.q_names):
                size, bound = np.abs(values[:, k]), float(bounds[k])
                for s in _stretches(
                    size > bound, size, name, lambda i, size=size, bound=bound: (size[i], bound)
                ):
                    found.append(
                        s._replace(
                            first=s.first + shift, last=s.last + shift, worst=s.worst + shift
                        )
                    )
        return tuple(sorted(found))


def _runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]


def _stretches(mask: np.ndarray, badness: Array, name: str, say) -> list[Stretch]:  # type: ignore[no-untyped-def]
    """A Stretch for each run of True; the worst point of it is where `badness` is largest."""
    found = []
    for first, last in _runs(mask):
        worst = first + int(np.argmax(badness[first : last + 1]))
        value, bound = say(worst)
        found.append(Stretch(first, last, name, worst, float(value), float(bound)))
    return found


def _points(first: int, last: int) -> str:
    return f"pose {first}" if first == last else f"poses {first} to {last}"
