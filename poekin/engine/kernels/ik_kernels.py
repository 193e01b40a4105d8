"""Inverse kinematics of one arm: damped least squares from random starts, over the arm's own
machine code.

Each try repeats the step of `formulas.inverse.damped_step`. A coordinate at a limit that the step
would push further stays there, and the others go on without it.

Importing this module imports Numba.
"""

import math
from typing import NamedTuple

import numpy as np

from ...algebra import store_row, subtract, translation, twist
from ...formulas.inverse import damped_step, pose_error
from ...formulas.kinematics import forward
from ..jit.array_io import load_matrix, store_matrix
from ..jit.kernel import kernel
from .arm_kernels import run_one
from .chain_kernels import scratch, set_motions
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
    PLANAR,
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
# Rows of a try's scratch memory: the error, the step, which coordinates are free, and what the
# arm's code needs. `SPARE` more than four times as wide as the arm, it suffices for any arm.
ERROR, STEP, FREE, CODE = range(4)
SPARE = 16


class KernelProblem(NamedTuple):
    """Inputs that all tries of a call share; see `solve_many`."""

    arm: int
    limits: np.ndarray
    fixed: np.ndarray
    options: np.ndarray


class Scratch(NamedTuple):
    """Memory of a try: pose, Jacobian, normal equations, and the rows ERROR, STEP, FREE, CODE."""

    T: np.ndarray
    J: np.ndarray
    H: np.ndarray
    rows: np.ndarray


def scratch_of_try(m):
    """Memory of a try of m coordinates."""
    return Scratch(
        np.empty((4, 4)),
        np.empty((6, m)),
        np.empty((m, m)),
        np.empty((4, 4 * m + SPARE)),
    )


def next_random(state):
    """Pseudo-random number of 64 bits after another one (xorshift)."""
    state ^= state << np.uint64(13)
    state ^= state >> np.uint64(7)
    state ^= state << np.uint64(17)
    return state


def seeded(seed, index):
    """First state of the random numbers for one target: spread by a multiplication (splitmix), and
    never zero.
    """
    state = np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15) + (
        np.uint64(index) + np.uint64(1)
    ) * np.uint64(0xBF58476D1CE4E5B9)
    for _ in range(4):
        state = next_random(state | np.uint64(1))
    return state


def uniform(state, interval):
    """Number in an interval (low, high) from a random number of 64 bits."""
    part = float(state >> np.uint64(11)) * 2.0**-53
    return interval[0] + part * (interval[1] - interval[0])


def error_parts(task, axis, T, target, J, e):
    """Writes the error into e and returns its parts (m, rad), 0 for a part that the task does not
    ask for. J loses what the task leaves free of a direction or out of a plane.
    """
    now = load_matrix(T)
    then = load_matrix(target)
    off = subtract(translation(then), translation(now))
    if task == DIRECTION:
        a, turn = pose_error.direction_error(now, then, axis)
        pose_error.remove_turn_about(a, J, J.shape[1])
    elif task == PLANAR:
        turn = pose_error.planar_error(now, then, axis)
        off = pose_error.across(axis, off)
        pose_error.keep_in_plane(axis, J, J.shape[1])
    else:
        turn = pose_error.rotation_error(now, then)
    store_row(e, twist(turn, off))
    position = pose_error.distance(e)
    rotation = pose_error.angle(turn)
    if task == POSITION:
        rotation = 0.0
    if task == ROTATION:
        position = 0.0
    return position, rotation


def axis_of(options):
    """The tool's direction or the plane's normal."""
    return options[AXIS : AXIS + 3]


def errors_at(problem, task, target, q, T, J, rows):
    """Pose, Jacobian and error at q into T, J and `rows`; returns the error's parts (m, rad)."""
    run_one(problem.arm, q, T, J, rows[CODE])
    return error_parts(task, axis_of(problem.options), T, target, J, rows[ERROR])


def choose_free(problem, weights, q, J, rows):
    """Frees the coordinates that are not fixed and not at a limit that they are pushed against."""
    for i in range(len(q)):
        low = problem.limits[i, 0]
        high = problem.limits[i, 1]
        direction = damped_step.descent(J, rows[ERROR], weights, i)
        rows[FREE, i] = 1.0
        if problem.fixed[i] != 0.0 or damped_step.is_blocked(q[i], low, high, direction):
            rows[FREE, i] = 0.0


def descend(problem, target, q, work):
    """One try: q goes downhill until it is solved, hardly moves or is out of iterations.

    Returns the state, the errors (m, rad), and the iterations taken.
    """
    m = len(q)
    options = problem.options
    task = int(options[TASK])
    weights = options[WEIGHTS:]
    T = work.T
    J = work.J
    H = work.H
    rows = work.rows
    e = rows[ERROR]
    dq = rows[STEP]
    last = math.inf
    slow = 0
    taken = 0
    while True:
        position, rotation = errors_at(problem, task, target, q, T, J, rows)
        if position <= options[TOL_POSITION] and rotation <= options[TOL_ROTATION]:
            return SOLVED, position, rotation, taken
        if taken >= options[ITERATIONS]:
            return OUT_OF_ITERATIONS, position, rotation, taken
        E = damped_step.half_square(e, weights)
        slow += 1
        if _SLOW * last > E:
            slow = 0
        if slow >= _PATIENCE:
            return STALLED, position, rotation, taken
        last = E
        choose_free(problem, weights, q, J, rows)
        damped_step.step(J, e, weights, E, rows[FREE], m, H, dq)
        for i in range(m):
            q[i] = min(
                max(q[i] + dq[i], problem.limits[i, 0]),
                problem.limits[i, 1],
            )
        taken += 1


