"""Joints along a path: one descent a pose, from the joints of the pose before.

Importing this module imports Numba.
"""

import numpy as np

from ...algebra import store_row
from ..jit.kernel import kernel
from .ik_codes import SOLVED
from .ik_kernels import KernelProblem, descend, scratch_of_try, set_info


@kernel("int w3 w1 w2 w1 w1 w1 w2 w2", returns="int")
def follow(arm, targets, start, limits, fixed, options, most, q, info):
    """Joints (N, m) for targets (N, 4, 4), each from those before it, the first from `start`.

    It ends at the first target that is not reached, or with a coordinate moved by more than `most`
    (m); that row is filled too, and its number, else N, returned. The other arguments are those of
    `ik_kernels.solve_many`.
    """
    m = q.shape[1]
    problem = KernelProblem(arm, limits, fixed, options)
    work = scratch_of_try(m)
    last = start.copy()
    now = np.empty(m)
    for k in range(targets.shape[0]):
        store_row(now, last)
        ended, position, rotation, taken = descend(problem, targets[k], now, work)
        set_info(info[k], position, rotation, taken, ended)
        store_row(q[k], now)
        near = True
        for i in range(m):
            near &= abs(now[i] - last[i]) <= most[i]
        if ended != SOLVED or not near:
            return k
        store_row(last, now)
    return targets.shape[0]
