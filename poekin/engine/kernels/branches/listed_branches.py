"""All solutions of targets whose branches, in closed form or by elimination, are clear of one another:
sharpened, brought into the limits and in order. Importing this module imports Numba.

Of a target that is not clear nothing is listed: where solutions are one or infinitely many, `search`
of `ik_all_kernel` tells them apart.
"""

import math

import numpy as np

from ....algebra import dot, store_row
from ....formulas.inverse import confirmed, least_squares
from ...jit.kernel import kernel
from ..arm_kernels import run_one
from ..ik_all_kernel import wrapped_difference
from ..ik_codes import ITERATIONS, TOL_POSITION, TOL_ROTATION
from ..ik_kernels import CODE, STEP, KernelProblem, scratch_of_try

# Where each number stands in `rule`: margin above which a branch is a solution, and below whose
# negative it is none; how far (rad or m) a solution may be from its branch.
CLEAR = 0
ABSENT = 1
MOVED = 2
RULE = 3
# Where each number stands in a row of `box`.
LOW = 0
HIGH = 1
PERIOD = 2
BOX = 3
# Where each number stands in a row of `errors`: m, rad, and in how many places the solution is.
POSITION = 0
ROTATION = 1
PLACES = 2
ERRORS = 3
# Where each number stands in a row of `info`: solutions anywhere, those within the limits, and
# whether the target is clear.
FOUND = 0
WITHIN = 1
IS_CLEAR = 2
INFO = 3

_APART = 1e-7  # rad or m: nearer solutions are one
_FAR = 100.0  # rad: so many turns away, rounding of the angle moves the tool, and it is looked at there
_EDGE = 1e-12  # rad or m: a solution that is outside the limits by less is at them
_ROUNDED = 1e9  # solutions are sorted by so many parts of a rad or m


def pose_difference(T, target):
    """|p* - p| (m) and the sine of the angle between two poses (4, 4), 1 beyond a quarter turn."""
    e = confirmed.pose_error(T, target)
    w = (e[0], e[1], e[2])
    p = (e[3], e[4], e[5])
    return math.sqrt(dot(p, p)), math.sqrt(dot(w, w))


def sharpen(problem, target, q, work):
    """Newton's rule from q, in place: whether it ends at the target, and the errors (m, rad) there."""
    m = len(q)
    ones = np.ones(6)
    H = work.H
    step = work.rows[STEP]
    for _ in range(int(problem.options[ITERATIONS])):
        run_one(problem.arm, q, work.T, work.J, work.rows[CODE])
        position, rotation = pose_difference(work.T, target)
        if position <= problem.options[TOL_POSITION] and rotation <= problem.options[TOL_ROTATION]:
            return True, position, rotation
        e = confirmed.pose_error(work.T, target)
        least_squares.normal_equations(work.J, e, ones, 0.0, 1.0 - problem.fixed, m, H, step)
        least_squares.solve(H, step, m)
        for i in range(m):
            q[i] += step[i]
    return False, math.inf, math.inf


def is_moved(q, before, most):
    """Whether any coordinate has moved by more than `most`, or is NaN."""
    moved = False
    for i in range(len(q)):
        moved |= not abs(q[i] - before[i]) <= most
    return moved


def is_known(q, others, count, box):
    """Whether a configuration is one of `count` others."""
    for k in range(count):
        i = 0
        while i < len(q) and abs(wrapped_difference(q[i] - others[k, i], box[i, PERIOD])) <= _APART:
            i += 1
        if i == len(q):
            return True
    return False


def placed(q, box):
    """Brings a configuration to its place within the limits that is nearest to 0; returns the number
    of places, 0 where there is none.
    """
    number = 1.0
    for i in range(len(q)):
        low = box[i, LOW]
        high = box[i, HIGH]
        period = box[i, PERIOD]
        if period > 0.0:
            first = np.ceil((low - _EDGE - q[i]) / period)
            last = np.floor((high + _EDGE - q[i]) / period)
            if first > last:
                return 0.0
            if -math.inf < first and last < math.inf:
                number *= last - first + 1.0
            q[i] += period * min(max(0.0, first), last)
        elif not low - _EDGE <= q[i] <= high + _EDGE:
            return 0.0
        q[i] = min(max(q[i], low), high) + 0.0
    return number


def is_before(a, b):
    """Whether a configuration stands before another one in the list."""
    for i in range(len(a)):
        x = np.rint(a[i] * _ROUNDED)
        y = np.rint(b[i] * _ROUNDED)
        if x != y:
            return x < y
    return False


def insert(q, one, errors, numbers, count):
    """Insert a configuration and its numbers into the `count` that are listed, in order."""
    k = count
    while k > 0 and is_before(one, q[k - 1]):
        store_row(q[k], q[k - 1])
        store_row(errors[k], errors[k - 1])
        k -= 1
    store_row(q[k], one)
    store_row(errors[k], numbers)


@kernel("int w3 w2 w4 w3 w2 w1 w1 w1 w3 w2")
def listed(code, q, margins, poses, targets, box, fixed, options, rule, errors, info):
    """Solutions of targets (N, 4, 4) among the branches q (N, B, m), brought to the front of q, in
    order; their errors (N, B, 3) beside them.

    `code` is the arm's own, of pose and hybrid Jacobian; `margins` (N, B) are the branches', NaN
    where there is none, and `poses` (N, B, 4, 4) the arm's there. `fixed` (m) is 1 for what is
    locked.
    """
    m = q.shape[2]
    limits = np.empty((m, 2))
    limits[:, 0] = -math.inf
    limits[:, 1] = math.inf
    problem = KernelProblem(code, limits, fixed, options)
    work = scratch_of_try(m)
    known = np.empty((q.shape[1], m))
    one = np.empty(m)
    for k in range(targets.shape[0]):
        clear = True
        found = 0
        within = 0
        for b in range(q.shape[1]):
            margin = margins[k, b]
            if margin < -rule[ABSENT] or margin != margin:
                continue
            store_row(one, q[k, b])
            position, rotation = pose_difference(poses[k, b], targets[k])
            clear = margin > rule[CLEAR]
            if position > options[TOL_POSITION] or rotation > options[TOL_ROTATION]:
                reached, position, rotation = sharpen(problem, targets[k], one, work)
                clear &= reached and not is_moved(one, q[k, b], rule[MOVED])
            for i in range(m):
                one[i] = wrapped_difference(one[i], box[i, PERIOD])
            clear &= not is_known(one, known, found, box)
            if not clear:
                break
            store_row(known[found], one)
            found += 1
            places = placed(one, box)
            if is_moved(one, known[found - 1], _FAR):
                clear = False
                break
            if places > 0.0:
                insert(q[k], one, errors[k], (position, rotation, places), within)
                within += 1
        info[k, FOUND] = found
        info[k, WITHIN] = within
        # where axes line up, branches that are none may be of infinitely many solutions
        info[k, IS_CLEAR] = int(clear and found > 0)
