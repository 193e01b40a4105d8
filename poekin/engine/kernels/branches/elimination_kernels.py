"""Solutions of targets of six revolute joints of any geometry, by elimination.

Arm: row i < 6 of a table (9, 9) holds h_{i+1} and P_i, row 6 P_6 from its fourth number on, row 7
R_nt, and row 8 the unit of length, whether the arm is read from its tip, the joint at which the loop
is begun, and whether each quarter of the circle is looked at by itself where the determinant is flat
at a root: many orders lie between its values then. Importing this module imports Numba.
"""

import math
from typing import NamedTuple

from ....algebra import rotate, subtract, transform
from ....formulas import elementary
from ....formulas.ik.elimination import circle_roots, joints, line_equations, resultant
from ....formulas.ik.slides.position import across
from ...jit.array_io import without_refcount
from ...jit.kernel import kernel
from ...lanes import rows as lanes
from ...straight_line.arctangent import atan2
from .elimination_loop import (
    BEGIN,
    QUARTERS,
    REVERSED,
    directions,
    is_far_side_fixed,
    loop,
    motion,
    nine,
    point,
    steps,
)
from .elimination_roots import (
    GAP,
    determinant,
    make_scratch,
    polynomial,
    roots,
)

MOST = 16
"""Solutions of six revolute joints, and rows of a target."""

DEGENERATE = -1
"""Number of solutions where the determinant is 0 at all angles, to rounding."""

_NOISE = 1e-6  # of the largest coefficient: of more, nothing is known
# two coefficients tell the noise of the others by chance only: at double roots of a calibrated arm it was
# up to 83 times theirs; nor is it below rounding
_SPREAD = 128.0
_ROUNDING = 2e-11
_SHARPENED = 4
_FLAT = 1e-6  # of the largest slope
_CLOSE = 1e-7  # rad, and of the arm's size: a line that ends farther off is no solution's
_NEAR = 1e-2  # of the same: a line that ends nearer may be an inexact double root's
_SAME = 1e-7  # rad
_STRETCH = 0.2
_TANGENT = math.tan(0.125 * math.pi + 5e-4)  # of half of a view's quarter, and of some more
_FAR = 0.05  # rad, half: a step that long leads elsewhere
_WHOLE = (1.0, 0.0, 1.0)
_ROOM = circle_roots.ROOM


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


def _loop(arm, target, axes):
    whole = motion(arm, target)
    G = loop(arm, whole, axes)
    h = directions(axes)
    last = h[5]
    moved = transform(G, point(axes, 5))
    R = nine(G)
    return JointLoop(
        h,
        steps(axes),
        subtract(moved, point(axes, 0)),
        rotate(R, last),
        R,
        across(last),
    )


def fill(arm, target, rows, scratch, is_first):
    """Writes six angles and a margin into as many rows as there are solutions, -1 as the margin of
    the others; returns the number, or DEGENERATE, and whether there may be others.
    """
    one = _loop(arm, target, scratch.axes)
    if is_first or not is_far_side_fixed(arm):
        line_equations.far_side(one.h, one.P, scratch.far_side, scratch.near_side)
    line_equations.near_side(one.h[0], one.P[0], one.W, one.d, scratch.near_side)
    line_equations.combine(
        scratch.near_side,
        lanes.rows(scratch.far_side),
        line_equations.ROOM // lanes.at_once(),
        lanes.rows(scratch.sigma),
    )
    count = 0
    unsure = False
    for k in range(5):
        view = _WHOLE
        if k > 0:
            half = 0.25 * math.pi * k
            view = (math.cos(half), math.sin(half), _STRETCH)
        count, doubtful, is_flat = _pass(arm, one, view, scratch, rows, count)
        unsure = unsure or doubtful or is_flat
        if k == 0:
            if not is_flat or arm[8, QUARTERS] == 0.0:
                break
            count = 0
            unsure = False
    for k in range(max(count, 0), rows.shape[0]):
        rows[k, 6] = -1.0
    return count, unsure or count % 2 != 0


def _pass(arm, one, view, scratch, rows, count):
    """Adds the solutions that are seen in a view; says whether there may be others, and whether some
    root is flat in it.
    """
    size, noise = polynomial(scratch, view)
    if count < 0 or not noise < _NOISE * size:
        return DEGENERATE, True, False
    steepest = circle_roots.steepest(scratch.f)
    is_whole = view[2] == 1.0
    zero = max(_SPREAD * noise, _ROUNDING * size)
    number = roots(scratch, zero, steepest, is_whole)
    kept, is_flat = _within(scratch.found, number, view[2], _FLAT * steepest)
    unsure = number == _ROOM
    for first in range(0, kept, lanes.at_once()):
        some = min(kept - first, lanes.at_once())
        _sharpen(one, view, scratch, first, some)
        for k in range(some):
            gap = _value(scratch.solved, GAP, k)
            is_close = gap <= _CLOSE
            unsure = unsure or not is_close or count >= rows.shape[0]
            # an inexact double root is to be tried, a root of no solution is not
            if gap <= _NEAR and count < rows.shape[0]:
                _set(arm, rows[count], scratch.angles, k)
                slope = abs(scratch.found[2 * _ROOM + first + k]) / steepest
                rows[count, 6] = slope if is_close else 0.0
                if _is_new(rows, count):
                    count += 1
                elif is_whole:
                    unsure = True
    return count, unsure, is_flat


