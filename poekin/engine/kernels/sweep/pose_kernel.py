"""Poses as samples of a sweep: from six numbers each, and what is kept of their solutions.

Arguments are those of `sweep_kernel`, and nothing is fused here either. Importing this module imports
Numba.
"""

import math

import numpy as np

from ....algebra import make_pose
from ....formulas.lie import quaternion
from ...jit.array_io import store_matrix
from ...jit.kernel import kernel
from ...straight_line.machine_code import LANES
from ...straight_line.sincos import moderate
from ..arm_kernels import BLOCK, run_columns, sines_of_block, sines_room
from .keeping import keep, leave_out, write_bins
from .measures import (
    KIND,
    OF_COORDINATES,
    OF_OUTPUTS,
    OUTPUTS,
    SIGN,
    SOLUTIONS,
    matrix_room,
    measure_coordinates,
    measure_lanes,
)
from .self_collision import collides
from .tiles import write_cells

NO_SOLUTION = -1


@kernel("r2 w3", portable=True)
def posed(numbers, T):
    """Poses T (N, 4, 4) of numbers (N, 6): a place, m, and three numbers from 0 to 1, of which even
    ones give even rotations (Shoemake 1992).
    """
    for k in range(len(numbers)):
        u = numbers[k]
        first = math.sqrt(1.0 - u[3])
        second = math.sqrt(u[3])
        s1, c1 = moderate(2.0 * math.pi * u[4])
        s2, c2 = moderate(2.0 * math.pi * u[5])
        R = quaternion.rotation(second * c2, first * s1, first * c1, second * s2)
        store_matrix(T[k], make_pose(R, (u[0], u[1], u[2])))


@kernel("int r2 i1 int i1 r1 i1 r1 w1 n1", portable=True)
def rated(arm, q, solutions, better, measure, numbers, pairs, radii, values, chosen):
    """Measures of poses by their solutions, q (S, m), `solutions` (N) of each: values (N) of the best
    solution, and `chosen` (N), its row of q. The best has the largest measure times `better`; of
    equal ones, and where there is no measure, it is the first. A solution in which spheres touch is
    none; of a pose without any the value is NaN and NO_SOLUTION is chosen.
    """
    each = np.zeros(len(q))
    masked = np.zeros(len(q), np.bool_)
    kind = measure[KIND]
    is_masked = len(radii) > 0
    if kind in OF_OUTPUTS or is_masked:
        _measure_outputs(arm, q, measure, numbers, pairs, radii, each, masked)
    if kind in OF_COORDINATES:
        measure_coordinates(measure, numbers, q.T, each)
    row = 0
    for k in range(len(solutions)):
        best = NO_SOLUTION
        count = 0
        for i in range(row, row + solutions[k]):
            if not masked[i]:
                count += 1
                if best == NO_SOLUTION or better * each[i] > better * each[best]:
                    best = i
        row += solutions[k]
        chosen[k] = best
        values[k] = math.nan if best == NO_SOLUTION else each[best]
        if kind == SOLUTIONS and count > 0:
            values[k] = count


def _measure_outputs(arm, q, measure, numbers, pairs, radii, values, masked):
    """Measures of configurations (S, m) by what the machine code leaves of them, and which of them are
    masked.
    """
    block = np.zeros((q.shape[1], BLOCK))
    sines = np.empty((sines_room(arm), BLOCK))
    cosines = np.empty((sines_room(arm), BLOCK))
    R_p = np.empty((12, BLOCK))
    every = np.empty((measure[OUTPUTS] + 3 * len(radii), LANES))
    outputs = every[: measure[OUTPUTS]]
    centres = every[measure[OUTPUTS] :]
    W = matrix_room(measure)
    four = np.empty(LANES)
    some = np.zeros(BLOCK)
    for start in range(0, len(q), BLOCK):
        count = min(BLOCK, len(q) - start)
        block[:, :count] = q[start : start + count].T
        sines_of_block(arm, block, sines, cosines)
        for k in range(0, count, LANES):
            run_columns(arm, sines, cosines, k, block, R_p, every)
            if measure[KIND] in OF_OUTPUTS:
                measure_lanes(measure, numbers, outputs, W, four, some, k)
            if len(radii) > 0:
                for lane in range(min(LANES, count - k)):
                    masked[start + k + lane] = collides(pairs, radii, centres, lane)
        values[start : start + count] = some[:count]


@kernel("int int int r3 n1 i1 r1 i1 w1 n1 w1 n1 n1", returns="int", portable=True)
def kept(
    start,
    begin,
    end,
    T,
    chosen,
    cells,
    place,
    measure,
    values,
    counts,
    best,
    attained,
    sums,
):
    """Keeps poses `begin` ... `end` - 1 of those, T (N, 4, 4), from sample `start` on, as
    `sweep_kernel.swept` does. Returns how many that have a solution lie in no cell; one without any
    counts in neither.
    """
    found = np.empty(len(T), np.int64)
    if cells[0] < 0:
        write_bins(cells, place, values, found)
    else:
        write_cells(T, cells, place, found)
    unreached = leave_out(chosen < 0, begin, end, found, values)
    outside = keep(
        cells,
        measure[SIGN],
        values,
        found,
        begin,
        end,
        start,
        counts,
        best,
        attained,
        sums,
    )
    return outside - unreached
