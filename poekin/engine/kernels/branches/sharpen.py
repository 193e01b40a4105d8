"""Newton's rule on branches, four of them at once.

J dq = e,   e = (sin(phi) n; p* - p),   as in `formulas.inverse.confirmed`
"""

import math
from typing import NamedTuple

import numpy as np

from ....algebra import dot
from ....formulas.inverse import confirmed, least_squares
from ...lanes import rows as lanes
from ...straight_line.machine_code import LANES
from ..arm_kernels import run_four
from ..ik_codes import ITERATIONS, TOL_POSITION, TOL_ROTATION
from ..ik_kernels import SPARE

# Where each number stands in a row of errors: m and rad.
POSITION = 0
ROTATION = 1

_USUAL = 6  # coordinates


class BranchProblem(NamedTuple):
    """Inputs that all targets of a call share; see `listed_branches.listed`."""

    arm: int
    box: np.ndarray
    rule: np.ndarray
    options: np.ndarray


class Branches(NamedTuple):
    """Branches of all targets that may be solutions: coordinates, errors, and the target's number."""

    q: np.ndarray
    errors: np.ndarray
    owners: np.ndarray


class Sharpening(NamedTuple):
    """Weights of an error, which coordinates are free, and arrays that every four configurations use
    anew: their poses and Jacobians; these with the errors, equations and steps, each number of all
    four beside one another.
    """

    weights: np.ndarray
    free: np.ndarray
    T: np.ndarray
    J: np.ndarray
    code: np.ndarray
    rows: np.ndarray
    e: np.ndarray
    H: np.ndarray
    step: np.ndarray


def sharpening(fixed):
    """Arrays for an arm of which some coordinates are `fixed` (m), 1 of them and 0 of others."""
    m = len(fixed)
    return Sharpening(
        np.ones(6),
        1.0 - fixed,
        np.empty((LANES, 4, 4)),
        np.empty((LANES, 6, m)),
        np.empty(2 * LANES * (m + SPARE)),
        np.empty((6, LANES * m)),
        np.empty(LANES * 6),
        np.empty((m, LANES * m)),
        np.empty(LANES * m),
    )


def is_reached(errors, k, options):
    """Whether both errors of row k are small enough; NaN is not."""
    return (
        errors[k, POSITION] <= options[TOL_POSITION]
        and errors[k, ROTATION] <= options[TOL_ROTATION]
    )


def sharpen(problem, targets, branches, first, work):
    """Newton's rule from four branches, in place, and the errors (m, rad) at the end of each: until
    it is at the target of its owner, or out of iterations.
    """
    options = problem.options
    owners = branches.owners
    q = branches.q
    errors = branches.errors
    T = work.T
    J = work.J
    step = work.step
    some = q[first : first + LANES]
    for _ in range(int(options[ITERATIONS])):
        run_four(problem.arm, some, T, J, work.code)
        is_done = True
        for k in range(LANES):
            now = nested(T, k)
            e = confirmed.pose_error(now, nested(targets, owners[first + k]))
            set_error(work.e, errors, k, first + k, e)
            is_done &= is_reached(errors, first + k, options)
        if is_done:
            break
        _solve(work)
        for k in range(LANES):
            if not is_reached(errors, first + k, options):
                for i in range(q.shape[1]):
                    q[first + k, i] += step[LANES * i + k]


def nested(T, k):
    """The first rows of the k-th matrix (4, 4)."""
    return (
        (T[k, 0, 0], T[k, 0, 1], T[k, 0, 2], T[k, 0, 3]),
        (T[k, 1, 0], T[k, 1, 1], T[k, 1, 2], T[k, 1, 3]),
        (T[k, 2, 0], T[k, 2, 1], T[k, 2, 2], T[k, 2, 3]),
    )


def set_error(all_four, lengths, lane, k, e):
    """Write an error into its lane of all four, and its lengths into row k; the position's is very
    large beyond a quarter turn.
    """
    for i in range(6):
        all_four[LANES * i + lane] = e[i]
    w = (e[0], e[1], e[2])
    p = (e[3], e[4], e[5])
    lengths[k, POSITION] = math.sqrt(dot(p, p))
    lengths[k, ROTATION] = math.sqrt(dot(w, w))


def _solve(work):
    """Newton's steps of all four."""
    m = work.J.shape[2]
    rows = work.rows
    slopes = work.J
    for r in range(6):
        for i in range(m):
            for k in range(LANES):
                rows[r, LANES * i + k] = slopes[k, r, i]
    J = lanes.table(rows)
    e = lanes.rows(work.e)
    H = lanes.table(work.H)
    step = lanes.rows(work.step)
    least_squares.normal_equations(J, e, work.weights, 0.0, work.free, m, H, step)
    if m == _USUAL:
        # loops of a length that is known are unrolled
        least_squares.solve(H, step, _USUAL)
    else:
        least_squares.solve(H, step, m)
