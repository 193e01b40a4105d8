"""Meaning of the numbers that go into and come out of `engine.kernels.ik_kernels`, which imports
Numba.
"""

# Where each number stands in `options`: tolerances (m, rad), iterations of a try, restarts, task,
# the tool's direction (3) of the task DIRECTION or the plane's normal of PLANAR, and the weights (6)
# of the error's parts.
TOL_POSITION = 0
TOL_ROTATION = 1
ITERATIONS = 2
RESTARTS = 3
TASK = 4
AXIS = 5
WEIGHTS = 8
OPTIONS = 14
POSE, POSITION, ROTATION, DIRECTION, PLANAR = range(5)
# Where each number stands in a row of `info`: the errors of q (m, rad), what it took, and how the
# best try ended.
AT_POSITION = 0
AT_ROTATION = 1
AT_ITERATIONS = 2
AT_RESTARTS = 3
AT_STATE = 4
INFO = 5
SOLVED, STALLED, OUT_OF_ITERATIONS, BAD_TARGET = range(4)
