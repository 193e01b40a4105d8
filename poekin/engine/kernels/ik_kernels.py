"""Inverse kinematics of one arm: damped least squares from random starts, over the arm's own
machine code.

Each step solves (J^T W J + E I) dq = J^T W e with the hybrid Jacobian and the error e = (rotation
vector, p* - p) in the axes of the base; the damping is the error's own size, E = 0.1 e^T W e / 2
(of a slide no more than its column's): far from the target the step is careful, near it Newton's. A
coordinate at a limit that the step would push further stays there, and the others go on without it.
Source: Chan and Lawrence 1988 (error-scaled damping), as in Sugihara 2011.

Importing this module imports Numba.
"""

import math

import numpy as np

from ...algebra import cross, dot
from ...formulas import least_squares
from ...formulas.kinematics import forward
from ...formulas.lie import quaternion
from ..jit.array_io import store_matrix
from ..jit.kernel import kernel
from .arm_kernels import _one
from .chain_kernels import _motions, _scratch
from .ik_codes import (
    AT_ITERATIONS,
    AT_POSITION,
    AT_RESTARTS,
    AT_ROTATION,
    AT_STATE,
    AXIS,
    BAD_TARGET,
    DIRECTION,
    ITERATIONS,
    OUT_OF_ITERATIONS,
    POSITION,
    RESTARTS,
    ROTATION,
    SOLVED,
    STALLED,
    TASK,
    TOL_POSITION,
    TOL_ROTATION,
    WEIGHTS,
)

_SLOW = 0.9  # a step that leaves more than this of the error hardly moves
_PATIENCE = 3  # such steps one after the other end a try
_REGULAR = 1e-14  # of the largest: some ten times the rounding
_DAMPING = 0.1  # by trial: fewest steps over Panda, UR5 and Puma 560, within limits


def _next(state):
    """A pseudo-random number of 64 bits after another one (xorshift)."""
    state ^= state << np.uint64(13)
    state ^= state >> np.uint64(7)
    state ^= state << np.uint64(17)
    return state


def _seeded(seed, index):
    """The first state of the numbers for one target: spread by a multiplication (splitmix), never
    zero.
    """
    state = np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15) + (
        np.uint64(index) + np.uint64(1)
    ) * np.uint64(0xBF58476D1CE4E5B9)
    for _ in range(4):
        state = _next(state | np.uint64(1))
    return state


def _rotation_error(R, S):
    """2 sin(angle / 2) times the axis of S R^T, in the axes of the base."""
    product = (
        S[0, 0] * R[0, 0] + S[0, 1] * R[0, 1] + S[0, 2] * R[0, 2],
        S[0, 0] * R[1, 0] + S[0, 1] * R[1, 1] + S[0, 2] * R[1, 2],
        S[0, 0] * R[2, 0] + S[0, 1] * R[2, 1] + S[0, 2] * R[2, 2],
        S[1, 0] * R[0, 0] + S[1, 1] * R[0, 1] + S[1, 2] * R[0, 2],
        S[1, 0] * R[1, 0] + S[1, 1] * R[1, 1] + S[1, 2] * R[1, 2],
        S[1, 0] * R[2, 0] + S[1, 1] * R[2, 1] + S[1, 2] * R[2, 2],
        S[2, 0] * R[0, 0] + S[2, 1] * R[0, 1] + S[2, 2] * R[0, 2],
        S[2, 0] * R[1, 0] + S[2, 1] * R[1, 1] + S[2, 2] * R[1, 2],
        S[2, 0] * R[2, 0] + S[2, 1] * R[2, 1] + S[2, 2] * R[2, 2],
    )
    w, x, y, z = quaternion.quaternion(product)
    k = 2.0 / math.sqrt(w * w + x * x + y * y + z * z)
    return k * x, k * y, k * z