def _within(found, number, stretch, flat):
    """Number of roots within the quarter that a view is of, which are the first then, and whether
    some slope is flat.
    """
    kept = 0
    is_flat = False
    for k in range(number):
        C = found[k]
        S = found[_ROOM + k]
        if stretch == 1.0 or stretch * abs(S) <= _TANGENT * abs(C):
            slope = found[2 * _ROOM + k]
            is_flat = is_flat or abs(slope) < flat
            found[kept] = C
            found[_ROOM + kept] = S
            found[2 * _ROOM + kept] = slope
            kept += 1
    return kept, is_flat


def _value(rows, i, k):
    """The k-th of the numbers that are the i-th of some rows."""
    return rows[lanes.at_once() * i + k]


def _sharpen(one, view, scratch, first, some):
    """Joints of the loop at roots, brought nearer by Newton's rule until their lines are where they
    should be: its determinant is exact, where the polynomial has the noise of all.
    """
    found = scratch.found
    many = lanes.at_once()
    for k in range(first + some, first + many):
        for i in range(3):
            found[_ROOM * i + k] = found[_ROOM * i + first]
    width = _ROOM // many
    roots = lanes.rows(found)
    group = first // many
    v = lanes.rows(scratch.v)
    solved = lanes.rows(scratch.solved)
    for _ in range(_SHARPENED):
        C = roots[group]
        S = roots[width + group]
        size = C * C + S * S
        value = determinant(scratch, view, C, S)
        eighth = size * size * size * size
        resultant.null_vector(lanes.rows(scratch.A), lanes.rows(scratch.M), v)
        step = value / (2.0 * eighth * eighth * roots[2 * width + group])
        step = elementary.where_less(abs(step), _FAR, step, 0.0)
        x = C + step * S
        y = S - step * C
        roots[group] = x
        roots[width + group] = y
        _joints(one, view, x, y, v, solved)
        is_close = True
        for k in range(some):
            is_close = is_close and _value(scratch.solved, GAP, k) <= _CLOSE
        if is_close:
            break
    angles = lanes.rows(scratch.angles)
    for joint in range(6):
        angles[joint] = atan2(solved[2 * joint + 1], solved[2 * joint])


def _joints(one, view, x, y, v, solved):
    """Writes (c, s) of all joints, of half of the third one's angle in a view and a vector of
    products, and how far the last line is from its place.
    """
    c, s, stretch = view
    y = stretch * y
    c3, s3 = joints.doubled(c * x - s * y, s * x + c * y)
    c4, s4, c5, s5 = joints.outer(v)
    points = (
        c3,
        s3,
        c4,
        s4,
        c5,
        s5,
    )
    angles, _, gap = joints.every(
        one.h,
        one.P,
        one.W,
        one.d,
        one.R,
        one.across,
        points,
    )
    for k in range(GAP):
        solved[k] = angles[k]
    solved[GAP] = gap


def _is_new(rows, count):
    """Whether the last row differs from all before."""
    new = rows[count]
    for k in range(count):
        row = rows[k]
        is_same = True
        for i in range(6):
            off = abs(row[i] - new[i])
            is_same = is_same and min(off, 2.0 * math.pi - off) < _SAME
        if is_same:
            return False
    return True


def _set(arm, row, angles, k):
    """The k-th solution's angles of the loop's joints, at their places in the arm, into a row."""
    how = arm[8]
    begin = int(how[BEGIN])
    for joint in range(6):
        i = (joint + begin) % 6
        if how[REVERSED] != 0.0:
            i = 5 - i
        row[i] = _value(angles, joint, k)


@kernel("w2 w3 w3 w2")
def eliminated(arm, targets, rows, counts):
    """All solutions of each target; their number, and 1 where there may be others."""
    eliminate(arm, targets, rows, counts, make_scratch())


def eliminate(arm, targets, rows, counts, scratch):
    """`eliminated` with the arrays of a call."""
    arm = without_refcount(arm)
    targets = without_refcount(targets)
    rows = without_refcount(rows)
    scratch = without_refcount(scratch)
    for k in range(targets.shape[0]):
        count, unsure = fill(arm, targets[k], rows[k], scratch, k == 0)
        counts[k, 0] = count
        counts[k, 1] = 1.0 if unsure else 0.0
