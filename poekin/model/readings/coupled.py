"""Chains and robots whose coordinates are readings that the joints follow: q = K r."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ..chain_data import AnyChain, ChainData, ChainOptions
from .statements import Statements, parse_statements

_ROUNDING = 1e-15  # of the largest entry of an inverse


class OwnReadings(NamedTuple):
    """K (n, n), limits (n, 2) and velocity limits (n,) of readings in the order of the joints."""

    K: Array
    limits: Array
    velocity_limits: Array


def coupled(chain: AnyChain, coupling: Statements) -> AnyChain:
    """f'(r) = f(K r): C' = C K."""
    K = parse_statements(coupling, chain.q_names)
    return chain.replace(
        coupling=chain.coupling @ K,
        limits=reading_limits(K, chain.limits),
        velocity_limits=reading_speeds(K, chain.velocity_limits),
    )


def own_readings(chain: ChainData) -> OwnReadings | None:
    """Readings of the joints' own names that joints follow, x = K r + c; None where each joint
    follows one coordinate, or coordinates of other names.
    """
    C = chain.nontrivial_coupling
    if C is None or (np.count_nonzero(C, axis=1) <= 1).all():
        return None
    if sorted(chain.q_names) != sorted(chain.joint_names):
        return None
    order = [chain.q_names.index(name) for name in chain.joint_names]
    return OwnReadings(C[:, order], chain.limits[order], chain.velocity_limits[order])


def own_limits(chain: ChainData) -> Array:
    """Limits (n, 2) of the joints' own values x, infinite where the coordinates' say nothing."""
    limits = np.tile([-np.inf, np.inf], (len(chain.coupling), 1))
    readings = own_readings(chain)
    if readings is not None:
        limits = joint_limits(readings.K, readings.limits)
    for joint, row in enumerate(chain.coupling):
        followed = np.flatnonzero(row)
        if len(followed) == 1:
            limits[joint] = np.sort(row[followed] * chain.limits[followed[0]])
    return limits + chain.offset[:, None]


def with_readings(
    options: ChainOptions,
    K: Array,
    names: tuple[str, ...],
) -> ChainOptions:
    """Options of a chain with coordinates q as they are with readings r, q = K r, of these names.

    The readings are those that the chain's coordinates follow: its own first, in its order.
    """
    own = [names.index(name) for name in options.get("q_names") or ()]
    followed = np.flatnonzero(K[own].any(axis=0)).tolist()
    columns = [k for k in own if k in followed] + [k for k in followed if k not in own]
    limits = np.tile([-np.inf, np.inf], (len(names), 1))
    limits[own] = options.get("limits")
    speeds = np.full(len(names), np.inf)
    speeds[own] = options.get("velocity_limits")
    C = options.get("coupling")
    followers = K[np.ix_(own, columns)]
    return {
        **options,
        "q_names": tuple(names[k] for k in columns),
        "coupling": followers if C is None else np.asarray(C) @ followers,
        "limits": reading_limits(K, limits)[columns],
        "velocity_limits": reading_speeds(K, speeds)[columns],
    }


def reading_limits(K: Array, limits: Array) -> Array:
    """Limits (m, 2) of readings r = K^-1 q: the smallest box that holds all q within theirs."""
    return sum_limits(_inverse(K), limits)


def joint_limits(K: Array, limits: Array) -> Array:
    """Limits (m, 2) of joints q = K r of which `reading_limits` makes these of readings; where none
    are found, those that these leave to each joint.

    Of ends z = (-lower, upper) it makes M z, M = [[P, N], [N, P]], K^-1 = P - N.
    """
    widest = sum_limits(K, limits)
    inverse = _inverse(K)
    positive = np.maximum(inverse, 0.0)
    negative = np.maximum(-inverse, 0.0)
    M = np.block([[positive, negative], [negative, positive]])
    ends = np.concatenate([-limits[:, 0], limits[:, 1]])
    stated = np.isfinite(ends)
    bounded = M[stated].any(axis=0)
    found = np.full(len(ends), np.inf)
    found[bounded] = np.linalg.lstsq(M[stated][:, bounded], ends[stated], rcond=None)[0]
    lower, upper = found.reshape(2, -1)
    own = np.where((_parts(K) == 1)[:, None], widest, np.stack([-lower, upper], axis=1))
    if np.allclose(reading_limits(K, own), limits, atol=1e-12):
        return own
    return widest


def reading_speeds(K: Array, speeds: Array) -> Array:
    """Speeds (m,) of readings, within which no joint exceeds its own: each of the readings that a
    joint follows has an equal part of it.
    """
    parts = _parts(K)
    with np.errstate(divide="ignore"):
        each = speeds[:, None] / (parts[:, None] * np.abs(K))
    return each.min(axis=0)


def joint_speeds(K: Array, speeds: Array) -> Array:
    """Speeds (m,) of joints of which `reading_speeds` makes none larger than these of readings."""
    with np.errstate(invalid="ignore"):
        each = np.where(K == 0, np.inf, np.abs(K) * speeds)
    return _parts(K) * each.min(axis=1)


def _inverse(K: Array) -> Array:
    """K^-1 with zeros where it has nothing but rounding."""
    inverse = np.asarray(np.linalg.inv(K), float)
    inverse[np.abs(inverse) <= _ROUNDING * np.abs(inverse).max(initial=0.0)] = 0.0
    return inverse


def _parts(K: Array) -> Array:
    """Number (n,) of readings that each joint follows."""
    return np.count_nonzero(K, axis=1)


def sum_limits(K: Array, limits: Array) -> Array:
    """Limits (n, 2) of K r: the smallest box that holds them for all r within limits (m, 2)."""
    ends = np.zeros((len(K), 2))
    for k, row in enumerate(K):
        moving = np.flatnonzero(row)
        reached = row[moving, None] * limits[moving]
        ends[k] = reached.min(axis=1).sum(), reached.max(axis=1).sum()
    return ends
