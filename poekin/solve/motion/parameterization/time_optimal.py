"""time_optimal: the fastest trajectory along a path of the coordinates within their limits."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError, join_names, safe_repr, show_numbers
from ....groups.arrays import Array, numbers
from ....model.chain import Chain
from ....model.kinematics.arm import Arm, chain_of
from ...per_coordinate import per_coordinate
from ..trajectory.hermite import peaks
from ..trajectory.trajectory import Trajectory
from .joint_spline import JointSpline, PathDerivatives, distinct_points, make_joint_spline
from .reachability import fastest, times_of

STEPS = 1000
"""Steps that the path is divided into, at least one between two of its points."""

ROUNDS = 6
EXCESS = 1.002
"""Steps in which an acceleration is above its limit by more than this are halved, so many times less one:
what is left slows down the whole trajectory.
"""

SPARE = 1 + 1e-12
"""Share of time to spare, so that rounding does not exceed a limit."""

LARGEST = 1e9
"""Largest coordinate and limit, and 1 ÷ the smallest limit: what is beyond is no robot's."""

NANOSECOND = 1e-9
"""Seconds: times are whole nanoseconds, as ROS counts them."""


class _Limits(NamedTuple):
    """Limits of speed and acceleration of values q V, per s and s²: V (m, k), the others (k,).

    The values are the coordinates, and the joints that have limits of their own.
    """

    V: Array
    speed: Array
    acceleration: Array


class _Motion(NamedTuple):
    """Rows of a trajectory: times (N,), q and dq (N, m); s (N,), where they are on the path."""

    s: Array
    times: Array
    q: Array
    dq: Array


def time_optimal(
    chain: Arm,
    q: ArrayLike,
    *,
    acceleration: Any,
    speed: Any = None,
) -> Trajectory:
    """Fastest trajectory through configurations, in order, within limits of speed and acceleration.

    The path is the cubic spline through the points, with continuous curvature; it is not left. The
    trajectory rests at both ends, not between. The arm has to be at the first point when it begins.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    q : (N, m) array_like
        Configurations, rad or m, N >= 2, as `follow` finds them; points that repeat the one before
        count once.
    acceleration : float, (m,) array_like or dict
        Largest |ddq| of each coordinate, per s²; no robot file states it, so it has no default. Of
        coupled readings it is that of the readings, as a controller takes it.
    speed : float, (m,) array_like or dict, optional
        Largest |dq| of each coordinate, per s, infinite where there is no limit; by default
        `Chain.velocity_limits`. A dict may name only some coordinates. A joint that follows several
        is no faster than its own limit, `Chain.joint_velocity_limits`, unless all of these are given.

    Returns
    -------
    trajectory : Trajectory
        Times, q and dq of about 1000 points or more.

    Raises
    ------
    ShapeError
        If q or a limit has another shape.
    InputError
        If an argument is none of those above, the points are all the same, or no limit of speed is
        known of a coordinate; the message names it.
    UnknownName
        If a dict names a coordinate that the chain has not.

    See Also
    --------
    minimum_time : Shortest time scaling of a given law.
    follow : Configurations along a path of poses.

    Notes
    -----
    Accuracy: no limit is exceeded by the cubic interpolation of the points, in float64; the
    duration is at most 1.02 times the shortest
    (tests/solve/motion/parameterization/test_time_optimal.py).
    Source: Pham and Pham 2018, TOPP-RA (reachability analysis).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> path = [[0, -1, 1, 0, 1, 0], [0.5, -1.2, 1.3, 0, 1, 0], [1, -1, 1, 0, 1, 0]]
    >>> trajectory = pk.motion.time_optimal(arm, path, speed=2.0, acceleration=4.0)
    >>> round(trajectory.duration, 2), trajectory.q.shape[1], trajectory.dq[-1].tolist()
    (1.12, 6, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    """
    given = chain_of(chain)
    points = _points(q, given)
    limits = _limits(speed, acceleration, given)
    kept = distinct_points(points)
    if len(kept) < 2:
        raise InputError("q: expected points that are not all the same: nothing moves")
    path = points[kept]
    path[-1] = points[-1]
    spline = make_joint_spline(path)
    motion = _within_limits(spline, limits)
    knot = np.searchsorted(kept, np.arange(len(points)), side="right") - 1
    return Trajectory(
        chain=given,
        times=motion.times,
        q=motion.q,
        dq=motion.dq,
        speed=limits.speed[: given.dof],
        acceleration=limits.acceleration[: given.dof],
        waypoints=np.searchsorted(motion.s, spline.knots[knot]),
    )


