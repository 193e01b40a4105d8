"""Machine code of an arm's pose and measure, for the kernel of sweeps."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from ...analysis.dexterity.jacobian_part import generic_rank
from ...errors import InputError
from ...model.chain import Chain
from ..sweep import Measure

if TYPE_CHECKING:
    from ...engine.straight_line.arm_code import ArmCode
    from ...engine.straight_line.program import Program

_FULL = 6  # coordinates from which on det(J Jᵀ) is the same in every frame
_KEPT = 16


# by the chain's numbers: a worker gets a chain anew with each part
@functools.lru_cache(_KEPT)
def fused(chain: Chain, measure: Measure) -> ArmCode:
    """Code that gives the pose, and the measure behind it. Raises: InputError."""
    from numba.core import config

    from ...engine.straight_line.arm_code import arm_code  # which imports Numba
    from ...engine.straight_line.specialise import manipulability_program, with_frame_at

    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        raise InputError("sweep: runs machine code alone, and NUMBA_DISABLE_JIT is set")

    fast = chain.compile()
    most = min(fast.dof, _FULL)
    if measure == "manipulability" and generic_rank(chain, "pose") < most:
        raise InputError(
            f"sweep: measure 'manipulability': the tool of {chain!r} moves in fewer than {most} ways at a time, "
            "so that it is 0 everywhere"
        )

    def program() -> Program:
        if measure == "reach":
            return fast.program(None)
        if fast.dof < _FULL:
            return manipulability_program(fast.structure, "hybrid")
        joint, along, _ = fast.cheapest
        return manipulability_program(with_frame_at(fast.structure, joint, along), joint)

    return arm_code((fast.structure, measure), program, fast.dof, True, "columns")
