"""Follower: one path of poses, followed by the compiled descent, in pieces where a step is long,
then anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from ...engine.kernels import ik_codes as codes
from ...groups.arrays import Array
from ...groups.vectors import norm
from ...model.kinematics.compiled import CompiledChain
from ...model.readings.coupled import WITHIN
from ...results import Progress
from ..ik.choice.every_solution import every_solution
from ..ik.ik_problem import IKProblem
from ..ik.least_error import least_error, slope_at
from ..ik.solution import ITERATIONS, Names, Solution
from ..ik.solver import solve
from ..ik.task import TaskNames
from ..joint_units import JointUnits
from ..motion import paths

PIECES = (8, 64, 512)
"""A step that is too long is divided into so many pieces, and then so many, before it counts as a
change of branch.
"""

ROUNDS = 4
TRIES = 8
"""Starts are looked for in so many rounds, the first where all solutions are known one of these,
else of so many tries, until one of them follows the whole path.
"""

AT_ONCE = 64
"""Poses that a start is followed over before another may be better."""


@dataclass(eq=False)
class _Way:
    """A start, rows[0], and the joints of `done` poses from pose `first` on; `jump` is what it has
    moved at most, and it is `stuck` where it does not go on.
    """

    first: int
    rows: Array
    jump: float
    done: int = 0
    stuck: bool = False

    @property
    def end(self) -> int:
        return self.first + self.done

    @property
    def q(self) -> Array:
        return self.rows[1 : 1 + self.done]


@dataclass(eq=False)
class Follower:
    """One path of finite poses, and what is known of it; all joints are in joint units
    (`joint_units`).
    """

    problem: IKProblem
    targets: Array
    most: Array
    progress: Progress | None
    _known: tuple[int, Solution] | None = None

    def run(self, q0: Array | None) -> tuple[Array, list[int]]:
        """q (N, m), and before which poses the branch changed."""
        count = len(self.targets)
        q = np.empty((count, len(self.most)))
        changes = []
        k = 0
        last = q0
        while k < count:
            if self.progress is not None:
                self.progress(k, count)
            end = k
            part = q[:0]
            if last is not None:
                end, part = self.on(k, last, first=k == 0)
            if end == k:
                end, part = self.best(k, last)
                if end > k and k > 0:
                    changes.append(k)
            if end == k:  # out of reach: as near as it gets
                end = k + 1
                part = self._near(k, last)
            q[k:end] = part
            k = end
            last = part[-1]
        if self.progress is not None:
            self.progress(count, count)
        return q, changes

    def on(self, k: int, last: Array, first: bool) -> tuple[int, Array]:
        """The path from pose k on as far as it goes without a jump, beginning at joints `last`; its
        end, and q.
        """
        way = self._way(k, last)
        self._extend(way, len(self.targets), first)
        return way.end, way.q

    def best(self, k: int, last: Array | None) -> tuple[int, Array]:
        """The one of several solutions of pose k that gets farthest, and then jumps and moves
        least; its end, and q.
        """
        ways: list[_Way] = []
        found = self._way(k, self.most)
        asked = self._known is not None and self._known[0] <= k
        if asked and not self._solved(k):
            return k, found.q
        for turn in range(ROUNDS):
            for q0 in self._solutions(k, turn, last):
                if not any(_same(way.rows[0], q0) for way in ways):
                    jump = 0.0 if last is None else norm(q0 - last)
                    ways.append(self._way(k, q0, jump))
            self._race(ways, last is None)
            if ways:
                found = max(ways, key=lambda way: (way.done, -way.jump))
            at_end = found.end == len(self.targets)
            if at_end or not self._solved(found.end):
                break
        return found.end, found.q

    def _way(self, k: int, start: Array, jump: float = 0.0) -> _Way:
        count = len(self.targets) - k
        rows = np.empty((count + 1, len(start)))
        rows[0] = start
        return _Way(k, rows, jump)

    def _race(self, ways: list[_Way], moving: bool) -> None:
        """Follow ways, each time the one that jumps least so far, until that one is at the end: all
        others jump more already. Where `moving`, every step counts as a jump.
        """
        while running := [way for way in ways if not way.stuck]:
            way = min(running, key=lambda way: way.jump)
            if way.end == len(self.targets):
                break
            before = max(way.done - 1, 0)
            self._extend(way, way.end + AT_ONCE)
            if moving:
                ahead = np.diff(way.q[before:], axis=0)
                steps = np.abs(ahead)
                way.jump = float(steps.max(initial=way.jump))

    def _extend(self, way: _Way, stop: int, first: bool = False) -> None:
        """Follow a way up to pose `stop`, or as far as it goes; where `first`, its first pose is at
        any distance from the start.
        """
        targets = self.targets[way.first : stop]
        rows = way.rows
        done = way.done
        while done < len(targets):
            rest = rows[done + 1 :]
            at_start = first and not done
            done += self._descend(targets[done:], rows[done], rest, at_start)
            if done in (0, len(targets)):
                break
            last = rows[done]
            next_q = self._in_pieces(last, targets[done - 1], targets[done])
            if next_q is None:
                break
            done += 1
            rows[done] = next_q
        way.done = done
        way.stuck = done < len(targets)

    def failure(self, k: int) -> tuple[str, float, Names, TaskNames]:
        """Cause for which pose k is not reached: its entries in `Causes`."""
        solution, at = self._solution_of(k)
        if solution.success[at]:
            return ITERATIONS, 0.0, (), ()
        tasks = solution.reachable_tasks[at] if solution.reachable_tasks else ()
        beyond = float(solution.distance_beyond_reach[at])
        reason = str(solution.reason[at])
        return reason, beyond, solution.limits_hit[at], tasks

    def _descend(
        self,
        targets: Array,
        start: Array,
        q: Array,
        anywhere: bool = False,
    ) -> int:
        """Number of targets that are followed from `start`; where `anywhere`, the first of them at
        any distance from it.
        """
        if anywhere:
            any_step = np.full_like(start, np.inf)
            done = self._steps(targets[:1], start, q, any_step)
            if not done:
                return 0
            return 1 + self._descend(targets[1:], q[0], q[1:])
        done = self._steps(targets, start, q, self.most)
        joints = self.problem.by_joints
        slid = 1
        while joints is not None and slid and done < len(targets):
            # Joints' own limits in the way: along them a path slides in the values of the joints.
            last = q[done - 1] if done else start
            slid = self._slide(joints, targets[done:], last, q[done:])
            done += slid
            if slid and done < len(targets):
                last = q[done - 1]
                done += self._steps(targets[done:], last, q[done:], self.most)
        return done

    def _steps(
        self,
        targets: Array,
        start: Array,
        q: Array,
        most: Array,
    ) -> int:
        """Number of targets that are followed from `start` until a joint leaves its own limits."""
        limits = self.problem.domain.limits
        done = self._kernel(self.problem.fast, targets, start.copy(), limits, most, q)
        kept = self.problem.keeps_joints(q[:done])
        return _until(~np.asarray(kept), done)

    def _slide(
        self,
        joints: JointUnits,
        targets: Array,
        start: Array,
        q: Array,
    ) -> int:
        """Number of targets that are followed in the values of the joints, until a coordinate
        leaves its limits.
        """
        fast = joints.fast
        x = np.empty_like(q)
        most = joints.of_steps(self.most)
        limits = fast.chain.limits.copy()
        start = joints.of(start)
        done = self._kernel(fast, targets, start, limits, most, x)
        found = joints.coordinates(x[:done], np.array([-np.inf, np.inf]))
        within = np.clip(found, *self.problem.domain.limits.T)
        q[:done] = within
        rounding = WITHIN * (1 + np.abs(found))
        apart = np.any(np.abs(found - within) > rounding, axis=1)
        return _until(np.asarray(apart), done)

    def _kernel(
        self,
        fast: CompiledChain,
        targets: Array,
        start: Array,
        limits: Array,
        most: Array,
        q: Array,
    ) -> int:
        """Number of targets that the compiled descent follows."""
        from ...engine.kernels import follow_kernels  # imports Numba

        info = np.empty((len(targets), codes.INFO))
        asked = (limits, self.problem.locked, self.problem.options, most)
        address = fast.hybrid_address
        return follow_kernels.follow.call(address, targets, start, *asked, q, info)

    def _in_pieces(
        self,
        q_a: Array,
        T_a: Array,
        T_b: Array,
    ) -> Array | None:
        """The joints at T_b, by smaller and smaller steps from q_a at T_a; None where no step is
        small enough.
        """
        for pieces in PIECES:
            s = np.arange(1, pieces + 1) / pieces
            between = paths.screw(T_a, T_b, s)
            q = np.empty((pieces, len(self.most)))
            if self.problem.underactuated:
                beside = self._beside(between[:-1], q_a)
                only = q[-1:]
                if self._descend(between[-1:], beside, only):
                    return q[-1]
            elif self._descend(between, q_a, q) == pieces:
                return q[-1]
        return None

    def _beside(self, poses: Array, q: Array) -> Array:
        """Joints at the last of some poses, as near to each as one step from the one before gets.

        An arm with few coordinates reaches the ends of a screw motion, and seldom what is between.
        """
        for target in poses:
            q = self._towards(target, q)
        return q

    def _near(self, k: int, last: Array | None) -> Array:
        """Joints (1, m) as near to pose k as they get within one step of the last ones, else the
        nearest of `ik`.
        """
        if last is None:
            solution, at = self._solution_of(k)
            return self.problem.units.of(solution.q[[at]])
        return self._towards(self.targets[k], last)[None]

    def _towards(self, target: Array, q: Array) -> Array:
        """Joints (m,) as near to a pose as they get within one step of q; q where one would leave
        limits of its own.
        """
        domain = self.problem.domain
        low = np.clip(q - self.most, *domain.limits.T)
        high = np.clip(q + self.most, *domain.limits.T)
        slope = partial(slope_at, self.problem, target)
        near = least_error(slope, q, domain.held(low), domain.held(high))
        return np.where(self.problem.keeps_joints(near), near, q)

    def _solutions(
        self,
        k: int,
        turn: int,
        last: Array | None,
    ) -> Array:
        """Solutions of pose k: first all of them where they are known, whole turns away towards the
        last joints or the middle of the limits; else the nearest to the last joints, then of random
        starts.
        """
        domain = self.problem.domain
        beside = domain.ranges.mean(axis=1) if last is None else last
        if turn == 0:
            target = self.targets[k : k + 1]
            every = every_solution(self.problem, target, beside[None])
            if every is not None and every.complete.all() and len(every.u):
                return every.u
        T = np.tile(self.targets[k], (TRIES, 1, 1))
        number = np.arange(TRIES, dtype=float) + TRIES * turn
        anywhere = domain.anywhere(TRIES)
        q, info = self.problem.solve(T, number, anywhere, restarts=10)
        solved = info[:, codes.AT_STATE] == codes.SOLVED
        q = q[solved]
        if turn % 2 == 0:  # turns are taken off, towards the middle of the limits; else as they are
            q = domain.wrapped(q, beside)
        if last is not None and turn == 0:
            here = self.problem.coordinates(last)
            near = solve(self.problem, self.targets[k], nearest_to=here)
            if near.success:
                nearest = self.problem.units.of(near.q)
                q = np.vstack([nearest, q])
        if not len(q) and self._solved(k):
            return self._near(k, None)
        return q

    def _solved(self, k: int) -> bool:
        solution, at = self._solution_of(k)
        return bool(solution.success[at])

    def _solution_of(self, k: int) -> tuple[Solution, int]:
        """Solutions by `ik` of pose k and all that follow, asked once; and where k stands there."""
        if self._known is None or self._known[0] > k:
            solution = solve(self.problem, self.targets[k:])
            self._known = k, solution
        first, solution = self._known
        return solution, k - first


def _same(start: Array, other: Array) -> bool:
    """Whether two starts are one."""
    return bool(np.abs(start - other).max() < 1e-6)


def _until(left: np.ndarray, done: int) -> int:
    """Number of `done` poses before the first that left its limits."""
    beyond = np.flatnonzero(left)
    return min([done, *beyond.tolist()])
