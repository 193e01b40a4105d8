"""Meaning of the numbers that go into and come out of `engine.kernels.ik_kernels`, which imports
Numba.
"""

# Where each number stands in `options`: tolerances (m, rad), iterations of a try, restarts, task,
# the tool's direction (3) of the task DIRECTION, and the weights (6) of the error's parts.
TOL_POSITION, TOL_ROTATION, ITERATIONS, RESTARTS, TASK, AXIS, WEIGHTS, OPTIONS = (
    0,
    1,
    2,
    3,
    4,
    5,
    8,
    14,
)
POSE, POSITION, ROTATION, DIRECTION = range(4)
# Where each number stands in a row of `info`: the errors of q (m, rad), what it took, and how the
# best try ended.
AT_POSITION, AT_ROTATION, AT_ITERATIONS, AT_RESTARTS, AT_STATE, INFO = 0, 1, 2, 3, 4, 5
SOLVED, STALLED, OUT_OF_ITERATIONS, BAD_TARGET = range(4)
