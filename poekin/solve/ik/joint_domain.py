"""Domain of the coordinates: limits, periods, locked values, and starts of the tries."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...errors import InputError, ShapeError, join_names, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...model.provenance import warn
from ...model.readings.coupled import joint_values
from ...model.sampling import half_range, sampling_range
from ..joint_units import JointUnits, bounds, periods
from ..lock import locked_values

BESIDE_MIDDLE = 0.02
"""Share of its range by which a coordinate starts beside the middle, to either side in turn: where
an arm is stretched it is singular, and some targets are never reached from there.
"""


@dataclass(frozen=True, eq=False)
class JointDomain:
    """Domain of the coordinates, in the units of the joints.

    limits (m, 2), infinite where there are none; ranges (m, 2), where random starts lie;
    locked_values (m), NaN for coordinates that are not locked; periods (m), after which the
    configuration is the same, 0 for never.
    """

    limits: Array
    ranges: Array
    locked_values: Array
    periods: Array

    @cached_property
    def locked(self) -> np.ndarray:
        """Whether coordinates are locked (m,)."""
        return ~np.isnan(self.locked_values)

    @cached_property
    def _has_locked(self) -> bool:
        return bool(self.locked.any())

    def anywhere(self, count: int) -> Array:
        """Starts of tries (count, m): NaN, for anywhere, but for what is locked."""
        return np.tile(self.locked_values, (count, 1))

    def middle(self, count: int) -> Array:
        """Starts of tries (count, m) near the middle of the ranges: from there near solutions are
        found first, and more often than from anywhere.
        """
        return np.tile(self.beside_middle, (count, 1))

    @cached_property
    def beside_middle(self) -> Array:
        """Start (m,) of `middle`."""
        low, high = self.ranges.T
        middle = 0.5 * (low + high)
        side = np.where(np.arange(len(low)) % 2, -1.0, 1.0)
        beside = BESIDE_MIDDLE * side * (high - low)
        return self.held(middle + beside)

    def held(self, q: Array) -> Array:
        """Configurations (..., m) with what is locked at its value."""
        if not self._has_locked:
            return q
        return np.where(self.locked, self.locked_values, q)

    def contains(self, q: Array) -> np.ndarray:
        """Whether configurations (..., m) are within the limits (...)."""
        within = np.clip(q, *self.limits.T)
        return np.asarray((q == within).all(axis=-1))

    @cached_property
    def unbounded_periods(self) -> Array:
        """Periods (m,) of what is neither limited nor locked, 0 for the others."""
        unlimited = np.isinf(self.limits).all(axis=1)
        free = ~self.locked & unlimited
        return np.where(free, self.periods, 0.0)

    def principal(self, q: Array) -> Array:
        """Configurations with each coordinate without limits within half a period of 0."""
        period = self.unbounded_periods
        divisor = np.where(period > 0, period, 1.0)
        return q - period * np.rint(q / divisor)

    def wrapped(self, q: Array, near: Array) -> Array:
        """Configurations moved by whole periods to the nearest to `near` within the limits."""
        lower, upper = self.limits.T
        free = (self.periods > 0) & ~self.locked
        period = np.where(free, self.periods, 1.0)
        least = np.ceil((lower - q) / period)
        most = np.floor((upper - q) / period)
        times = np.round((near - q) / period)
        times = np.clip(times, least, most)
        moved = q + np.where(free, period * times, 0.0)
        within = (moved >= lower) & (moved <= upper)
        return np.where(within, moved, q)


def make_joint_domain(units: JointUnits, lock: Any, limits: bool) -> JointDomain:
    """Domain of an arm's coordinates; `lock` is in the user's units. Raises: InputError,
    UnknownName.
    """
    chain = units.fast.chain
    within = bounds(chain, limits)
    locked = locked_values(units, lock, within)
    if limits and np.isfinite(chain.joint_limits).any():
        within = _left_by_joints(chain, within, locked)
        chain = chain.replace(limits=within)
    ranges = free_ranges(chain)
    limited = np.isfinite(within).any(axis=1)
    drawn = np.stack(sampling_range(chain), axis=1)
    ranges[limited] = drawn[limited]
    return JointDomain(within, ranges, locked, periods(chain))


def _left_by_joints(chain: Chain, limits: Array, locked: Array) -> Array:
    """Limits (m, 2) within which the joints' own keep each coordinate that is the only free one of
    some joint.
    """
    within = limits.copy()
    free = np.isnan(locked)
    ratios = chain.coupling * free
    followed = np.count_nonzero(ratios, axis=1)
    at_rest = joint_values(chain, np.where(free, 0.0, locked))
    left = chain.joint_limits - at_rest[:, None]
    for k in np.flatnonzero(free):
        ratio = ratios[:, k]
        alone = (ratio != 0) & (followed == 1)
        ends = left[alone] / ratio[alone, None]
        lower, upper = limits[k]
        low = ends.min(axis=1).max(initial=lower)
        high = ends.max(axis=1).min(initial=upper)
        if low <= high:  # else no configuration is within, which is found out by the joints
            within[k] = low, high
    return within


def free_ranges(chain: Chain) -> Array:
    """Ranges of random starts (m, 2) without limits: a whole period, else a turn, or 1 m either
    way.
    """
    half = 0.5 * periods(chain)
    half = np.where(half > 0, half, half_range(chain))
    return np.stack([-half, half], axis=1)


def first_tries(
    chain: Chain,
    units: JointUnits,
    domain: JointDomain,
    batch: tuple[int, ...],
    count: int,
    q0: Any,
) -> Array:
    """Start of the first try of each of `count` targets (N, m), in joint units of a chain: q0
    within the limits, NaN for anywhere.

    Raises: InputError, ShapeError, UnknownName. Warns where q0 is moved.
    """
    if q0 is None:
        return domain.anywhere(count)
    given = units.of(for_targets(chain, batch, count, q0, "q0"))
    low, high = domain.limits.T
    first = np.minimum(np.maximum(given, low), high)  # np.clip takes thrice as long
    differs = first != given
    if differs.any():
        moved = differs.any(axis=0) & ~domain.locked
        names = join_names(np.array(units.fast.q_names)[moved])
        if names:
            warn(f"q0 is outside the limits of {names} and is moved to them")
    return domain.held(first)


def for_targets(
    chain: Chain,
    batch: tuple[int, ...],
    count: int,
    q: Any,
    what: str,
) -> Array:
    """Configuration for each of `count` targets (N, m), as a user gives it, finite.

    Raises: InputError, ShapeError, UnknownName.
    """
    given = coordinates(q, chain.q_names, what)
    if not np.isfinite(given).all():
        raise InputError(f"{what}: expected finite numbers, got {safe_repr(q)}")
    expected = (*batch, chain.dof)
    if given.shape == expected:  # to broadcast takes longer than a solution
        return given.reshape(count, chain.dof).copy()
    try:
        every = np.broadcast_to(given, expected)
        return every.reshape(count, chain.dof).copy()
    except ValueError as error:
        raise ShapeError(
            f"{what}: shape {given.shape} does not fit the targets' {expected}"
        ) from error
