"""Solutions of targets in closed form. Importing this module imports Numba."""

import math

from ....algebra import dot
from ...jit.array_io import load_matrix
from ...jit.kernel import kernel
from .closed_arm import FAMILY, RULE, WRIST, displacement
from .parallel_branches import fill as fill_parallel
from .wrist_branches import fill as fill_wrist

BRANCHES = 16
"""Rows of a target, more than any family has branches."""


def fill(arm, target, rows):
    """Write the branches of one target, coordinates and margin, into rows (16, m + 1), and return
    their number.

    A branch with a margin above 0 is a solution; of any other margin it is the arm's least-squares
    answer, which may be one within rounding. `arm` is as `closed_arm` says. A target that is not
    finite has none.
    """
    R, p = displacement(arm, load_matrix(target))
    if not abs(dot(p, p)) + abs(R[0] + R[4] + R[8]) < math.inf:
        return 0
    if arm[RULE, FAMILY] == WRIST:
        return fill_wrist(arm, R, p, rows)
    return fill_parallel(arm, R, p, rows)


@kernel("w2 w3 w3")
def branches(arm, targets, rows):
    """Write the branches of targets (N, 4, 4) into rows (N, 16, m + 1), filled up with NaN."""
    for k in range(targets.shape[0]):
        for i in range(fill(arm, targets[k], rows[k]), BRANCHES):
            for j in range(rows.shape[2]):
                rows[k, i, j] = math.nan
