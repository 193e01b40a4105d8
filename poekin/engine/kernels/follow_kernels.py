"""Joints along a path: one descent a pose, from the joints of the pose before. Importing this
module imports Numba.
"""

import numpy as np

from ..jit.kernel import kernel
from .ik_codes import AT_ITERATIONS, AT_POSITION, AT_RESTARTS, AT_ROTATION, AT_STATE, SOLVED
from .ik_kernels import _descend


@kernel("int w3 w1 w2 w1 w1 w1 w2 w2", returns="int")
def follow(arm, targets, start, limits, fixed, options, most, q, info):
    """Joints (N, m) for targets (N, 4, 4), each from those before it, the first from `start`.

    It ends at the first target that is not reached, or with a coordinate moved by more than `most`
    (m); that row is filled too, and its number, else N, returned. The other arguments are those of
    `ik_kernels.solve_many`.
    """
    m = q.shape[1]
    T, J, H = np.empty((4, 4)), np.empty((6, m)), np.empty((m, m))
    work, last, now = np.empty((4, 4 * m + 16)), np.empty(m), np.empty(m)
    for i in range(m):
        last[i] = start[i]
    for k in range(targets.shape[0]):
        for i in range(m):
            now[i] = last[i]
        ended, position, rotation, taken = _descend(
            arm, targets[k], now, limits, fixed, options, work, T, J, H
        )
        row, near = info[k], True
        row[AT_POSITION], row[AT_ROTATION], row[AT_STATE] = position, rotation, ended
        row[AT_ITERATIONS], row[AT_RESTARTS] = taken, 0
        for i in range(m):
            near &= abs(now[i] - last[i]) <= most[i]
            q[k, i] = last[i] = now[i]
        if ended != SOLVED or not near:
            return k
    return targets.shape[0]
