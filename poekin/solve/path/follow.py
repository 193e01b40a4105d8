"""follow: joints along a path of poses, from each pose to the next without a jump."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, ShapeError, safe_repr
from ...groups.arrays import Array, numbers
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, compiled
from ...results import Progress
from ..ik.diagnosis import KIND
from ..ik.ik_problem import Settings, hashable, make_problem
from ..ik.joint_domain import first_tries
from ..ik.solution import BAD_TARGET, SOLVED, Names, Solution
from ..ik.task import TaskName, TaskNames, targets
from ..joint_units import bounds
from ..lock import items
from ..per_coordinate import per_coordinate
from .follower import Follower
from .path_interval import limits_of_joints
from .path_result import PathResult


def follow(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    poses: ArrayLike,
    *,
    q0: Any = None,
    times: ArrayLike | None = None,
    speed: Any = None,
    acceleration: Any = None,
    max_step: Any = 0.1,
    task: TaskName = "pose",
    axis: ArrayLike | None = None,
    limits: bool = True,
    lock: Mapping[str, float] | None = None,
    tol_position: float = 1e-9,
    tol_rotation: float = 1e-9,
    seed: int = 0,
    progress: Progress | None = None,
) -> PathResult:
    """Joint coordinates along a path of poses, each reached from the one before it without a jump.

    Each pose is solved from the joints of the last, without any new start. Where that fails or
    moves a coordinate by more than `max_step`, the step is taken in up to 512 pieces of the screw
    motion between the two poses, or, by an arm with too few coordinates to stay on it, beside it.
    Where that fails too, the arm cannot go on as it stands: the branch changes, to the solution
    that gets farthest along the path (of equals, the nearest), and `branch_switches` says where. A
    pose that is out of reach gets the joints within one step of the last that come nearest to it.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    poses : (N, 4, 4) array_like
        Poses of the tip in the base frame, m, in order.
    q0 : (m,) array_like or dict, optional
        Configuration from which the arm goes on, rad or m: the first pose gets the solution that is
        reached from it, else the one nearest to it. Without it, all solutions of the first pose are
        tried where `ik_all` has them all, else 8 to 32 starts; those that follow the whole path are
        preferred to all others, and of them the one whose largest step is smallest.
    times : (N,) array_like, optional
        Time of each pose, s, ascending.
    speed, acceleration : float, (m,) array_like or dict, optional
        Limits of each coordinate, per s and s², with which the differences of q over `times` are
        compared.
    max_step : float, (m,) array_like or dict, default 0.1
        Largest change of a coordinate between two poses, or pieces: a number, in rad or m of the
        joint that it moves most, or one of each coordinate in its own unit.
    task : {"pose", "position", "rotation", "direction", "planar"}, default "pose"
        Part of each pose that has to be reached, as in `ik`.
    axis : (3,) array_like, optional
        Direction of the tool for the task "direction", as in `ik`.
    limits, lock, tol_position, tol_rotation, seed : optional
        As in `ik`.
    progress : callable, optional
        Function of (done, total), called from time to time.

    Returns
    -------
    path : PathResult
        Coordinates and a report, which `print` shows. A pose of NaN gets the reason "bad target",
        and the path goes on after it.

    Raises
    ------
    PoseError
        If an element of `poses` is no pose; the message says which.
    ShapeError
        If an array does not have the shape above.
    InputError
        If an argument is none of those above, or `speed` or `acceleration` come without `times`.
    UnknownName
        If `lock` or a dict names a coordinate that the chain has not.

    See Also
    --------
    ik : Joints for single poses.
    motion : Poses along a line or a screw motion, and their timing.

    Notes
    -----
    Accuracy: `success` as of `ik`: the errors are computed anew by `Chain.fk`
    (tests/solve/path/test_follow.py).
    Source: the damped least squares of `ik`; continuation from pose to pose.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> T_s0 = arm.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    >>> T_s1 = T_s0 @ pk.se3.exp([0, 0, 0.5, 0, 0, 0.1])
    >>> path = pk.follow(arm, pk.motion.line(T_s0, T_s1, np.linspace(0, 1, 50)))
    >>> path.ok, path.q.shape
    (True, (50, 6))
    """
    fast = compiled(chain)
    path = np.array(targets(poses, "poses"), order="C")
    if path.ndim != 3:
        raise ShapeError(f"poses: expected a path (N, 4, 4), got shape {path.shape}")
    settings = Settings(
        task,
        hashable(axis, "axis"),
        limits,
        tol_position,
        tol_rotation,
        items(lock),
        weights=None,
        restarts=100,
        iterations=30,
        seed=seed,
        parallel=False,
    )
    problem = make_problem(fast, settings)
    given = fast.chain
    most = per_coordinate(max_step, given, "max_step")
    if isinstance(max_step, Mapping) or np.ndim(max_step):
        most = problem.units.of_steps(most)
    when, limit_v, limit_a = _timing(times, speed, acceleration, given, len(path))
    start = None
    if q0 is not None:
        start = first_tries(given, problem.units, problem.domain, (), 1, q0)[0]
    finite = np.asarray(np.isfinite(path).all(axis=(1, 2)))
    follower = Follower(problem, path[finite], most, progress)
    joints, broken = follower.run(start)
    return PathResult(
        chain=given,
        solution=_solution(follower, path, finite, problem.coordinates(joints)),
        branch_switches=tuple(np.flatnonzero(finite)[broken].tolist()),
        task=problem.task,
        limits=bounds(given, limits),
        times=when,
        speed=limit_v,
        acceleration=limit_a,
        lock=dict(lock or {}),
        joint_limits=limits_of_joints(given) if limits else None,
    )


def _solution(follower: Follower, path: Array, finite: np.ndarray, found: Array) -> Solution:
    """Solution of all poses, the joints `found` of the finite poses given."""
    problem = follower.problem
    at = np.flatnonzero(finite)
    count = len(path)
    q = np.full((count, problem.given.dof), np.nan)
    q[at] = found
    errors, success = problem.pose_errors(path, q)
    errors[~finite] = np.nan
    reason = np.full(count, BAD_TARGET, KIND)
    reason[success] = SOLVED
    beyond = np.zeros(count)
    hit: list[Names] = [()] * count
    tasks: list[TaskNames] = [()] * count
    for number in np.flatnonzero(~success[at]).tolist():
        k = at[number]
        reason[k], beyond[k], hit[k], tasks[k] = follower.failure(number)
    nothing = np.zeros(count, np.int64)
    return Solution(
        q,
        success,
        reason,
        errors[:, 0],
        errors[:, 1],
        nothing,
        nothing,
        beyond,
        tuple(hit),
        tuple(tasks) if problem.underactuated else (),
        problem.given,
        path,
    )


def _timing(
    times: Any,
    speed: Any,
    acceleration: Any,
    chain: Chain,
    count: int,
) -> tuple[Array | None, Array | None, Array | None]:
    """Times (N,) and the limits (m,) of speed and acceleration, where they are given."""
    if times is None:
        if speed is not None or acceleration is not None:
            raise InputError(
                "speed and acceleration: expected together with times, when each pose is to be reached"
            )
        return None, None, None
    t = numbers(times, "times")
    if t.shape != (count,):
        raise ShapeError(f"times: expected one for each pose ({count},), got shape {t.shape}")
    good = np.isfinite(t)
    good[1:] &= np.diff(t) > 0
    if not good.all():
        k = max(int(np.argmin(good)) - 1, 0)
        raise InputError(
            f"times: expected finite ascending seconds, got {safe_repr(t[k : k + 2].tolist())} from times[{k}] on"
        )
    if speed is not None:
        speed = per_coordinate(speed, chain, "speed")
    if acceleration is not None:
        acceleration = per_coordinate(acceleration, chain, "acceleration")
    return t, speed, acceleration
