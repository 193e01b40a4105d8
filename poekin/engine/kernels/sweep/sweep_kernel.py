"""A range of a sweep's samples into its cells: sample, pose and measure, cell.

Samples come as whole numbers, kind, seed and the counts of a grid, and bounds: lower ends and widths
(2, m). Cells come as whole numbers, tiles along a face's side (0 for none) and cubes along x, y and
z, and a place: the corner, m, and cubes per m.

Blocks begin at multiples of their length wherever a range does, and nothing is fused, so that a
sample's numbers do not depend on the range or the processor. Importing this module imports Numba.
"""

import math

import numpy as np

from ...jit.array_io import without_refcount
from ...jit.kernel import kernel
from ...straight_line.machine_code import LANES
from ..arm_kernels import BLOCK, run_columns, sines_of_block, sines_room
from .samples import write_samples
from .tiles import tile

OUTSIDE = -1


def _cell(cells, place, p, axis):
    """The cell of a point and a direction, OUTSIDE where there is none."""
    x = math.floor((p[0] - place[0]) * place[3])
    y = math.floor((p[1] - place[1]) * place[3])
    z = math.floor((p[2] - place[2]) * place[3])
    if not (0 <= x < cells[1] and 0 <= y < cells[2] and 0 <= z < cells[3]):
        return OUTSIDE
    cube = (int(x) * cells[2] + int(y)) * cells[3] + int(z)
    side = cells[0]
    if side == 0:
        return cube
    return cube * (12 * side * side) + tile(axis[0], axis[1], axis[2], side)


def _write_cells(cells, place, R_p, found, first):
    """Cells of four poses, R_p (12, LANES) their numbers, from found[first] on."""
    for lane in range(LANES):
        p = (R_p[9, lane], R_p[10, lane], R_p[11, lane])
        axis = (R_p[2, lane], R_p[5, lane], R_p[8, lane])
        found[first + lane] = _cell(cells, place, p, axis)


@kernel("int int int i1 r2 i1 r1 n1 w1 n1", returns="int", portable=True)
def swept(arm, first, last, samples, bounds, cells, place, counts, best, attained):
    """Samples first ... last - 1: how many lie in each cell is added to `counts`. Where `best` is no
    empty array, the largest measure of each cell, and the number of the first sample that has it.
    Returns how many lie outside.
    """
    counts = without_refcount(counts)
    best = without_refcount(best)
    attained = without_refcount(attained)
    is_measured = best.size > 0
    q = np.empty((BLOCK, bounds.shape[1]))
    sines = np.empty((sines_room(arm), BLOCK))
    cosines = np.empty((sines_room(arm), BLOCK))
    R_p = np.empty((12, LANES))
    measure = np.empty((1, LANES))
    measures = np.empty(BLOCK)
    found = np.empty(BLOCK, np.int64)
    outside = 0
    for start in range(first - first % BLOCK, last, BLOCK):
        write_samples(samples, bounds, start, q)
        sines_of_block(arm, q, sines, cosines)
        for k in range(0, BLOCK, LANES):
            run_columns(arm, sines, cosines, k, q, R_p, measure)
            _write_cells(cells, place, R_p, found, k)
            for lane in range(LANES):
                measures[k + lane] = measure[0, lane]
        # in a loop of its own, so that the processor waits for the memory of many cells at once
        for k in range(max(first - start, 0), min(last - start, BLOCK)):
            cell = found[k]
            if cell == OUTSIDE:
                outside += 1
            else:
                counts[cell] += 1
                if is_measured and measures[k] > best[cell]:
                    best[cell] = measures[k]
                    attained[cell] = start + k
    return outside


@kernel("i1 i1 r2 w2", portable=True)
def sampled(numbers, samples, bounds, q):
    """Configurations q (N, m) of samples by their numbers."""
    for k in range(len(numbers)):
        write_samples(samples, bounds, numbers[k], q[k : k + 1])


@kernel("r3 i1 r1 n1", portable=True)
def located(T, cells, place, found):
    """Cells of poses T (N, 4, 4)."""
    for k in range(len(T)):
        p = (T[k, 0, 3], T[k, 1, 3], T[k, 2, 3])
        axis = (T[k, 0, 2], T[k, 1, 2], T[k, 2, 2])
        found[k] = _cell(cells, place, p, axis)
