"""Chains and robots whose coordinates are readings that the joints follow: q = K r."""

from __future__ import annotations

import numpy as np

from ...groups.arrays import Array
from ..chain_data import AnyChain, ChainData
from .statements import Statements, parse_statements

_ROUNDING = 1e-15  # of the largest entry of an inverse
UNLIMITED = (-np.inf, np.inf)
WITHIN = 1e-12
"""Rounding (rad or m, and of the limit) by which a sum of readings may be beyond its joint's limit."""


def coupled(chain: AnyChain, coupling: Statements) -> AnyChain:
    """f'(r) = f(K r): C' = C K; the joints' own limits stay."""
    K = parse_statements(coupling, chain.q_names)
    return with_readings(chain, K, chain.q_names)


def with_readings(chain: AnyChain, K: Array, names: tuple[str, ...]) -> AnyChain:
    """The chain of coordinates q with readings r, q = K r, of these names.

    The readings are those that the chain's coordinates follow: its own first, in its order.
    """
    own = [names.index(name) for name in chain.q_names]
    followed = np.flatnonzero(K[own].any(axis=0)).tolist()
    columns = [k for k in own if k in followed]
    columns += [k for k in followed if k not in own]
    limits = np.empty((len(names), 2))
    limits[:] = UNLIMITED
    limits[own] = chain.limits
    speeds = np.full(len(names), np.inf)
    speeds[own] = chain.velocity_limits
    found = chain.replace(
        q_names=[names[k] for k in columns],
        coupling=chain.coupling @ K[np.ix_(own, columns)],
        limits=reading_limits(K, limits)[columns],
        velocity_limits=reading_speeds(K, speeds)[columns],
    )
    said = _said_by_joints(found, own_limits(chain), own_speeds(chain))
    return found.replace(**said)


def own_readings(chain: ChainData) -> Array | None:
    """K (n, n) of `own_coupling`; None where each joint follows one coordinate."""
    K = own_coupling(chain)
    if K is None or not (np.count_nonzero(K, axis=1) > 1).any():
        return None
    return K


def own_coupling(chain: ChainData) -> Array | None:
    """K (n, n) of readings of the joints' own names, in the order of the joints, that these follow,
    x = K r + c; None where each is its own reading, or coordinates have other names.
    """
    C = chain.nontrivial_coupling
    if C is None or sorted(chain.q_names) != sorted(chain.joint_names):
        return None
    columns = [chain.q_names.index(name) for name in chain.joint_names]
    K = C[:, columns]
    return None if np.array_equal(K, np.eye(len(K))) else K


def own_limits(chain: ChainData) -> Array:
    """Limits (n, 2) of the joints' own values x: their own, and what the coordinates' leave."""
    implied = _implied_limits(chain)
    own = chain.joint_limits
    lower = np.maximum(implied[:, 0], own[:, 0])
    upper = np.minimum(implied[:, 1], own[:, 1])
    return np.stack([lower, upper], axis=-1)


def own_speeds(chain: ChainData) -> Array:
    """Limits (n,) of the speeds of joints: their own, and what the coordinates' leave."""
    implied = _speeds(chain.coupling, chain.velocity_limits)
    return np.minimum(implied, chain.joint_velocity_limits)


def _said_by_joints(chain: ChainData, limits: Array, speeds: Array) -> dict[str, Array]:
    """Limits (n, 2) and speeds (n,) of joints, but for those that the coordinates' imply."""
    implied = _implied_limits(chain)
    same = (limits == implied).all(axis=1)
    slow = _speeds(chain.coupling, chain.velocity_limits) <= speeds
    return {
        "joint_limits": np.where(same[:, None], UNLIMITED, limits),
        "joint_velocity_limits": np.where(slow, np.inf, speeds),
    }


def _implied_limits(chain: ChainData) -> Array:
    """Limits (n, 2) of the joints' own values that the coordinates' leave."""
    of_coordinates = sum_limits(chain.coupling, chain.limits)
    return of_coordinates + chain.offset[:, None]


def joint_values(chain: ChainData, q: Array) -> Array:
    """Values x = C q + c of the joints (..., n), rad or m, at configurations (..., m)."""
    return q @ chain.coupling.T + chain.offset


def beyond_own_limits(chain: ChainData, q: Array) -> np.ndarray:
    """Whether each joint is beyond its own limits (..., n) at configurations (..., m)."""
    x = joint_values(chain, q)
    lower, upper = chain.joint_limits.T
    rounding = WITHIN * (1 + np.abs(x))
    return (x < lower - rounding) | (x > upper + rounding)


def reading_limits(K: Array, limits: Array) -> Array:
    """Limits (m, 2) of readings r = K^-1 q: the smallest box that holds all q within theirs."""
    return sum_limits(_inverse(K), limits)


def reading_speeds(K: Array, speeds: Array) -> Array:
    """Speeds (m,) of readings r = K^-1 q: the least that no q within theirs exceeds."""
    return _speeds(_inverse(K), speeds)


def _speeds(K: Array, speeds: Array) -> Array:
    """Largest speeds (n,) of K r for all r within speeds (m,)."""
    both_ways = np.stack([-speeds, speeds], axis=1)
    return sum_limits(K, both_ways)[:, 1]


def _inverse(K: Array) -> Array:
    """K^-1 with zeros where it has nothing but rounding."""
    inverse = np.asarray(np.linalg.inv(K), float)
    sizes = np.abs(inverse)
    nothing = sizes <= _ROUNDING * sizes.max(initial=0.0)
    inverse[nothing] = 0.0
    return inverse


def sum_limits(K: Array, limits: Array) -> Array:
    """Limits (n, 2) of K r: the smallest box that holds them for all r within limits (m, 2)."""
    ends = np.zeros((len(K), 2))
    for k, row in enumerate(K):
        moving = np.flatnonzero(row)
        reached = row[moving, None] * limits[moving]
        ends[k, 0] = reached.min(axis=1).sum()
        ends[k, 1] = reached.max(axis=1).sum()
    return ends
