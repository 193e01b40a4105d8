"""Coordinates that keep a value: read as a user gives them, and the arm that is left without them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..checks import is_real
from ..errors import InputError, ShapeError, UnknownName, quote, safe_repr, suggest
from ..groups import se3
from ..groups.arrays import Array, numbers
from ..model.chain import Chain
from .joint_units import JointUnits


def items(lock: Any) -> Any:
    """Names and values of a user's dict, to be part of a key. Raises: InputError."""
    if lock is not None and not isinstance(lock, Mapping):
        raise InputError(f"lock: expected a dict of names and values, got {safe_repr(lock)}")
    return None if lock is None else tuple(lock.items())


def locked_values(units: JointUnits, lock: Any, limits: Array) -> Array:
    """Values (m,) of what is locked, in joint units, NaN for the others; lock are pairs of name and
    value, `limits` (m, 2) those of the joint units. Raises: InputError, UnknownName.
    """
    values = np.full(units.fast.dof, np.nan)
    for name, value in lock or ():
        k, scale = _place(units, name)
        real = is_real(value) and np.isfinite(value)
        low, high = limits[k]
        if not real or not low <= scale * value <= high:
            raise _not_within(name, limits[k] / scale, value)
        values[k] = scale * float(value)
    return values


def locked_rows(
    units: JointUnits,
    lock: Any,
    limits: Array,
    batch: tuple[int, ...],
) -> Array:
    """`locked_values` (N, m) for each target of a batch, N of them: a value may be an array.

    Raises: InputError, ShapeError, UnknownName.
    """
    count = int(np.prod(batch))
    low, high = limits.T
    rows = np.full((count, units.fast.dof), np.nan)
    for name, value in lock or ():
        k, scale = _place(units, name)
        given = numbers(value, f"lock: {quote(name)}")
        scaled = scale * given
        inside = (scaled >= low[k]) & (scaled <= high[k])
        inside &= np.isfinite(given)
        if isinstance(value, bool) or not inside.all():
            outside = given[~inside]
            first = value if given.ndim == 0 else float(outside[0])
            raise _not_within(name, limits[k] / scale, first)
        try:
            of_targets = np.broadcast_to(given, batch)
            rows[:, k] = scale * of_targets.reshape(count)
        except ValueError as error:
            raise ShapeError(
                f"lock: {quote(name)}: shape {given.shape} does not fit the targets' {batch}"
            ) from error
    return rows


def free_chain(chain: Chain, values: Array) -> Chain:
    """The arm of the coordinates that are not locked, f'(q_free) = f(q): joints that only follow
    locked ones become links at their `values` (m,), NaN for what is free.

    A_j' = Ad(P) A_j and M' = P M, P the product of e^{A_k x_k} of the locked joints k before j, or
    of all; what a locked coordinate adds to a joint that moves is part of its offset.
    """
    free = np.isnan(values)
    coupling = chain.nontrivial_coupling
    C = chain.coupling
    moves = _moved_joints(chain, free)
    if free.all() and moves.all():
        return chain
    if coupling is not None:
        coupling = C[np.ix_(moves, free)]
    x = C[:, ~free] @ values[~free] + chain.offset
    screws = np.empty_like(chain.screws)
    P = np.eye(4)
    for i, A in enumerate(chain.screws):
        screws[i] = se3.adjoint(P) @ A
        if not moves[i]:
            P = P @ se3.exp(A * x[i])
    return chain.replace(
        screws=screws[moves],
        home=P @ chain.home,
        pitches=chain.pitches[moves],
        coupling=coupling,
        offset=x[moves],
        joint_names=_chosen(chain.joint_names, moves),
        q_names=_chosen(chain.q_names, free),
        limits=chain.limits[free],
        velocity_limits=chain.velocity_limits[free],
        joint_limits=chain.joint_limits[moves],
        joint_velocity_limits=chain.joint_velocity_limits[moves],
    )


def _moved_joints(chain: Chain, free: np.ndarray) -> np.ndarray:
    """Which joints (n,) the coordinates that are `free` (m,) move."""
    return (chain.coupling[:, free] != 0).any(axis=1)


def at_ends(chain: Chain, free: np.ndarray) -> np.ndarray:
    """Which coordinates (m,) are not `free` (m,) and move only joints before all that may move, or
    behind them: other values of theirs move nothing but the base or the tool of the arm that is left.
    """
    moves = chain.coupling != 0
    moving = np.flatnonzero(_moved_joints(chain, free))
    between = moves[moving[0] : moving[-1] + 1]
    return np.asarray(~free & ~between.any(axis=0))


def brought_back(chain: Chain, T: Array, values: Array, free: np.ndarray) -> Array:
    """Targets (N, 4, 4) of the arms whose coordinates that are `at_ends` are at 0: they have the
    solutions there that T have at `values` (N, m) of what is not free.

    T' = P' P^-1 T (M^-1 Q^-1 Q' M), P the product of the e^{A_k x_k} before the joints that move, Q
    behind them, with ' where the coordinates at the ends are at 0.
    """
    ends = at_ends(chain, free)
    if not ends.any():
        return T
    C = chain.coupling
    moving = np.flatnonzero(_moved_joints(chain, free))
    given = np.where(free, 0.0, values)
    at_zero = np.where(ends, 0.0, given)
    x = given @ C.T + chain.offset
    zero = at_zero @ C.T + chain.offset
    before = range(moving[0])
    behind = range(moving[-1] + 1, len(x.T))
    if before:
        back = se3.inverse(_product(chain, before, x))
        T = _product(chain, before, zero) @ back @ T
    if behind:
        back = se3.inverse(_product(chain, behind, x))
        Q = back @ _product(chain, behind, zero)
        T = T @ se3.inverse(chain.home) @ Q @ chain.home
    return T


def _product(chain: Chain, joints: Iterable[int], x: Array) -> Array:
    """Product (N, 4, 4) of the e^{A_k x_k} of some joints, x (N, n) the values of all."""
    P = np.eye(4)
    for k in joints:
        twists = chain.screws[k] * x[:, k, None]
        P = P @ se3.exp(twists)
    return P


def _chosen(names: tuple[str, ...], which: np.ndarray) -> tuple[str, ...]:
    chosen = np.flatnonzero(which)
    return tuple(names[k] for k in chosen)


def _place(units: JointUnits, name: Any) -> tuple[int, float]:
    """Number of a coordinate and its joint units per unit."""
    names = units.fast.q_names
    if name not in names:
        raise UnknownName(f"lock: no coordinate {quote(name)}; {suggest(str(name), names)}")
    k = names.index(name)
    ones = np.ones(len(names))
    return k, float(units.of(ones)[k])


def _not_within(name: str, limits: Array, value: Any) -> InputError:
    within = sorted(limits.tolist())
    return InputError(
        f"lock: {quote(name)}: expected a number within {within}, got {safe_repr(value)}"
    )
