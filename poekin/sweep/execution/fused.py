"""Machine code of an arm's pose, measure and mask, for the kernel of sweeps."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InputError
from ...model.chain import Chain
from ..masks.self_collision import SelfCollision
from ..measures.measure import Measure

if TYPE_CHECKING:
    from ...engine.straight_line.arm_code import ArmCode
    from ...engine.straight_line.program import Program

_KEPT = 16
_NO_PAIRS = np.empty(0, np.int64)
_NO_RADII = np.empty(0)


def mask_numbers(mask: SelfCollision | None) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of links and radii of spheres for the kernels; of no mask none."""
    return (_NO_PAIRS, _NO_RADII) if mask is None else mask.numbers()


# by the chain's and the measure's numbers: a worker gets both anew with each part
@functools.lru_cache(_KEPT)
def fused(chain: Chain, measure: Measure, mask: SelfCollision | None = None) -> ArmCode:
    """Code that gives the pose, and what the measure and the mask are made of behind it. Raises:
    InputError.
    """
    from numba.core import config

    from ...engine.straight_line.arm_code import arm_code  # which imports Numba
    from ...engine.straight_line.program import joined

    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        raise InputError("sweep: runs machine code alone, and NUMBA_DISABLE_JIT is set")

    def make() -> Program:
        program = measure.program(chain)
        return program if mask is None else joined(program, mask.program(chain))

    measure.check(chain)
    numbers = [x.tolist() for x in (chain.screws, chain.home, chain.coupling, chain.offset)]
    key = (chain.compile().structure, measure.name, measure, numbers, mask)
    return arm_code(key, make, chain.dof, True, "columns")
