"""Machine code of an arm's pose and measure, for the kernel of sweeps."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from ...errors import InputError
from ...model.chain import Chain
from ..measures.measure import Measure

if TYPE_CHECKING:
    from ...engine.straight_line.arm_code import ArmCode

_KEPT = 16


# by the chain's and the measure's numbers: a worker gets both anew with each part
@functools.lru_cache(_KEPT)
def fused(chain: Chain, measure: Measure) -> ArmCode:
    """Code that gives the pose, and what the measure is made of behind it. Raises: InputError."""
    from numba.core import config

    from ...engine.straight_line.arm_code import arm_code  # which imports Numba

    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        raise InputError("sweep: runs machine code alone, and NUMBA_DISABLE_JIT is set")

    measure.check(chain)
    numbers = [x.tolist() for x in (chain.screws, chain.home, chain.coupling, chain.offset)]
    key = (chain.compile().structure, measure.name, measure, numbers)
    return arm_code(key, lambda: measure.program(chain), chain.dof, True, "columns")