def _direction_error(T, target, axis):
    """2 sin(angle / 2) times the axis of the smallest turn that takes the tool's direction to the
    target's.
    """
    a = (
        T[0, 0] * axis[0] + T[0, 1] * axis[1] + T[0, 2] * axis[2],
        T[1, 0] * axis[0] + T[1, 1] * axis[1] + T[1, 2] * axis[2],
        T[2, 0] * axis[0] + T[2, 1] * axis[1] + T[2, 2] * axis[2],
    )
    b = (
        target[0, 0] * axis[0] + target[0, 1] * axis[1] + target[0, 2] * axis[2],
        target[1, 0] * axis[0] + target[1, 1] * axis[1] + target[1, 2] * axis[2],
        target[2, 0] * axis[0] + target[2, 1] * axis[1] + target[2, 2] * axis[2],
    )
    n = cross(a, b)
    sine, cosine = math.sqrt(dot(n, n)), dot(a, b)
    half = 2.0 * math.sin(0.5 * math.atan2(sine, cosine))
    if (
        sine == 0.0 and cosine < 0.0
    ):  # opposite: half a turn about anything across, here about the longer of two
        n = cross(a, (1.0, 0.0, 0.0) if abs(a[0]) < 0.6 else (0.0, 1.0, 0.0))
        sine = math.sqrt(dot(n, n))
    k = half / sine if sine > 0.0 else 0.0
    return a, (k * n[0], k * n[1], k * n[2])


def _angle(turn):
    """The angle (rad) of what is 2 sin(angle / 2) long."""
    return 2.0 * math.asin(min(0.5 * math.sqrt(dot(turn, turn)), 1.0))


def _errors(task, axis, T, target, J, e):
    """The error into e; returned are its parts (m, rad). Of a direction, J loses the turn about it."""
    e[3], e[4], e[5] = target[0, 3] - T[0, 3], target[1, 3] - T[1, 3], target[2, 3] - T[2, 3]
    position = math.sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5])
    if task == DIRECTION:
        a, b = _direction_error(T, target, axis)
        e[0], e[1], e[2] = b
        for i in range(J.shape[1]):
            along = a[0] * J[0, i] + a[1] * J[1, i] + a[2] * J[2, i]
            J[0, i] -= along * a[0]
            J[1, i] -= along * a[1]
            J[2, i] -= along * a[2]
    else:
        e[0], e[1], e[2] = _rotation_error(T, target)
    rotation = _angle((e[0], e[1], e[2]))
    if task == POSITION:
        rotation = 0.0
    if task == ROTATION:
        position = 0.0
    return position, rotation


def _ease_slides(J, weights, damping, free, H):
    """Take the damping off a coordinate that slides, as far as it is more than 1 and than the
    column's own size.

    Care is for turns, whose columns change on the way: over many metres a slide would hardly move.
    """
    for i in range(J.shape[1]):
        if (
            damping > 1.0
            and free[i] != 0.0
            and J[0, i] == 0.0
            and J[1, i] == 0.0
            and J[2, i] == 0.0
        ):
            own = 0.0
            for r in range(3, 6):
                own += weights[r] * J[r, i] * J[r, i]
            H[i, i] -= max(damping - max(own, 1.0), 0.0)


def _keep_regular(free, H):
    """Add to the diagonal some times what its numbers are rounded by: with joints to spare J^T W J
    is singular.
    """
    top = 0.0
    for i in range(H.shape[0]):
        top = max(top, free[i] * H[i, i])
    for i in range(H.shape[0]):
        H[i, i] += _REGULAR * top


def _descend(arm, target, q, limits, fixed, options, work, T, J, H):
    """One try: q goes downhill until it is solved, hardly moves or is out of iterations.

    Returns the state, the errors, and the iterations taken. `work` are rows of scratch: e, g, free,
    and more.
    """
    m = len(q)
    e, g, free, scratch = work[0], work[1], work[2], work[3]
    weights, axis = options[WEIGHTS : WEIGHTS + 6], options[AXIS : AXIS + 3]
    task = int(options[TASK])
    last, slow = math.inf, 0
    taken = 0
    while True:
        _one(arm, q, T, J, scratch)
        position, rotation = _errors(task, axis, T, target, J, e)
        if position <= options[TOL_POSITION] and rotation <= options[TOL_ROTATION]:
            return SOLVED, position, rotation, taken
        if taken >= options[ITERATIONS]:
            return OUT_OF_ITERATIONS, position, rotation, taken
        size = 0.0
        for r in range(6):
            size += 0.5 * weights[r] * e[r] * e[r]
        slow = slow + 1 if not size < _SLOW * last else 0
        if slow >= _PATIENCE:
            return STALLED, position, rotation, taken
        last = size
        for i in range(m):
            pull = 0.0
            for r in range(6):
                pull += J[r, i] * weights[r] * e[r]
            stuck = (q[i] <= limits[i, 0] and pull < 0.0) or (q[i] >= limits[i, 1] and pull > 0.0)
            free[i] = 0.0 if stuck or fixed[i] != 0.0 else 1.0
        least_squares.normal_equations(J, e, weights, _DAMPING * size, free, 6, m, H, g)
        _ease_slides(J, weights, _DAMPING * size, free, H)
        _keep_regular(free, H)
        least_squares.solve(H, g, m)
        for i in range(m):
            q[i] = min(max(q[i] + g[i], limits[i, 0]), limits[i, 1])
        taken += 1


