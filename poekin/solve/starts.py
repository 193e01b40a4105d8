"""Where coordinates may go, and where the tries begin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError, UnknownName, closest, listed, shown, told
from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.coordinates import coordinates
from ..model.source import warn

TURN = 2 * np.pi


@dataclass(frozen=True)
class Room:
    """limits (m, 2), infinite where there are none; ranges (m, 2), where random starts lie; fixed (m), 1 where a
    coordinate is locked, and held (m), its value there; turns (m), whether q_k + 2 pi is the same configuration;
    winds, whether any such coordinate has no limits; locks, whether any is locked.
    """

    limits: Array
    ranges: Array
    fixed: Array
    held: Array
    turns: np.ndarray
    winds: bool
    locks: bool

    def holds(self, q: Array) -> np.ndarray:
        """Whether configurations (..., m) are within the limits (...)."""
        return np.asarray(((q >= self.limits[:, 0]) & (q <= self.limits[:, 1])).all(axis=-1))

    def unwound(self, q: Array, near: Array | None = None) -> Array:
        """The same configurations with whole turns taken off: nearest to `near` within the limits; without `near`, a
        coordinate without limits within ±pi.
        """
        lower, upper = self.limits.T
        free = self.turns & (self.fixed == 0)
        if near is None:
            free = free & np.isinf(lower) & np.isinf(upper)
        turns = np.round(((0.0 if near is None else near) - q) / TURN)
        turns = np.clip(turns, np.ceil((lower - q) / TURN), np.floor((upper - q) / TURN))
        moved = q + np.where(free, TURN * turns, 0.0)
        return np.where((moved >= lower) & (moved <= upper), moved, q)


def room_of(chain: Chain, lock: Any, limits: bool) -> Room:
    """The room of a chain's coordinates. Raises: InputError, UnknownName."""
    m = chain.dof
    bounds = chain.limits.copy() if limits else np.tile([-np.inf, np.inf], (m, 1))
    low, high = chain._range() if limits else chain._turn_range()
    fixed, held = np.zeros(m), np.zeros(m)
    for k, value in _locked(chain, lock, bounds):
        fixed[k], held[k] = 1.0, value
    turns = np.array([chain._turns(k) for k in range(m)], bool)
    C = chain.coupling
    # a slide is no turn, and of a joint that goes half as fast, a turn is only half a one
    turns &= (np.round(C) == C).all(axis=0) & ~(C[chain.local.slides != 0] != 0).any(axis=0)
    winds = bool((turns & np.isinf(bounds).all(axis=1)).any())
    return Room(bounds, np.stack([low, high], axis=1), fixed, held, turns, winds, bool(fixed.any()))


def first_tries(chain: Chain, room: Room, batch: tuple[int, ...], count: int, q0: Any) -> Array:
    """Where the first try of each of `count` targets begins (N, m): at q0 within the limits, NaN for anywhere.

    Raises: InputError, ShapeError, UnknownName. Warns where q0 is moved.
    """
    if q0 is None:
        first = np.full((count, chain.dof), np.nan)
    else:
        given = for_targets(chain, batch, count, q0, "q0")
        first = np.clip(given, *room.limits.T)
        moved = ((first != given) & (room.fixed == 0)).any(axis=0)
        if moved.any():
            names = listed(name for name, far in zip(chain.q_names, moved, strict=True) if far)
            warn(f"q0 is outside the limits of {names} and is moved to them")
    if room.locks:
        first[:, room.fixed != 0] = room.held[room.fixed != 0]
    return first


def for_targets(chain: Chain, batch: tuple[int, ...], count: int, q: Any, what: str) -> Array:
    """A configuration for each of `count` targets (N, m), as a user gives it, finite.

    Raises: InputError, ShapeError, UnknownName.
    """
    given = coordinates(q, chain.q_names, what)
    if not np.isfinite(given).all():
        raise InputError(f"{what}: expected finite numbers, got {told(q)}")
    try:
        return np.broadcast_to(given, (*batch, chain.dof)).reshape(count, chain.dof).copy()
    except ValueError as error:
        raise ShapeError(f"{what}: shape {given.shape} does not fit the targets' {(*batch, chain.dof)}") from error


def _locked(chain: Chain, lock: Any, limits: Array):
    """Index and value of each coordinate that is locked; lock are pairs of name and value."""
    for name, value in lock or ():
        if name not in chain.q_names:
            raise UnknownName(f"lock: no coordinate {shown(name)}; {closest(str(name), chain.q_names)}")
        k = chain.q_names.index(name)
        real = isinstance(value, (int, float, np.integer, np.floating)) and np.isfinite(value)
        if not real or not limits[k, 0] <= value <= limits[k, 1]:
            raise InputError(f"lock: {shown(name)}: expected a number within {limits[k].tolist()}, got {told(value)}")
        yield k, float(value)
