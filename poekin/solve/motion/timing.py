"""Time scaling: s(t) from 0 to 1 with its rates, at rest at both ends, and the shortest one that
keeps given limits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import choice, is_real
from ...errors import InputError, ShapeError, safe_repr
from ...groups.arrays import Array, numbers

Law = Literal["cubic", "quintic", "trapezoidal"]
# of s' (1/T) and |s''| (1/T^2)
_PEAKS = {"cubic": (1.5, 6.0), "quintic": (1.875, 10 / math.sqrt(3))}
_INSTANT = 1e-100  # s: what takes less takes no time, as its rates would be no numbers
_SPARE = 1 + 4e-15  # so that what is computed of a timing keeps the limits to the last digit


class TimingSample(NamedTuple):
    """Values of a time scaling at some times; arrays of the shape of t.

    Of a path x(s) that is even in s, x' = ds dx/ds and x'' = dds dx/ds.

    Attributes
    ----------
    s : (...) ndarray
        Parameter of the path, 0 to 1.
    ds : (...) ndarray
        Its rate s', 1/s.
    dds : (...) ndarray
        Its second rate s'', 1/s².
    """

    s: Array
    ds: Array
    dds: Array


@dataclass(frozen=True)
class Timing:
    """Time scaling s(t) over 0 <= t <= duration, at rest before and after.

    A call with t (...), s, gives the `TimingSample` there. s' is symmetric about the middle: s(T -
    t) = 1 - s(t). With u = t / T:

    - cubic: s = 3 u² - 2 u³: at most s' = 1.5 / T in the middle, |s''| = 6 / T² at the ends
    - quintic: s = 10 u³ - 15 u⁴ + 6 u⁵: s'' = 0 at the ends; at most s' = 1.875 / T, |s''| =
      5.78 / T²
    - trapezoidal: s'' = ±1 / (r (1 - r) T²) for r T at either end, r = acceleration_fraction, and
      s' = 1 / ((1 - r) T) between

    Parameters
    ----------
    law : {"cubic", "quintic", "trapezoidal"}
        Form of s(t).
    duration : float
        Duration T, s.
    acceleration_fraction : float, default 0.5
        Part of the duration for which the trapezoidal law speeds up, and slows down.

    Raises
    ------
    InputError
        If a time of the call is no number.
    """

    law: Law
    duration: float
    acceleration_fraction: float = 0.5

    def __call__(self, t: ArrayLike) -> TimingSample:
        """s, s' and s'' at t (...), s. Raises: InputError."""
        t = numbers(t, "t")
        if self.duration == 0:
            s = np.heaviside(t, 1.0)
            return TimingSample(s, 0.0 * s, 0.0 * s)
        u = np.clip(t / self.duration, 0.0, 1.0)
        # the first half: the other one is its mirror, so that s ends at 1 exactly
        h = np.minimum(u, 1.0 - u)
        s, ds, dds = self._half(h)
        late = u > 0.5
        moving = (t >= 0) & (t <= self.duration)
        s = np.where(late, 1.0 - s, s)
        dds = np.where(late, -dds, dds)
        rest = np.where(np.isnan(t), np.nan, 0.0)
        ds = np.where(moving, ds / self.duration, rest)
        dds = np.where(moving, dds / self.duration / self.duration, rest)
        return TimingSample(s, ds, dds)

    def _half(self, h: Array) -> tuple[Array, Array, Array]:
        """s, s' and s'' over u = t / T, for u <= 1/2."""
        if self.law == "cubic":
            s = h * h * (3 - 2 * h)
            ds = 6 * h * (1 - h)
            return s, ds, 6 - 12 * h
        if self.law == "quintic":
            s = h**3 * (10 + h * (6 * h - 15))
            ds = 30 * (h * (1 - h)) ** 2
            dds = 60 * h * (1 - h) * (1 - 2 * h)
            return s, ds, dds
        r = self.acceleration_fraction
        top = 1 / (1 - r)
        speeding = h <= r
        even = top * (h - 0.5 * r)
        s = np.where(speeding, 0.5 * top / r * h * h, even)
        ds = np.where(speeding, top / r * h, top)
        # where there is no even part, the middle belongs to both ramps
        return s, ds, np.where(speeding, top / r, 0.0)


def cubic(duration: float) -> Timing:
    """Cubic time scaling s = 3 u² - 2 u³, u = t / duration: at rest at both ends.

    Parameters
    ----------
    duration : float
        Duration, s.

    Returns
    -------
    timing : Timing
        The time scaling.

    Raises
    ------
    InputError
        If the duration is no positive number.
    """
    return Timing("cubic", _duration(duration))


