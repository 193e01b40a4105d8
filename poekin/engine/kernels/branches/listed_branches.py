"""All solutions of targets whose branches, in closed form or by elimination, are clear of one another:
sharpened, brought into the limits and in order. Importing this module imports Numba.

Of a target that is not clear nothing is listed: where solutions are one or infinitely many, `search`
of `ik_all_kernel` tells them apart.
"""

import math
from typing import NamedTuple

import numpy as np

from ...jit.array_io import without_refcount
from ...jit.kernel import kernel
from ...straight_line.machine_code import LANES
from ..ik_all_kernel import wrapped_difference
from .sharpen import (
    POSITION,
    ROTATION,
    Branches,
    BranchProblem,
    is_reached,
    sharpen,
    sharpening,
)

# Where each number stands in `rule`: margin above which a branch is a solution, and below whose
# negative it is none; how far (rad or m) a solution may be from its branch; and below whose negative
# the margins of a target without any solution are.
CLEAR = 0
ABSENT = 1
MOVED = 2
HOPELESS = 3
RULE = 4
# Where each number stands in a row of `box`.
LOW = 0
HIGH = 1
PERIOD = 2
# Where in a row of `errors`, after m and rad, it stands in how many places the solution is.
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


def is_moved(q, k, before, b, most):
    """Whether any coordinate of row k has moved by more than `most` from row b, or is NaN."""
    moved = False
    for i in range(q.shape[1]):
        moved |= not abs(q[k, i] - before[b, i]) <= most
    return moved


def is_known(q, k, first, box):
    """Whether row k of q is one of the rows before it from the first of its target on."""
    m = q.shape[1]
    for j in range(first, k):
        i = 0
        while i < m and abs(wrapped_difference(q[k, i] - q[j, i], box[i, PERIOD])) <= _APART:
            i += 1
        if i == m:
            return True
    return False


def placed(q, k, box):
    """Brings row k of q to its place within the limits that is nearest to 0; returns the number of
    places, 0 where there is none.
    """
    number = 1.0
    for i in range(q.shape[1]):
        x = q[k, i]
        low = box[i, LOW]
        high = box[i, HIGH]
        period = box[i, PERIOD]
        if period > 0.0:
            if low == -math.inf and high == math.inf:
                q[k, i] = x + 0.0
                continue
            first = np.ceil((low - _EDGE - x) / period)
            last = np.floor((high + _EDGE - x) / period)
            if first > last:
                return 0.0
            if -math.inf < first and last < math.inf:
                number *= last - first + 1.0
            x += period * min(max(0.0, first), last)
        elif not low - _EDGE <= x <= high + _EDGE:
            return 0.0
        q[k, i] = min(max(x, low), high) + 0.0
    return number


def is_before(keys, a, b):
    """Whether row a of the keys stands before row b."""
    for i in range(keys.shape[1]):
        if keys[a, i] != keys[b, i]:
            return keys[a, i] < keys[b, i]
    return False


def insert(keys, order, count):
    """Put the row after the `count` that are in order among them."""
    k = count
    while k > 0 and is_before(keys, count, order[k - 1]):
        order[k] = order[k - 1]
        k -= 1
    order[k] = count


def may_be(margin, rule):
    """Whether a branch of this margin may be a solution; NaN is of none."""
    return margin >= -rule[ABSENT]


def gather(rows, rule, q, owners):
    """Write the branches that may be solutions into rows of q, one target's after the other's, with
    the numbers of these; returns how many there are. Some more rows after them are the last one's.
    """
    m = q.shape[1]
    count = 0
    for k in range(rows.shape[0]):
        for b in range(rows.shape[1]):
            if may_be(rows[k, b, m], rule):
                for i in range(m):
                    q[count, i] = rows[k, b, i]
                owners[count] = k
                count += 1
    last = count - 1  # without any branch a row that nobody reads
    for k in range(count, count + LANES):
        for i in range(m):
            q[k, i] = q[last, i]
        owners[k] = owners[last]
    return count


