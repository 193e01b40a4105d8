"""Measures of a block of configurations: from what the arm's machine code leaves of them, and from
their coordinates.

A measure comes as whole numbers, its kind, the sign that makes better larger, how many outputs the
machine code has, and the rows and columns of a matrix, and as numbers:

- ROOT: the sum of the roots of the outputs; one below 0 by rounding, or NaN, counts as 0
- SMALLEST, INVERSE_CONDITION: of the singular values of a Jacobian (6, m), and 1 / length
- TRAVEL, MARGIN: of the coordinates, references (m) and weights (m)
- SOLUTIONS: of a pose, the number of its solutions
"""

import math

import numpy as np

from ....formulas.kinematics import joint_ranges, singular_values
from ...lanes import rows as lanes
from ...straight_line.machine_code import LANES

KIND, SIGN, OUTPUTS, ROWS, COLUMNS = range(5)
NONE, ROOT, SMALLEST, INVERSE_CONDITION, TRAVEL, MARGIN, SOLUTIONS = range(7)
OF_OUTPUTS = (ROOT, SMALLEST, INVERSE_CONDITION)
OF_COORDINATES = (TRAVEL, MARGIN)
_ROTATIONAL = 3
_SWEEPS = 24  # one of 800 000 matrices took 13, and each further sweep an eighth as many


def matrix_room(measure):
    """Room for the matrix of LANES configurations."""
    return np.empty((measure[ROWS], measure[COLUMNS] * LANES))


def measure_lanes(measure, numbers, outputs, W, found, values, k):
    """Measures of LANES configurations by their outputs (K, LANES), into values[k] and so on; `found`
    (LANES) is written to.
    """
    kind = measure[KIND]
    if kind == ROOT:
        for lane in range(LANES):
            total = 0.0
            for i in range(len(outputs)):
                if outputs[i, lane] > 0.0:
                    total += math.sqrt(outputs[i, lane])
            values[k + lane] = total
    else:
        _singular(measure, numbers[0], outputs, W, found)
        for lane in range(LANES):
            values[k + lane] = found[lane]


def _singular(measure, scale, outputs, W, values):
    """Measures by the singular values of Jacobians; of one with fewer than six columns W is its
    transpose.
    """
    m = len(outputs) // 6
    for r in range(6):
        factor = 1.0 if r < _ROTATIONAL else scale
        for i in range(m):
            row = i if m < 6 else r
            column = r if m < 6 else i
            for lane in range(LANES):
                W[row, column * LANES + lane] = factor * outputs[r * m + i, lane]
    rows = measure[ROWS]
    columns = measure[COLUMNS]
    table = lanes.table(W)
    found = lanes.rows(values)
    for _ in range(_SWEEPS):
        found[0] = singular_values.orthogonalise(table, rows, columns)
        if values[0] + values[1] + values[2] + values[3] == 0.0:
            break
    largest, smallest = singular_values.extreme_lengths(table, rows, columns)
    found[0] = smallest
    if measure[KIND] == INVERSE_CONDITION:
        # of nothing but zeros it is 0
        found[0] = smallest / (largest + np.finfo(np.float64).tiny)


def measure_coordinates(measure, numbers, q, values):
    """Measures of a block of configurations, q (m, N), by their coordinates."""
    m, count = q.shape
    kind = measure[KIND]
    if kind == TRAVEL:
        for k in range(count):
            values[k] = joint_ranges.travel(q[:, k], numbers[:m], numbers[m:], m)
    elif kind == MARGIN:
        for k in range(count):
            values[k] = joint_ranges.limit_margin(q[:, k], numbers[:m], numbers[m:], m)