def is_finite(target):
    """Whether the twelve numbers of a pose that may differ from one to another are finite."""
    total = 0.0
    for r in range(3):
        for c in range(4):
            total += 0.0 * target[r, c]
    return total == 0.0


def set_info(row, position, rotation, iterations, state):
    """Write the errors of q (m, rad), what it took without a restart, and how it ended."""
    row[AT_POSITION] = position
    row[AT_ROTATION] = rotation
    row[AT_ITERATIONS] = iterations
    row[AT_RESTARTS] = 0
    row[AT_STATE] = state


@kernel("int w3 w2 w2 w2 w1 w1 w1 int w2 w2")
def solve_many(arm, targets, q0, limits, ranges, fixed, options, indices, seed, q, info):
    """Joints for targets (N, 4, 4): the first try from q0 (N, m), the others, and what is NaN in
    q0, from anywhere in `ranges` (m, 2).

    `indices` (N) are the targets' own numbers, on which the random starts depend; `fixed` (m) is 1
    where a coordinate stays what it is in q0.
    """
    m = q.shape[1]
    problem = KernelProblem(arm, limits, fixed, options)
    work = scratch_of_try(m)
    trial = np.empty(m)
    for k in range(targets.shape[0]):
        target = targets[k]
        row = info[k]
        if not is_finite(target):
            store_row(q[k], np.full(m, math.nan))
            set_info(row, math.nan, math.nan, 0, BAD_TARGET)
            continue
        state = seeded(seed, int(indices[k]))
        best = math.inf
        total = 0.0
        for attempt in range(int(options[RESTARTS]) + 1):
            for i in range(m):
                trial[i] = q0[k, i]
                if (attempt > 0 or q0[k, i] != q0[k, i]) and fixed[i] == 0.0:
                    state = next_random(state)
                    trial[i] = uniform(state, ranges[i])
            ended, position, rotation, taken = descend(problem, target, trial, work)
            total += taken
            if position + rotation < best or best != best or attempt == 0:
                best = position + rotation
                set_info(row, position, rotation, total, ended)
                store_row(q[k], trial)
            row[AT_ITERATIONS] = total
            row[AT_RESTARTS] = attempt
            if ended == SOLVED:
                break


def is_within(q, limits):
    """Whether a configuration is finite and within its limits."""
    inside = True
    for i in range(len(q)):
        inside &= limits[i, 0] <= q[i] <= limits[i, 1] and not math.isinf(q[i])
    return inside


@kernel("int w2 r2 r1 w2 w1 w1 w1 w1 w1 w1", returns="int", quick=True)
def solve_one(arm, table, target, q0, limits, fixed, options, tolerances, periods, q, info):
    """Whether the first try from q0 (m,) reaches a target (4, 4) by `Chain.fk`: q and info then.

    Coordinates with a period, `periods` (m), end within half of it from 0. All else is left to
    `solve_many`: 0 is returned.
    """
    if not (is_finite(target) and is_within(q0, limits)):
        return 0
    for i in range(len(q)):
        q[i] = q0[i]
    work = scratch_of_try(len(q))
    problem = KernelProblem(arm, limits, fixed, options)
    ended, _, _, taken = descend(problem, target, q, work)
    if ended != SOLVED:
        return 0
    for i in range(len(q)):
        if periods[i] > 0.0:
            q[i] -= periods[i] * np.rint(q[i] / periods[i])
    sines, cosines, shifts = scratch(table)
    set_motions(table, q, sines, cosines, shifts)
    T = work.T
    store_matrix(T, forward.tip(table, sines, cosines, shifts, table.shape[0] - 1))
    e = work.rows[ERROR]
    position, rotation = error_parts(int(options[TASK]), axis_of(options), T, target, work.J, e)
    set_info(info, position, rotation, taken, ended)
    return int(position <= tolerances[0] and rotation <= tolerances[1])


@kernel("w2 w2 w3 int w1 w2")
def pose_errors(table, q, targets, task, axis, errors):
    """|p* - p| (m) and the angle (rad) between the targets and the poses of q, by the kernels of
    any chain; a part that the task does not ask for is 0.
    """
    sines, cosines, shifts = scratch(table)
    work = scratch_of_try(0)
    T = work.T
    e = work.rows[ERROR]
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        store_matrix(T, forward.tip(table, sines, cosines, shifts, table.shape[0] - 1))
        store_row(errors[k], error_parts(task, axis, T, targets[k], work.J, e))