def quintic(duration: float) -> Timing:
    """Quintic time scaling s = 10 u³ - 15 u⁴ + 6 u⁵, u = t / duration, without jerks at the ends.

    It is at rest and without acceleration at both ends.

    Parameters
    ----------
    duration : float
        Duration, s.

    Returns
    -------
    timing : Timing
        The time scaling.

    Raises
    ------
    InputError
        If the duration is no positive number.
    """
    return Timing("quintic", _duration(duration))


def trapezoidal(duration: float, acceleration_fraction: float = 0.25) -> Timing:
    """Trapezoidal time scaling: s' rises evenly, stays, and falls as it rose.

    Parameters
    ----------
    duration : float
        Duration, s.
    acceleration_fraction : float, default 0.25
        Part of the duration for which s' rises, above 0 and at most 1/2.

    Returns
    -------
    timing : Timing
        The time scaling.

    Raises
    ------
    InputError
        If the duration is no positive number, or the part is out of its range.
    """
    fraction = acceleration_fraction
    if not is_real(fraction) or not 0 < fraction <= 0.5:
        raise InputError(
            "acceleration_fraction: expected a number above 0 and at most 0.5, "
            f"got {safe_repr(fraction)}"
        )
    return Timing("trapezoidal", _duration(duration), float(fraction))


def minimum_time(
    law: Law,
    distance: ArrayLike,
    *,
    speed: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
) -> Timing:
    """Shortest timing of a law with |distance| s' <= speed and |distance| |s''| <= acceleration.

    For joints, distance = q_1 - q_0 (m,); for poses, `path_lengths`, the way and the angle. For a
    screw motion the acceleration is that along the helix of the tool's origin.

    Parameters
    ----------
    law : {"cubic", "quintic", "trapezoidal"}
        Form of s(t); the trapezoidal law needs an acceleration.
    distance : (...) array_like
        Distances, rad or m.
    speed, acceleration : (...) array_like, optional
        Positive limits for each distance, per s and s², broadcast against it; infinite or left out
        where there is none.

    Returns
    -------
    timing : Timing
        The time scaling, of the duration 0 where every distance is (next to) 0.

    Raises
    ------
    InputError
        If the law is none of those, or the limits do not bound the duration.
    ShapeError
        If a limit does not fit the distances.

    Notes
    -----
    Accuracy: longer than the shortest by 1e-14 of it, so that the limits hold in float64 too.
    Source: cubic and quintic from their greatest rates, see `Timing`; trapezoidal: a triangle where
    the speed is not reached, v² >= a |distance|.

    Examples
    --------
    >>> import poekin as pk
    >>> timing = pk.motion.minimum_time("quintic", [0.5, 1.0], speed=2.0, acceleration=4.0)
    >>> round(timing.duration, 3)
    1.201
    >>> round(float(timing(timing.duration / 2).s), 6)
    0.5
    """
    choice(law, get_args(Law), "law")
    way = np.abs(numbers(distance, "distance"))
    if not np.isfinite(way).all():
        raise InputError(f"distance: expected finite numbers, got {safe_repr(distance)}")
    if speed is None and acceleration is None:
        raise InputError(
            "minimum_time: expected a limit of speed, of acceleration, or of both, got none"
        )
    a = _least(way, speed, "speed")
    b = _least(way, acceleration, "acceleration")
    still = way.max(initial=0.0) < _INSTANT  # then limits may vanish in what underflows
    if a == b == 0 and not still:
        raise InputError(
            "minimum_time: expected a finite limit for some distance that is not 0, got none"
        )
    fraction = 0.5
    if law in _PEAKS:
        top, rise = _PEAKS[law]
        duration = max(top * a, math.sqrt(rise * b))
    elif acceleration is None or (b == 0 and not still):
        raise InputError(
            "acceleration: the trapezoidal law needs a finite one, or it would reach its speed in no time"
        )
    else:
        duration = 2 * math.sqrt(b)
        if 0 < b <= a * a:
            fraction = max(b / (a * a + b), 1e-15)
            duration = a + b / a
    if duration == math.inf:
        raise InputError("minimum_time: the limits are so small that there is no finite duration")
    if duration < _INSTANT:
        duration = 0.0
    return Timing(law, float(duration * _SPARE), float(fraction))


def _least(way: Array, limit: Any, what: str) -> float:
    """The largest quotient of ways and limits."""
    if limit is None:
        return 0.0
    limits = numbers(limit, what)
    if not (limits > 0).all():
        raise InputError(f"{what}: expected positive limits, got {safe_repr(limit)}")
    try:
        with np.errstate(over="ignore"):
            return float(np.max(way / limits, initial=0.0))
    except ValueError as error:
        raise ShapeError(
            f"{what}: shape {limits.shape} does not fit the distances' {way.shape}"
        ) from error


def _duration(duration: Any) -> float:
    if not is_real(duration) or not _INSTANT <= duration < math.inf:
        raise InputError(
            f"duration: expected a positive number of seconds, got {safe_repr(duration)}"
        )
    return float(duration)