def _finite(target):
    total = 0.0
    for r in range(3):
        for c in range(4):
            total += 0.0 * target[r, c]
    return total == 0.0


@kernel("int w3 w2 w2 w2 w1 w1 w1 int w2 w2")
def solve_many(arm, targets, q0, limits, ranges, fixed, options, indices, seed, q, info):
    """Joints for targets (N, 4, 4): the first try from q0 (N, m), the others, and what is NaN in
    q0, from anywhere in `ranges` (m, 2).

    `indices` (N) are the targets' own numbers, on which the random starts depend; `fixed` (m) is 1
    where a coordinate stays what it is in q0.
    """
    m = q.shape[1]
    T, J, H = np.empty((4, 4)), np.empty((6, m)), np.empty((m, m))
    work, trial = np.empty((4, 4 * m + 16)), np.empty(m)
    for k in range(targets.shape[0]):
        target, state = targets[k], _seeded(seed, int(indices[k]))
        row, best, total = info[k], math.inf, 0.0
        if not _finite(target):
            for i in range(m):
                q[k, i] = math.nan
            row[AT_POSITION], row[AT_ROTATION] = math.nan, math.nan
            row[AT_ITERATIONS], row[AT_RESTARTS], row[AT_STATE] = 0.0, 0.0, BAD_TARGET
            continue
        for attempt in range(int(options[RESTARTS]) + 1):
            for i in range(m):
                trial[i] = q0[k, i]
                if (attempt > 0 or q0[k, i] != q0[k, i]) and fixed[i] == 0.0:
                    state = _next(state)
                    part = float(state >> np.uint64(11)) * 2.0**-53
                    trial[i] = ranges[i, 0] + part * (ranges[i, 1] - ranges[i, 0])
            ended, position, rotation, taken = _descend(
                arm, target, trial, limits, fixed, options, work, T, J, H
            )
            total += taken
            if position + rotation < best or best != best or attempt == 0:
                best = position + rotation
                row[AT_POSITION], row[AT_ROTATION], row[AT_STATE] = position, rotation, ended
                for i in range(m):
                    q[k, i] = trial[i]
            row[AT_ITERATIONS], row[AT_RESTARTS] = total, attempt
            if ended == SOLVED:
                break


@kernel("w2 w2 w3 int w1 w2")
def judge(table, q, targets, task, axis, errors):
    """|p* - p| (m) and the angle (rad) between the targets and the poses of q, by the kernels of
    any chain; a part that the task does not ask for is 0.
    """
    sines, cosines, shifts = _scratch(table)
    n, T = table.shape[0] - 1, np.empty((4, 4))
    for k in range(q.shape[0]):
        _motions(table, q[k], sines, cosines, shifts)
        store_matrix(T, forward.tip(table, sines, cosines, shifts, n))
        target = targets[k]
        x, y, z = target[0, 3] - T[0, 3], target[1, 3] - T[1, 3], target[2, 3] - T[2, 3]
        position, rotation = math.sqrt(x * x + y * y + z * z), 0.0
        if task == DIRECTION:
            _, turn = _direction_error(T, target, axis)
            rotation = _angle(turn)
        elif task != POSITION:
            rotation = _angle(_rotation_error(T, target))
        errors[k, 0], errors[k, 1] = 0.0 if task == ROTATION else position, rotation
