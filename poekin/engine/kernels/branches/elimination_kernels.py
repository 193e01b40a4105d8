"""Solutions of targets of six revolute joints of any geometry, by elimination.

Arm: row i < 6 of a table (9, 9) holds h_{i+1} and P_i, row 6 P_6 from its fourth number on, row 7
R_nt, and row 8 the unit of length, whether the arm is read from its tip, and the joint at which the
loop is begun. Importing this module imports Numba.
"""

import math
from typing import NamedTuple

import numpy as np

from ....algebra import rotate, scale, subtract, transform
from ....formulas.ik.elimination import circle_roots, joints, line_equations, resultant
from ...jit.kernel import kernel
from .elimination_loop import (
    BEGIN,
    REVERSED,
    across_of,
    directions,
    loop,
    motion,
    nine,
    point,
    steps,
)

MOST = 16
"""Solutions of six revolute joints, and rows of a target."""

DEGENERATE = -1
"""Number of solutions where the determinant is 0 at all angles, to rounding."""

_NOISE = 1e-6  # of the largest coefficient: of more, nothing is known
# two coefficients tell the noise of the others by chance only, and it is not below rounding
_SPREAD = 16.0
_ROUNDING = 1e-14
_SHARPENED = 4
_INVERSE = 2
_FLAT = 1e-6  # of the largest slope
_SAME = 1e-7  # rad
_STRETCH = 0.2
_QUARTER = 0.25 * math.pi + 1e-3
_DONE = 1e-13
_TABLE = np.array(circle_roots.TABLE)


def _squares(C, S):
    return (
        C * C,
        C * S,
        S * S,
    )


def _slopes(C, S):
    """Derivatives of the squares, with respect to the whole angle."""
    product = C * S
    return (
        -product,
        0.5 * (C * C - S * S),
        product,
    )


def polynomial(sigma, view, scratch):
    """Writes the Fourier coefficients of the determinant into f; returns the largest and the noise.

    A view (x_0, k) is the angle x' of tan((x - x_0) / 2) = k tan(x' / 2): of k < 1 the arc around
    x_0 is seen larger, and the determinant elsewhere, which is many orders larger at times, smaller.
    """
    centre, stretch = view
    M = scratch.M
    f = scratch.f
    values = scratch.values
    c = math.cos(0.5 * centre)
    s = math.sin(0.5 * centre)
    for k in range(circle_roots.SAMPLES):
        x, y = circle_roots.half_of_sample(_TABLE, k)
        y *= stretch
        squared = x * x + y * y
        C = c * x - s * y
        S = s * x + c * y
        weights = scale(1.0 / squared, _squares(C, S))
        resultant.matrix(sigma, weights, M)
        det = resultant.factor(M, scratch.order)
        values[k] = det * squared**circle_roots.DEGREE
    noise = circle_roots.fourier(_TABLE, values, f)
    size = 0.0
    for k in range(2 * circle_roots.DEGREE + 1):
        size = max(size, abs(f[k]))
    return size, noise


def sharpen(x, sigma, scratch):
    """The angle near x at which M is singular, and its margin |w^T M' v| / |M|; v is left in the
    scratch: the vector that M takes to 0.
    """
    M = scratch.M
    v = scratch.v
    w = scratch.w
    margin = 0.0
    for _ in range(_SHARPENED):
        half = 0.5 * x
        C = math.cos(half)
        S = math.sin(half)
        squares = _squares(C, S)
        resultant.matrix(sigma, squares, M)
        _inverse_iteration(scratch)
        resultant.matrix(sigma, squares, M)
        value = _bilinear(w, M, v)
        resultant.matrix(sigma, _slopes(C, S), M)
        slope = _bilinear(w, M, v)
        size = 0.0
        for i in range(9 * resultant.SIZE):
            size = max(size, abs(M[i]))
        error = abs(value)
        steepness = abs(slope)
        margin = steepness / size
        if not error < 0.1 * steepness:
            break
        x -= value / slope
        if error <= _DONE * steepness:
            break
    return x, margin


def _inverse_iteration(scratch):
    """Writes the vectors v and w of M's smallest singular value; M is lost."""
    M = scratch.M
    order = scratch.order
    v = scratch.v
    w = scratch.w
    resultant.factor(M, order)
    for i in range(resultant.SIZE):
        number = 1.0 + 0.1 * i
        v[i] = number
        w[i] = number
    for _ in range(_INVERSE):
        resultant.solve(M, order, v)
        resultant.solve_transposed(M, order, w)


def _bilinear(w, M, v):
    total = 0.0
    for i in range(resultant.SIZE):
        part = 0.0
        row = resultant.SIZE * i
        for k in range(resultant.SIZE):
            part += M[row + k] * v[k]
        total += w[i] * part
    return total


class EliminationScratch(NamedTuple):
    """Arrays that every pass uses anew."""

    numbers: np.ndarray
    values: np.ndarray
    f: np.ndarray
    M: np.ndarray
    order: np.ndarray
    v: np.ndarray
    w: np.ndarray
    found: np.ndarray


