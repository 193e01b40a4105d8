"""A range of a sweep's samples into its cells: sample, pose and measure, cell.

Samples come as whole numbers, kind, seed and the counts of a grid, and bounds: lower ends and widths
(2, m). Cells come as whole numbers, tiles along a face's side (0 for none) and cubes along x, y and
z, and a place: the corner, m, and cubes per m. Bins of a measure come as BINS and their number, and
a place: where they begin, two zeros, and bins per unit. A measure comes as `measures` says, pairs of
links and radii of spheres as `self_collision` does: none where samples are not masked.

Blocks begin at multiples of their length wherever a range does, and nothing is fused, so that a
sample's numbers do not depend on the range or the processor. Importing this module imports Numba.
"""

import numpy as np

from ...jit.array_io import without_refcount
from ...jit.kernel import kernel
from ...straight_line.machine_code import LANES
from ..arm_kernels import BLOCK, run_columns, sines_of_block, sines_room
from .keeping import keep, leave_out, write_bins
from .measures import (
    KIND,
    OF_COORDINATES,
    OF_OUTPUTS,
    OUTPUTS,
    ROOT,
    SIGN,
    matrix_room,
    measure_coordinates,
    measure_lanes,
)
from .root import root
from .samples import write_samples
from .self_collision import collides
from .tiles import cell_of, write_cells


def _write_cells(cells, place, R_p, found):
    """Cells of a block of poses, R_p (12, BLOCK) their numbers."""
    # known beforehand, so that the loop takes several poses at once
    shape = (cells[0], cells[1], cells[2], cells[3])
    corner = (place[0], place[1], place[2], place[3])
    for k in range(BLOCK):
        p = (R_p[9, k], R_p[10, k], R_p[11, k])
        axis = (R_p[2, k], R_p[5, k], R_p[8, k])
        found[k] = cell_of(shape, corner, p, axis)


@kernel("int int int i1 r2 i1 r1 i1 r1 i1 r1 n1 w1 n1 n1", returns="int", portable=True)
def swept(
    arm,
    first,
    last,
    samples,
    bounds,
    cells,
    place,
    measure,
    numbers,
    pairs,
    radii,
    counts,
    best,
    attained,
    sums,
):
    """Samples first ... last - 1: how many lie in each cell is added to `counts`. Returns how many lie
    in none; a sample in which spheres touch counts in neither. The measure, times its sign, is kept
    by arrays that are not empty:

    - `best` and `attained`, as long as `counts`: the largest of each cell, and the first sample that
      has it
    - `sums` and `attained`: the sums of each cell in units of 2^-40, as multiples of 2^32 and what is
      left, to which at most 2^30 samples are added
    - `best` and `attained`, where cells[0] is TOP: the largest of all in descending order
    """
    counts = without_refcount(counts)
    best = without_refcount(best)
    attained = without_refcount(attained)
    sums = without_refcount(sums)
    q = np.empty((bounds.shape[1], BLOCK))
    sines = np.empty((sines_room(arm), BLOCK))
    cosines = np.empty((sines_room(arm), BLOCK))
    R_p = np.empty((12, BLOCK))
    every = np.empty((measure[OUTPUTS] + 3 * len(radii), LANES))
    outputs = every[: measure[OUTPUTS]]
    centres = every[measure[OUTPUTS] :]
    masked = np.zeros(BLOCK, np.bool_)
    W = matrix_room(measure)
    four = np.empty(LANES)
    values = np.empty(BLOCK)
    found = np.empty(BLOCK, np.int64)
    kind = measure[KIND]
    is_root = kind == ROOT and measure[OUTPUTS] == 1
    is_spatial = cells[0] >= 0
    is_masked = len(radii) > 0
    outside = 0
    for start in range(first - first % BLOCK, last, BLOCK):
        write_samples(samples, bounds, start, q)
        sines_of_block(arm, q, sines, cosines)
        for k in range(0, BLOCK, LANES):
            run_columns(arm, sines, cosines, k, q, R_p, every)
            if is_root:
                for lane in range(LANES):
                    values[k + lane] = outputs[0, lane]
            elif kind in OF_OUTPUTS:
                measure_lanes(measure, numbers, outputs, W, four, values, k)
            if is_masked:
                for lane in range(LANES):
                    masked[k + lane] = collides(pairs, radii, centres, lane)
        if is_root:
            for k in range(BLOCK):
                values[k] = root(values[k])
        elif kind in OF_COORDINATES:
            measure_coordinates(measure, numbers, q, values)
        if is_spatial:
            _write_cells(cells, place, R_p, found)
        else:
            write_bins(cells, place, values, found)
        begin = max(first - start, 0)
        end = min(last - start, BLOCK)
        if is_masked:
            outside -= leave_out(masked, begin, end, found, values)
        outside += keep(
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
    return outside


@kernel("i1 i1 r2 w2", portable=True)
def sampled(numbers, samples, bounds, q):
    """Configurations q (N, m) of samples by their numbers."""
    for k in range(len(numbers)):
        write_samples(samples, bounds, numbers[k], q[k].reshape(-1, 1))


@kernel("r3 i1 r1 n1", portable=True)
def located(T, cells, place, found):
    """Cells of poses T (N, 4, 4)."""
    write_cells(T, cells, place, found)
