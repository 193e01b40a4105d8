"""The best solution of the inverse kinematics of each of many poses."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..errors import InputError
from ..groups.arrays import Array
from ..model.chain import Chain
from ..solve.ik_all.ik_all import ik_all
from ..solve.ik_all.sources import solvers_of
from ..solve.joint_units import joint_units
from .execution.fused import fused, mask_numbers
from .masks.self_collision import SelfCollision
from .measures.measure import Measure

_MOST = 6


class BestSolutions(NamedTuple):
    """Solutions q (S, m) of poses, which of these is the best of each (N,), -1 of none, and its
    measure (N,).
    """

    q: Array
    chosen: np.ndarray
    values: Array

    def configurations(self) -> Array:
        """Best solutions (N, m), NaN where there is none."""
        found = np.full((len(self.chosen), self.q.shape[1]), np.nan)
        is_reached = self.chosen >= 0
        found[is_reached] = self.q[self.chosen[is_reached]]
        return found


def best_solutions(
    chain: Chain, T: Array, measure: Measure, mask: SelfCollision | None
) -> BestSolutions:
    """Best solutions of poses T (N, 4, 4) within the limits, none of them masked."""
    from ..engine.kernels.sweep import pose_kernel  # which imports Numba

    # the code is held until the call is over
    code = fused(chain, measure, mask)
    solutions = ik_all(chain, T)
    q = measure.at_best_turns(chain, solutions.q)
    values = np.empty(len(T))
    chosen = np.empty(len(T), np.int64)
    pose_kernel.rated.call(
        code.address,
        q,
        solutions.counts,
        measure.sign,
        measure.whole_numbers(chain, measure.sign),
        measure.numbers(chain),
        *mask_numbers(mask),
        values,
        chosen,
    )
    return BestSolutions(q, chosen, values)


def check_solvable(chain: Chain) -> None:
    """Refuses an arm whose solutions are not known one by one. Raises: InputError."""
    if chain.dof > _MOST:
        raise InputError(
            f"sweep of poses: expected an arm of up to six coordinates, got {chain.dof}: a pose has "
            "infinitely many solutions; samples of configurations map any arm"
        )
    if not solvers_of(joint_units(chain.compile()).fast.chain, "auto"):
        raise InputError(
            f"sweep of poses: {chain!r} is solved neither in closed form nor by elimination, and a search "
            "of each pose takes milliseconds; samples of configurations map any arm"
        )
