"""Coordinates in the units of the joints that they move, so that no solver depends on the unit of
q.

Coordinates may be degrees, or angles of a motor before a gear: x = C q + c. A solver works with u =
s q instead, where s_k is the entry of largest size in column k of C: the fastest of the joints that
coordinate k moves goes as far as u_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.compiled import CompiledChain
from .memory import keep

MOST_TURNS = 12
"""Periods of more turns than this of the fastest joint are not used."""

WHOLE = 1e-12
"""How far a number of turns may be from a whole one: the ratios of joints are products and
quotients of given ones.
"""


class JointUnits(NamedTuple):
    """An arm in the units of its joints: `fast`, a function of u = s q, and the scale s (m,), None
    where all are 1.
    """

    fast: CompiledChain
    scale: Array | None

    def of(self, q: Array) -> Array:
        """The joint units u (..., m) of coordinates q."""
        return q if self.scale is None else self.scale * q

    def coordinates(self, u: Array, limits: Array) -> Array:
        """The coordinates q (..., m) of joint units u, within `limits` (m, 2) where u is but for
        rounding.
        """
        return u if self.scale is None else np.clip(u / self.scale, *limits.T)


def joint_units(fast: CompiledChain) -> JointUnits:
    """An arm in the units of its joints; made once and kept with the arm."""
    if fast.chain._coupling is None:
        return JointUnits(fast, None)
    return fast.memory.get(joint_units) or keep(fast, joint_units, _joint_units(fast))


def _joint_units(fast: CompiledChain) -> JointUnits:
    chain = fast.chain
    scale = np.array([chain._ratio(k) for k in range(chain.dof)])
    if (scale == 1.0).all():
        return JointUnits(fast, None)
    scaled = chain._with(
        coupling=chain.coupling / scale, limits=np.sort(chain.limits * scale[:, None], axis=1)
    )
    return JointUnits(scaled.compile(), scale)


def period(chain: Chain, k: int) -> float:
    """After how much of coordinate k, in the units of its joints, these are where they were (rad);
    0 for never.
    """
    ratios = chain.coupling[:, k]
    if not chain._turns(k) or (ratios[chain.local.slides != 0] != 0).any():
        return 0.0
    for turns in range(1, MOST_TURNS + 1):
        if (np.abs(turns * ratios - np.round(turns * ratios)) <= WHOLE).all():
            return 2 * np.pi * turns
    return 0.0
