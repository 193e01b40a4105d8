"""Every solution of a target: the tries of `ik_kernels` from given and random starts, equal ends
counted as one.

Two ends are the same solution where they are one place on the torus, or where the pose halfway
between them is the target's, too: so the many ends that rounding makes of a double solution become
one.
Importing this module imports Numba.
"""

import math

import numpy as np

from ...formulas import least_squares
from ..jit.kernel import kernel
from .arm_kernels import _one
from .ik_codes import AXIS, POSE, SOLVED
from .ik_kernels import _descend, _errors, _next, _seeded

# Where each number stands in `rule`: what is accepted (m and rad alike), how often each solution
# must have been found before a search ends; the most restarts, and the most of them without a
# solution.
ACCEPTED, EACH, RESTARTS, BARREN, RULE = 0, 1, 2, 3, 4
# Where each number stands in a row of `info`: solutions, restarts, ends that are solutions, whether
# there was no room.
FOUND, AT_RESTARTS, AT_ENDS, FULL, INFO = 0, 1, 2, 3, 4

# rad or m: nearer ends are one; of farther ones, up to _NEAR, the pose halfway is looked at
_SAME = 1e-7
_NEAR = 1e-2
# of the largest pivot of J^T J: about the square of the smallest singular value over the largest
_SINGULAR = 1e-10
_MEMBERS = (
    12  # singular solutions that are kept of one target: of a continuum there would be no end
)
_AGAIN = 4  # times a try is gone on with that is near enough to be accepted and not yet at an end
_ODD = (
    8.0  # so many times longer a search goes on while the number of solutions is odd, see `search`
)


def _around(d, period):
    """An angle's difference by the shorter way round; a coordinate without a period has 0 for it."""
    return d - period * math.floor(d / period + 0.5) if period > 0.0 else d


def _same(arm, target, a, b, periods, options, accepted, trial, T, J, work):
    """Whether two ends are one solution; `trial`, T, J and work are scratch."""
    apart = 0.0
    for i in range(len(a)):
        d = _around(b[i] - a[i], periods[i])
        apart = max(apart, abs(d))
        trial[i] = a[i] + 0.5 * d
    if apart <= _SAME or apart > _NEAR:
        return apart <= _SAME
    _one(arm, trial, T, J, work[3])
    position, rotation = _errors(POSE, options[AXIS : AXIS + 3], T, target, J, work[0])
    return position <= accepted and rotation <= accepted


def _is_singular(J, m, ones, H, g):
    """Whether J has nearly dependent columns; H and g are scratch."""
    for r in range(6):
        g[r] = 0.0
    least_squares.normal_equations(J, g, ones, 1e-30, ones, 6, m, H, g)
    least_squares.solve(H, g, m)
    low, high = H[0, 0], H[0, 0]
    for i in range(1, m):
        low, high = min(low, H[i, i]), max(high, H[i, i])
    return low < _SINGULAR * high


def _enough(hits, singular, count, each, pairs):
    """Whether each solution was found often enough; of those that are singular, on the average."""
    together, members = 0.0, 0
    for j in range(count):
        if singular[j]:
            members += 1
            together += hits[j]
    if pairs and count % 2 == 1 and members == 0:
        each *= _ODD
    for j in range(count):
        if not singular[j] and hits[j] < each:
            return False
    return together >= each * members


@kernel("int w3 w3 w1 w2 w2 w1 w1 w1 w1 int w3 w2 w2")
def search(
    arm,
    targets,
    starts,
    given,
    limits,
    ranges,
    periods,
    options,
    rule,
    indices,
    seed,
    q,
    hits,
    info,
):
    """Solutions of targets (N, 4, 4) into q (N, room, m), how often each was found into hits (N,
    room).

    Each target is tried from its first given[k] of starts[k] (S, m) and then from random places in
    `ranges` (m, 2) as long as `rule` asks for; `periods` (m) are those of the coordinates, 0 for
    none, `indices` (N) the targets' own numbers, on which the random starts depend.
    Solutions of six equations in six unknowns come in pairs but for double ones, so an odd number
    means one of these, or that one is missing.
    """
    m, room = q.shape[2], q.shape[1]
    T, J, H = np.empty((4, 4)), np.empty((6, m)), np.empty((m, m))
    work, trial, middle, fixed = np.empty((4, 4 * m + 16)), np.empty(m), np.empty(m), np.zeros(m)
    ones, singular = np.ones(6), np.zeros(room, np.bool_)
    for k in range(targets.shape[0]):
        target, state, row = targets[k], _seeded(seed, int(indices[k])), info[k]
        first, count, members, ends = int(given[k]), 0, 0, 0.0
        row[FULL] = 0.0
        attempt = 0
        while attempt < first + int(rule[RESTARTS]) and row[FULL] == 0.0:
            if attempt >= first + int(rule[BARREN]) and count == 0:
                break
            if (
                attempt > first
                and count > 0
                and _enough(hits[k], singular, count, rule[EACH], m == 6)
            ):
                break
            for i in range(m):
                if attempt < first:
                    trial[i] = starts[k, attempt, i]
                else:
                    state = _next(state)
                    part = float(state >> np.uint64(11)) * 2.0**-53
                    trial[i] = ranges[i, 0] + part * (ranges[i, 1] - ranges[i, 0])
            attempt += 1
            position, rotation = math.inf, math.inf
            for _ in range(_AGAIN):  # where solutions are nearly one, the last digits take long
                ended, position, rotation, _ = _descend(
                    arm, target, trial, limits, fixed, options, work, T, J, H
                )
                if ended == SOLVED or not (
                    position <= rule[ACCEPTED] and rotation <= rule[ACCEPTED]
                ):
                    break
            if not (position <= rule[ACCEPTED] and rotation <= rule[ACCEPTED]):
                continue
            ends += 1.0
            bad = _is_singular(J, m, ones, H, work[1])
            for i in range(m):
                trial[i] = _around(trial[i], periods[i])
            j = 0
            while j < count and not _same(
                arm, target, q[k, j], trial, periods, options, rule[ACCEPTED], middle, T, J, work
            ):
                j += 1
            if j < count:
                hits[k, j] += 1.0
            elif bad and members >= _MEMBERS:
                continue
            elif count < room:
                singular[count] = bad
                members += int(bad)
                for i in range(m):
                    q[k, count, i] = trial[i]
                hits[k, count] = 1.0
                count += 1
            else:
                row[FULL] = 1.0
        row[FOUND], row[AT_RESTARTS], row[AT_ENDS] = count, max(attempt - first, 0), ends
