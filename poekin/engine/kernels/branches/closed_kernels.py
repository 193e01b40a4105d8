"""Solutions of targets in closed form, a kernel for each family: an arm compiles its own alone.
Importing this module imports Numba.
"""

import math

from ....algebra import dot
from ...jit.array_io import load_matrix
from ...jit.kernel import Kernel, kernel
from .closed_arm import FAMILY, RULE, WRIST, displacement, finish
from .parallel_branches import fill as fill_parallel
from .wrist_branches import fill as fill_wrist


def fill(arm, target, rows):
    """Write the branches of one target, coordinates, their (x, y) and margin, into rows (8, 3 m +
    1), and return their number.

    A branch with a margin above 0 is a solution; of any other margin it is the arm's least-squares
    answer, which may be one within rounding. `arm` is as `closed_arm` says. A target that is not
    finite has none.
    """
    R, p = displacement(arm, load_matrix(target))
    if not is_finite(R, p):
        return 0
    if arm[RULE, FAMILY] == WRIST:
        count = fill_wrist(arm, R, p, rows)
    else:
        count = fill_parallel(arm, R, p, rows)
    for k in range(count):
        finish(arm, rows[k])
    return count


def is_finite(R, p):
    """Whether a displacement is made of finite numbers."""
    return abs(dot(p, p)) + abs(R[0] + R[4] + R[8]) < math.inf


def end(rows, count):
    """Fill the rows after the first `count` with NaN."""
    for i in range(count, rows.shape[0]):
        for j in range(rows.shape[1]):
            rows[i, j] = math.nan


@kernel("w2 w3 w3")
def wrist_branches(arm, targets, rows):
    """Write the branches of targets (N, 4, 4) into rows (N, 8, m + 1), filled up with NaN."""
    for k in range(targets.shape[0]):
        R, p = displacement(arm, load_matrix(targets[k]))
        count = 0
        if is_finite(R, p):
            count = fill_wrist(arm, R, p, rows[k])
        end(rows[k], count)


@kernel("w2 w3 w3")
def parallel_branches(arm, targets, rows):
    """Write the branches of targets (N, 4, 4) into rows (N, 8, m + 1), filled up with NaN."""
    for k in range(targets.shape[0]):
        R, p = displacement(arm, load_matrix(targets[k]))
        count = 0
        if is_finite(R, p):
            count = fill_parallel(arm, R, p, rows[k])
        end(rows[k], count)


def branches_of(arm) -> Kernel:
    """The kernel of an arm's family."""
    return wrist_branches if arm[RULE, FAMILY] == WRIST else parallel_branches
