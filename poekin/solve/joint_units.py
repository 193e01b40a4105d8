"""Coordinates in the units of the joints that they move; no solver depends on the unit of q.

Coordinates may be degrees, or angles of a motor before a gear: x = C q + c. A solver works with u =
s q instead, where s_k is the entry of largest size in column k of C: the fastest of the joints that
coordinate k moves goes as far as u_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.kinematics.compiled import CompiledChain
from ..model.sampling import dominant_ratio
from .chain_cache import ChainCache

MOST_TURNS = 12
"""Periods of more turns than this of the fastest joint are not used."""

WHOLE = 1e-12
"""Tolerance of a whole number of turns: the ratios of joints are products and quotients of given
ratios.
"""


class JointUnits(NamedTuple):
    """An arm in the units of its joints: `fast`, a function of u = s q, and the scale s (m,), None
    where all are 1.
    """

    fast: CompiledChain
    scale: Array | None

    def of(self, q: Array) -> Array:
        """Joint units u (..., m) of coordinates q."""
        return q if self.scale is None else self.scale * q

    def coordinates(self, u: Array, limits: Array) -> Array:
        """Coordinates q (..., m) of joint units u, within `limits` (m, 2) where u is but for
        rounding.
        """
        return u if self.scale is None else np.clip(u / self.scale, *limits.T)


_UNITS: ChainCache[JointUnits] = ChainCache()


def joint_units(fast: CompiledChain) -> JointUnits:
    """Arm in the units of its joints; made once and kept."""
    if fast.chain.nontrivial_coupling is None:
        return JointUnits(fast, None)
    return _UNITS.get(fast) or _UNITS.keep(fast, _joint_units(fast))


def _joint_units(fast: CompiledChain) -> JointUnits:
    chain = fast.chain
    scale = np.array([dominant_ratio(chain, k) for k in range(chain.dof)])
    if (scale == 1.0).all():
        return JointUnits(fast, None)
    limits = np.sort(chain.limits * scale[:, None], axis=1)
    scaled = chain.replace(coupling=chain.coupling / scale, limits=limits)
    return JointUnits(scaled.compile(), scale)


def bounds(chain: Chain, limits: bool) -> Array:
    """Limits (m, 2) of the coordinates, infinite where `limits` do not count."""
    if limits:
        return chain.limits.copy()
    return np.tile([-np.inf, np.inf], (chain.dof, 1))


def periods(chain: Chain) -> Array:
    """Periods (m,) of the coordinates, see `period`."""
    return np.array([period(chain, k) for k in range(chain.dof)])


def period(chain: Chain, k: int) -> float:
    """Period of coordinate k, after which its joints are where they were, in their units (rad); 0
    for never.
    """
    ratios = chain.coupling[:, k]
    if not chain.is_angle(k) or (ratios[chain.local.slides != 0] != 0).any():
        return 0.0
    for turns in range(1, MOST_TURNS + 1):
        if (np.abs(turns * ratios - np.round(turns * ratios)) <= WHOLE).all():
            return 2 * np.pi * turns
    return 0.0