class JointLoop(NamedTuple):
    """Axes of the loop, the steps between their points, the place of the last axis's line and its
    direction, the rotation of all, and a vector across the last axis.
    """

    h: tuple
    P: tuple
    W: tuple
    d: tuple
    R: tuple
    across: tuple


def _scratch():
    size = resultant.SIZE
    numbers = max(circle_roots.SCRATCH, 15 * line_equations.EQUATIONS)
    return EliminationScratch(
        np.empty(numbers),
        np.empty(circle_roots.SAMPLES),
        np.empty(2 * circle_roots.DEGREE + 1),
        np.empty(size * size),
        np.empty(size, np.int64),
        np.empty(size),
        np.empty(size),
        np.empty(2 * circle_roots.ROOM),
    )


def fill(arm, target, rows):
    """Writes six angles and a margin into as many rows as there are solutions, -1 as the margin of
    the others; returns the number, or DEGENERATE, and whether the determinant is flat at a root.
    """
    axes = np.empty((6, 6))
    whole = motion(arm, target)
    G = loop(arm, whole, axes)
    h = directions(axes)
    last = h[5]
    moved = transform(G, point(axes, 5))
    W = subtract(moved, point(axes, 0))
    R = nine(G)
    one = JointLoop(
        h,
        steps(axes),
        W,
        rotate(R, last),
        R,
        across_of(last),
    )
    scratch = _scratch()
    sigma = np.empty(27 * line_equations.KEPT)
    line_equations.eliminate(h, one.P, W, one.d, scratch.numbers, sigma)
    count = 0
    unsure = False
    for k in range(5):
        # where many orders lie between the determinant's values, each quarter is looked at by itself
        view = (0.0, 1.0)
        if k > 0:
            view = (0.5 * math.pi * k, _STRETCH)
        count, flat = _pass(arm, one, sigma, view, scratch, rows, count)
        if k > 0:
            unsure = unsure or flat
        elif not flat:
            break
    for k in range(max(count, 0), rows.shape[0]):
        rows[k][6] = -1.0
    return count, unsure


def _pass(arm, one, sigma, view, scratch, rows, count):
    """Adds the solutions that are seen in a view, and says whether some root is flat in it."""
    size, noise = polynomial(sigma, view, scratch)
    if not noise < _NOISE * size:
        return DEGENERATE, False
    found = scratch.found
    zero = max(_SPREAD * noise, _ROUNDING * size)
    number = circle_roots.collect(_TABLE, scratch.f, zero, scratch.numbers, found)
    centre, stretch = view
    is_whole = stretch == 1.0
    if is_whole:
        for k in range(number):
            if found[2 * k + 1] < _FLAT:
                return 0, True
    flat = False
    for k in range(number):
        half = 0.5 * found[2 * k]
        tangent = math.sin(half) / math.cos(half)
        off = 2.0 * math.atan(stretch * tangent)
        if is_whole or abs(off) <= _QUARTER:
            steepness = found[2 * k + 1]
            flat = flat or steepness < _FLAT
            x, margin = sharpen(centre + off, sigma, scratch)
            angles = _angles(one, x, scratch.v)
            if 0 <= count < rows.shape[0]:
                _set(arm, rows[count], angles, margin)
                if _is_new(rows, count):
                    count += 1
    return count, flat


def _angles(one, x, v):
    """(c, s) of all joints, of the third one's angle and a vector of products."""
    c4, s4, c5, s5 = joints.outer(v)
    points = (
        math.cos(x),
        math.sin(x),
        c4,
        s4,
        c5,
        s5,
    )
    angles, _ = joints.every(
        one.h,
        one.P,
        one.W,
        one.d,
        one.R,
        one.across,
        points,
    )
    return angles


def _is_new(rows, count):
    """Whether the last row differs from all before."""
    new = rows[count]
    for k in range(count):
        row = rows[k]
        most = 0.0
        for i in range(6):
            off = abs(row[i] - new[i])
            off = min(off, 2.0 * math.pi - off)
            most = max(most, off)
        if most < _SAME:
            return False
    return True


def _set(arm, row, x, margin):
    """Angles of the loop's joints, at their places in the arm, and the margin, into a row."""
    how = arm[8]
    begin = int(how[BEGIN])
    for k in range(6):
        i = (k + begin) % 6
        if how[REVERSED] != 0.0:
            i = 5 - i
        c = x[2 * k]
        s = x[2 * k + 1]
        row[i] = math.atan2(s, c)
    row[6] = margin


@kernel("w2 w3 w3 w2")
def eliminated(arm, targets, rows, counts):
    """All solutions of each target; their number, and 1 where the determinant is flat at a root."""
    for k in range(targets.shape[0]):
        count, flat = fill(arm, targets[k], rows[k])
        counts[k, 0] = count
        counts[k, 1] = 1.0 if flat else 0.0
