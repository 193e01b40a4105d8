"""Every solution of a target: the tries of `ik_kernels` from given and random starts, equal ends
counted as one.

Two ends are the same solution where they are one place on the torus, or where the pose halfway
between them is the target's, too: so the many ends that rounding makes of a double solution become
one.
Importing this module imports Numba.
"""

import math

import numpy as np

from ...algebra import store_row
from ...formulas.inverse import least_squares
from ..jit.kernel import kernel
from .ik_codes import POSE, SOLVED
from .ik_kernels import (
    STEP,
    KernelProblem,
    descend,
    errors_at,
    next_random,
    scratch_of_try,
    seeded,
    uniform,
)

# Where each number stands in `rule`: what is accepted (m and rad alike), how often each solution
# must have been found before a search ends; the most restarts, and the most of them without a
# solution.
MAX_ERROR = 0
MIN_HITS = 1
RESTARTS = 2
MAX_MISSES = 3
RULE = 4
# Where each number stands in a row of `info`: solutions, restarts, ends that are solutions, whether
# there was no room.
FOUND = 0
AT_RESTARTS = 1
AT_ENDS = 2
FULL = 3
INFO = 4

# rad or m: nearer ends are one; of farther ones, up to _NEAR, the pose halfway is looked at
_SAME = 1e-7
_NEAR = 1e-2
# of the largest pivot of J^T J: about the square of the smallest singular value over the largest
_SINGULAR = 1e-10
# singular solutions that are kept of one target: of a continuum there would be no end
_MAX_SINGULAR = 12
# times a try is gone on with that is near enough to be accepted and not yet at an end
_CONTINUATIONS = 4
# so many times longer a search goes on while the number of solutions is odd, see `search`
_ODD_FACTOR = 8.0


def wrapped_difference(d, period):
    """Difference of an angle by the shorter way round; a coordinate without a period has 0 for it."""
    half = 0.5 * period
    if period > 0.0 and not -half <= d < half:
        return d - period * math.floor(d / period + 0.5)
    return d


def is_accepted(position, rotation, limit):
    """Whether both parts of an error are small enough; NaN is not."""
    return position <= limit and rotation <= limit


def is_same(problem, target, ends, periods, limit, work):
    """Whether two ends are one solution; `ends` are both, and memory for their middle."""
    a, b, middle = ends
    apart = 0.0
    for i in range(len(a)):
        d = wrapped_difference(b[i] - a[i], periods[i])
        apart = max(apart, abs(d))
        middle[i] = a[i] + 0.5 * d
    if apart <= _SAME or apart > _NEAR:
        return apart <= _SAME
    position, rotation = errors_at(problem, POSE, target, middle, work.T, work.J, work.rows)
    return is_accepted(position, rotation, limit)


def is_singular(ones, free, work):
    """Whether the Jacobian of `work` has nearly dependent columns; `free` (m) is 1 for those that
    count. The pivots of J^T J stay on the diagonal of H.
    """
    J = work.J
    H = work.H
    step = work.rows[STEP]
    m = J.shape[1]
    least_squares.normal_equations(J, ones, ones, 1e-30, free, m, H, step)
    least_squares.solve(H, step, m)
    low = math.inf
    high = 0.0
    for i in range(m):
        if free[i] != 0.0:
            low = min(low, H[i, i])
            high = max(high, H[i, i])
    return low < _SINGULAR * high


def condition_bound(free, work):
    """Lower bound of the smallest singular value of the Jacobian over the largest, by the pivots
    that `is_singular` left.

    The product of the squared values is that of the pivots; the n - 1 largest are at most their
    mean to the power n - 1, and the largest is at most their sum, which is the trace of J^T J.
    """
    J = work.J
    trace = 0.0
    product = 1.0
    count = 0.0
    for i in range(J.shape[1]):
        if free[i] != 0.0:
            count += 1.0
            pivot = work.H[i, i]
            if not pivot > 0.0:  # after one of 0 they are no numbers
                return 0.0
            product *= pivot
            for r in range(6):
                trace += J[r, i] * J[r, i]
    if trace == 0.0:
        return 0.0
    product *= (count - 1.0) ** (count - 1.0) / trace**count
    return math.sqrt(product)


