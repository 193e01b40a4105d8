"""Coordinates in the units of the joints that they move; no solver depends on the unit of q.

Coordinates may be degrees, or angles of a motor before a gear: x = C q + c. A solver works with u =
S q instead. Of coupled readings S is C: the joints' own limits are those of u. Else S is diagonal, s_k
the entry of largest size in column k of C: the fastest of the joints that coordinate k moves goes as
far as u_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.kinematics.compiled import CompiledChain
from ..model.readings.coupled import UNLIMITED, own_limits, reading_limits
from ..model.sampling import dominant_ratios
from .chain_cache import ChainCache

MOST_TURNS = 12
"""Periods of more turns than this of the fastest joint are not used."""

SAME = 1e-9
"""Tolerance (rad or m) of limits that are the same."""

WHOLE = 1e-12
"""Tolerance of a whole number of turns: the ratios of joints are products and quotients of given
ratios.
"""


class JointUnits(NamedTuple):
    """An arm in the units of its joints: `fast`, a function of u = S q, and S (m, m), None where it
    is the identity.
    """

    fast: CompiledChain
    scale: Array | None

    def of(self, q: Array) -> Array:
        """Joint units u (..., m) of coordinates q."""
        if self.scale is None:
            return q
        return np.einsum("jk,...k->...j", self.scale, q)

    def of_steps(self, most: Array) -> Array:
        """Largest steps (m,) of u, within which no coordinate makes a larger one than these."""
        if self.scale is None:
            return most
        back = np.linalg.inv(self.scale)
        parts = np.count_nonzero(back, axis=1, keepdims=True)
        with np.errstate(divide="ignore"):
            each = most[:, None] / np.abs(parts * back)
            return each.min(axis=0)

    def coordinates(self, u: Array, limits: Array) -> Array:
        """Coordinates q (..., m) of joint units u, within `limits` (m, 2) where u is but for
        rounding.
        """
        if self.scale is None:
            return u
        q = np.linalg.solve(self.scale, u[..., None])
        return np.asarray(np.clip(q[..., 0], *limits.T), float)


_UNITS: ChainCache[JointUnits] = ChainCache()


def joint_units(fast: CompiledChain, locked: bool = False) -> JointUnits:
    """Arm in the units of its joints; made once and kept. Where some are `locked`, S is diagonal."""
    if fast.chain.nontrivial_coupling is None:
        return JointUnits(fast, None)
    known = _UNITS.get(fast, locked)
    if known is not None:
        return known
    return _UNITS.keep(fast, _joint_units(fast, locked), locked)


def _joint_units(fast: CompiledChain, locked: bool) -> JointUnits:
    chain = fast.chain
    C = chain.coupling
    if not locked and _sums_imply_limits(chain):
        return in_joints(chain)
    scale = dominant_ratios(chain)
    if (scale == 1.0).all():
        return JointUnits(fast, None)
    ends = chain.limits * scale[:, None]
    limits = np.sort(ends, axis=1)
    scaled = chain.replace(coupling=C / scale, limits=limits)
    return JointUnits(scaled.compile(), np.diag(scale))


def in_joints(chain: Chain) -> JointUnits:
    """The arm as a function of its joints' own values, less their offsets, within their own limits."""
    own = chain.replace(
        coupling=None,
        q_names=chain.joint_names,
        limits=_limits_without_offsets(chain),
        joint_limits=None,
    )
    return JointUnits(own.compile(), chain.coupling)


def has_sums(chain: Chain) -> bool:
    """Whether joints are sums of coordinates, which they determine."""
    C = chain.coupling
    sums = np.count_nonzero(C, axis=1) > 1
    independent = np.linalg.matrix_rank(C) == max(C.shape)
    return bool(sums.any() and independent)


def _sums_imply_limits(chain: Chain) -> bool:
    """Whether joints that are sums of coordinates are as good coordinates, as their limits imply
    those of the given ones.
    """
    if not has_sums(chain):
        return False
    own = _limits_without_offsets(chain)
    lower, upper = reading_limits(chain.coupling, own).T
    low, high = chain.limits.T
    implied = (lower >= low - SAME) & (upper <= high + SAME)
    return bool(np.all(implied))


def _limits_without_offsets(chain: Chain) -> Array:
    """Limits (n, 2) of the joints' own values, less their offsets."""
    return own_limits(chain) - chain.offset[:, None]


def bounds(chain: Chain, limits: bool) -> Array:
    """Limits (m, 2) of the coordinates, infinite where `limits` do not count."""
    if limits:
        return chain.limits.copy()
    return np.tile(UNLIMITED, (chain.dof, 1))


def periods(chain: Chain) -> Array:
    """Periods (m,) of the coordinates, see `period`."""
    coordinates = range(chain.dof)
    return np.array([period(chain, k) for k in coordinates])


def period(chain: Chain, k: int) -> float:
    """Period of coordinate k, after which its joints are where they were, in their units (rad); 0
    for never.
    """
    ratios = chain.coupling[:, k]
    sliding = ratios[chain.local.slides != 0]
    if not chain.is_angle(k) or sliding.any():
        return 0.0
    for turns in range(1, MOST_TURNS + 1):
        of_joints = turns * ratios
        off = np.abs(of_joints - np.round(of_joints))
        if (off <= WHOLE).all():
            return 2 * np.pi * turns
    return 0.0