@kernel("int w3 w3 w2 w1 w1 w1 w2 w2 w2")
def listed(code, rows, targets, box, fixed, options, rule, q, errors, info):
    """Solutions of targets (N, 4, 4) among branches (N, B, m + 1), coordinates and margin: written
    one target's after the other's, in order, into q (S, m) and their errors (S, 3).

    `code` is the arm's own, of pose and hybrid Jacobian; a margin is NaN where there is no branch.
    `fixed` (m) is 1 for what is locked.
    """
    problem = BranchProblem(code, box, rule, options)
    most = rows.shape[1]
    m = q.shape[1]
    room = rows.shape[0] * most + LANES
    branches = Branches(
        np.empty((room, m)),
        np.empty((room, 2)),
        np.zeros(room, np.int64),
    )
    one = Listed(
        np.empty((most, m)),
        np.empty((most, m)),
        np.empty((most, ERRORS)),
        np.empty(most, np.int64),
    )
    list_all(problem, rows, targets, branches, one, sharpening(fixed), (q, errors, info))


class Listed(NamedTuple):
    """Solutions of one target: coordinates, keys by which they are sorted, numbers, and their order."""

    q: np.ndarray
    keys: np.ndarray
    numbers: np.ndarray
    order: np.ndarray


def list_all(problem, rows, targets, branches, one, work, out):
    """`listed` with the arrays of a call."""
    problem = without_refcount(problem)
    rows = without_refcount(rows)
    targets = without_refcount(targets)
    branches = without_refcount(branches)
    one = without_refcount(one)
    work = without_refcount(work)
    q, errors, info = without_refcount(out)
    count = gather(rows, problem.rule, branches.q, branches.owners)
    for first in range(0, count, LANES):
        sharpen(problem, targets, branches, first, work)
    first = 0
    total = 0
    for k in range(targets.shape[0]):
        number, within = list_one(problem, rows[k], branches, first, one, info[k])
        for i in range(within):
            place = one.order[i]
            for j in range(q.shape[1]):
                q[total + i, j] = one.q[place, j]
            for j in range(ERRORS):
                errors[total + i, j] = one.numbers[place, j]
        first += number
        total += within


def list_one(problem, rows, branches, first, one, info):
    """List the solutions of one target, whose branches are the first of some; returns the number of
    its branches that may be such, and that of the solutions.
    """
    box = problem.box
    rule = problem.rule
    found = branches.q
    ends = branches.errors
    places = one.q
    keys = one.keys
    m = found.shape[1]
    clear = True
    hopeless = True
    at = first
    within = 0
    for b in range(rows.shape[0]):
        hopeless &= not rows[b, m] >= -rule[HOPELESS]
        if not may_be(rows[b, m], rule):
            continue
        clear &= rows[b, m] > rule[CLEAR] and is_reached(ends, at, problem.options)
        clear &= not is_moved(found, at, rows, b, rule[MOVED])
        for i in range(m):
            found[at, i] = wrapped_difference(found[at, i], box[i, PERIOD])
            places[within, i] = found[at, i]
        clear = clear and not is_known(found, at, first, box)
        if clear:
            number = placed(places, within, box)
            clear = not is_moved(places, within, found, at, _FAR)
            if number > 0.0:
                for i in range(m):
                    keys[within, i] = np.rint(places[within, i] * _ROUNDED)
                one.numbers[within, POSITION] = ends[at, POSITION]
                one.numbers[within, ROTATION] = ends[at, ROTATION]
                one.numbers[within, PLACES] = number
                insert(keys, one.order, within)
                within += 1
        at += 1
    # where axes line up, branches that are none may be of infinitely many solutions
    clear = clear and (at > first or hopeless)
    if not clear:
        within = 0
    info[FOUND] = at - first
    info[WITHIN] = within
    info[IS_CLEAR] = int(clear)
    return at - first, within