def _points(q: Any, chain: Chain) -> Array:
    points = numbers(q, "q")
    if points.ndim != 2 or points.shape[1] != chain.dof or len(points) < 2:
        raise ShapeError(f"q: expected shape (N, {chain.dof}), N >= 2, got {points.shape}")
    good = (np.abs(points) <= LARGEST).all(axis=1)
    if not good.all():
        k = int(np.argmin(good))
        raise InputError(
            f"q: expected numbers up to {LARGEST:g}, got {show_numbers(points[k])} in q[{k}]"
        )
    return points


def _limits(speed: Any, acceleration: Any, chain: Chain) -> _Limits:
    """Limits of speed that are given, else those of the arm. Raises: InputError."""
    names = chain.q_names
    given = names
    if speed is None or isinstance(speed, Mapping):
        given = dict(speed or {})
        speed = dict(zip(names, chain.velocity_limits.tolist(), strict=True)) | given
    speeds = per_coordinate(speed, chain, "speed")
    left = np.array([name not in given for name in names], dtype=bool)
    unknown = list(itertools.compress(names, left & np.isinf(speeds)))
    if unknown:
        raise InputError(
            f"speed: the model states no limit for {join_names(unknown)}; give one for each"
        )
    followers = chain.coupling[:, left].any(axis=1)
    own = np.flatnonzero(followers & np.isfinite(chain.joint_velocity_limits))
    speeds = np.append(speeds, chain.joint_velocity_limits[own])
    accelerations = per_coordinate(acceleration, chain, "acceleration")
    finite = np.where(np.isinf(speeds), 1.0, speeds)
    for what, values in (("speed", finite), ("acceleration", accelerations)):
        if not ((values >= 1 / LARGEST) & (values <= LARGEST)).all():
            raise InputError(
                f"{what}: expected numbers from {1 / LARGEST:g} to {LARGEST:g}, "
                f"got {safe_repr(values.tolist())}"
            )
    return _Limits(
        np.vstack([np.eye(chain.dof), chain.coupling[own]]).T,
        speeds,
        np.append(accelerations, np.full(len(own), np.inf)),
    )


def _within_limits(spline: JointSpline, limits: _Limits) -> _Motion:
    """Fastest motion along a spline, slowed down until its interpolation is within the limits."""
    s, x = _fastest(spline, limits)
    rate = np.sqrt(x)
    times = times_of(s, x)
    slower = 1.0
    while True:
        motion = _timed(spline, s, times * slower, rate / slower)
        excess = _excess(motion, limits).max()
        if excess <= 1:
            return motion
        slower *= np.sqrt(excess) * SPARE


def _fastest(spline: JointSpline, limits: _Limits) -> tuple[Array, Array]:
    """Grid s (N,) on a spline and (ds/dt)² there; finer where interpolation exceeds a limit."""
    s = _grid(spline.knots)
    for left in reversed(range(ROUNDS)):
        path = spline.at(s)
        values = PathDerivatives(*(part @ limits.V for part in path))
        x = fastest(s, values, limits.speed, limits.acceleration)
        motion = _Motion(s, times_of(s, x), path.q, path.first * np.sqrt(x)[:, None])
        worst = np.flatnonzero(_excess(motion, limits) > EXCESS)
        if not len(worst) or not left:
            break
        halves = 0.5 * (s[worst] + s[worst + 1])
        s = np.sort(np.append(s, halves))
    return s, x


def _grid(knots: Array) -> Array:
    """Knots, and points evenly between them."""
    h = np.diff(knots)
    pieces = np.ceil(h / knots[-1] * STEPS).astype(int)
    parts = [
        np.linspace(start, end, count, endpoint=False)
        for start, end, count in zip(knots[:-1], knots[1:], pieces, strict=True)
    ]
    return np.append(np.concatenate(parts), knots[-1])


def _timed(
    spline: JointSpline,
    s: Array,
    times: Array,
    rate: Array,
) -> _Motion:
    """Rows at whole nanoseconds; each is moved along the path by what its time is rounded."""
    whole = np.round(times / NANOSECOND) * NANOSECOND
    if not (np.diff(whole) > 0).all():
        raise InputError(
            "time_optimal: the limits are so large that points are less than a nanosecond apart"
        )
    late = whole - times
    at = np.clip(s + rate * late, 0.0, s[-1])
    path = spline.at(at)
    dq = path.first * rate[:, None]
    dq[[0, -1]] = 0.0
    return _Motion(s, whole, path.q, dq)


def _excess(motion: _Motion, limits: _Limits) -> Array:
    """Share (N - 1,) by which each step exceeds a limit: of the acceleration, or speed squared."""
    V = limits.V
    speed, acceleration = peaks(motion.times, motion.q @ V, motion.dq @ V)
    by_speed = (speed / limits.speed).max(axis=1)
    by_acceleration = (acceleration / limits.acceleration).max(axis=1)
    return np.maximum(by_speed**2, by_acceleration)