def is_enough(hits, singular, count, each, pairs):
    """Whether each solution was found often enough; of those that are singular, on the average."""
    together = 0.0
    members = 0
    for j in range(count):
        if singular[j]:
            members += 1
            together += hits[j]
    if pairs and count % 2 == 1 and members == 0:
        each *= _ODD_FACTOR
    for j in range(count):
        if not singular[j] and hits[j] < each:
            return False
    return together >= each * members


def reach(problem, target, q, limit, work):
    """Whether a try from q ends at a solution, q then.

    Where solutions are nearly one, the last digits take long: then it is gone on with.
    """
    for _ in range(_CONTINUATIONS):
        ended, position, rotation, _ = descend(problem, target, q, work)
        accepted = is_accepted(position, rotation, limit)
        if ended == SOLVED or not accepted:
            return accepted
    return True


def is_over(attempts, count, rule):
    """Whether a search has had all its restarts, or too many of them without a solution."""
    if count == 0 and attempts >= int(rule[MAX_MISSES]):
        return True
    return attempts >= int(rule[RESTARTS])


@kernel("int w3 w3 w1 w2 w2 w1 w1 w2 w1 w1 w1 int w3 w2 w2 w2")
def search(
    arm,
    targets,
    starts,
    given,
    limits,
    ranges,
    periods,
    free,
    locked_values,
    options,
    rule,
    indices,
    seed,
    q,
    hits,
    bounds,
    info,
):
    """Solutions of targets (N, 4, 4) into q (N, room, m), how often each was found into hits (N,
    room), the `condition_bound` of each into bounds (N, room).

    Each target is tried from its first given[k] of starts[k] (S, m) and then from random places in
    `ranges` (m, 2) as long as `rule` asks for; `periods` (m) are those of the coordinates, 0 for
    none, `indices` (N) the targets' own numbers, on which the random starts depend. Coordinates that are
    not free (m) stay at the target's `locked_values` (N, m); the given starts have these values.
    Solutions of six equations in six unknowns come in pairs but for double ones, so an odd number
    means one of these, or that one is missing.
    """
    m = q.shape[2]
    problem = KernelProblem(arm, limits, 1.0 - free, options)
    work = scratch_of_try(m)
    pairs = free.sum() == 6.0
    trial = np.empty(m)
    middle = np.empty(m)
    ones = np.ones(6)
    singular = np.zeros(q.shape[1], np.bool_)
    limit = rule[MAX_ERROR]
    for k in range(targets.shape[0]):
        target = targets[k]
        state = seeded(seed, int(indices[k]))
        first = int(given[k])
        count = 0
        members = 0
        ends = 0.0
        full = False
        attempt = 0
        while not full and not is_over(attempt - first, count, rule):
            tried = attempt > first and count > 0
            if tried and is_enough(hits[k], singular, count, rule[MIN_HITS], pairs):
                break
            for i in range(m):
                if attempt < first:
                    trial[i] = starts[k, attempt, i]
                elif free[i] == 0.0:
                    trial[i] = locked_values[k, i]
                else:
                    state = next_random(state)
                    trial[i] = uniform(state, ranges[i])
            attempt += 1
            if not reach(problem, target, trial, limit, work):
                continue
            ends += 1.0
            bad = is_singular(ones, free, work)
            for i in range(m):
                trial[i] = wrapped_difference(trial[i], periods[i])
            j = 0
            while j < count and not is_same(
                problem,
                target,
                (q[k, j], trial, middle),
                periods,
                limit,
                work,
            ):
                j += 1
            if j < count:
                hits[k, j] += 1.0
            elif bad and members >= _MAX_SINGULAR:
                continue
            elif count < q.shape[1]:
                singular[count] = bad
                members += int(bad)
                store_row(q[k, count], trial)
                hits[k, count] = 1.0
                bounds[k, count] = condition_bound(free, work)
                count += 1
            else:
                full = True
        info[k, FOUND] = count
        info[k, AT_RESTARTS] = max(attempt - first, 0)
        info[k, AT_ENDS] = ends
        info[k, FULL] = int(full)
