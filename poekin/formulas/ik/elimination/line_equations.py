"""Equations of a closed loop of six revolute joints in five angles: a line seen from both sides.

    e_3 e_4 e_5 L_6 = e_2^-1 e_1^-1 L,   L = G L_6,   e_1 ... e_6 = G

Of the line's point p and direction d

    p, d, p . p, p . d, m = p x d, t = (p . p) d - 2 (p . d) p

are bilinear in the points (c, s, 1) of x_1 and x_2 on one side, and trilinear in those of x_3, x_4
and x_5 on the other: fourteen equations. The second axis is the z axis, so that x_2 changes neither
the six numbers along it, which are linear in (c_1, s_1, 1), nor, but for a turn, the four across it,
(x, y)(x_1) e^{-i x_2}: four combinations of the first hold no c_1 and s_1, two of the others none of
the six products.
Accuracy: rounding (tests/formulas/ik/elimination/test_line_equations.py). Source: Raghavan and Roth
1993, Inverse Kinematics of the General 6R Manipulator and Related Linkages, ASME Journal of
Mechanical Design 115.
"""

from ....algebra import add, cross, dot, scale, subtract
from . import null_rows

EQUATIONS = 14
KEPT = 6
PLACES = 27
ROOM = 28
"""Places of a row, of which the last is 0: a number that four divide."""
FAR_SIDE = (EQUATIONS + 1) * ROOM
NEAR_SIDE = 148

_ALONG = 6
_ACROSS = 8
# of the scratch: columns, rows and constants of the numbers along, those across, three lines
_ALONG_ROWS = 2 * _ALONG
_CONSTANTS = _ALONG * _ALONG
_ACROSS_COLUMNS = _CONSTANTS + _ALONG
_ACROSS_ROWS = _ACROSS_COLUMNS + 6 * _ACROSS
_LINES = _ACROSS_ROWS + 2 * _ACROSS


def moments(p, d, out, at):
    """Writes the fourteen numbers of a line with a point p and a direction d from a place on: those
    along the z axis, then those across.
    """
    pp = dot(p, p)
    pl = dot(p, d)
    m = cross(p, d)
    along_d = scale(pp, d)
    along_p = scale(2.0 * pl, p)
    t = subtract(along_d, along_p)
    out[at] = p[2]
    out[at + 1] = d[2]
    out[at + 2] = pp
    out[at + 3] = pl
    out[at + 4] = m[2]
    out[at + 5] = t[2]
    _put(out, at + 6, p)
    _put(out, at + 8, d)
    _put(out, at + 10, m)
    _put(out, at + 12, t)


def _put(out, at, a):
    out[at] = a[0]
    out[at + 1] = a[1]


def quarter_turns(h, a):
    """e^{[h] x} a at x = 0, pi/2 and pi."""
    along = scale(dot(h, a), h)
    quarter = add(along, cross(h, a))
    half = subtract(scale(2.0, along), a)
    return a, quarter, half


def far_side(h, P, F, scratch):
    """Writes the coefficients of each of the fourteen numbers, and of 1, a row of `ROOM` each, in

        (C^2, C S, S^2)_3 x (C^2, C S, S^2)_4 x (C^2, C S, S^2)_5,   C = cos(x/2), S = sin(x/2).

    h are the six axes and P_i the steps from the i-th axis's point to the next.
    """
    p5 = quarter_turns(h[4], P[4])
    d5 = quarter_turns(h[4], h[5])
    for k in range(FAR_SIDE):
        F[k] = 0.0
    for i in range(3):
        before = add(P[3], p5[i])
        p4 = quarter_turns(h[3], before)
        d4 = quarter_turns(h[3], d5[i])
        for j in range(3):
            before = add(P[2], p4[j])
            p3 = quarter_turns(h[2], before)
            d3 = quarter_turns(h[2], d4[j])
            for k in range(3):
                before = add(P[1], p3[k])
                moments(before, d3[k], scratch, 0)
                place = 9 * k + 3 * j + i
                for m in range(EQUATIONS):
                    F[ROOM * m + place] = scratch[m]
                F[ROOM * EQUATIONS + place] = 1.0
    for step in (1, 3, 9):
        _to_half_angles(F, step)


def _to_half_angles(F, step):
    """Values at 0, pi/2 and pi become coefficients of C^2, C S and S^2."""
    for m in range(EQUATIONS + 1):
        for place in range(PLACES):
            digit = (place // step) % 3
            if digit == 1:
                k = ROOM * m + place
                start = F[k - step]
                end = F[k + step]
                doubled = 2.0 * F[k]
                F[k] = doubled - start - end


def near_side(h, P, p, d, B):
    """Writes four combinations of the numbers along and their constants, and two of the others.

    h is the first axis, P the step from its point to the second one's, p the place of L, less the
    point of the first axis, and d its direction. `B` has room for `NEAR_SIDE` numbers.
    """
    back = scale(-1.0, h)
    p1 = quarter_turns(back, p)
    d1 = quarter_turns(back, d)
    for k in range(3):
        seen = subtract(p1[k], P)
        moments(seen, d1[k], B, _LINES + EQUATIONS * k)
    for m in range(EQUATIONS):
        start = B[_LINES + m]
        quarter = B[_LINES + EQUATIONS + m]
        end = B[_LINES + 2 * EQUATIONS + m]
        constant = 0.5 * (start + end)
        _place(B, m, 0, 0.5 * (start - end))
        _place(B, m, 1, quarter - constant)
        _place(B, m, 2, constant)
    null_rows.fill(B, 0, _ALONG, 2)
    null_rows.fill(B, _ACROSS_COLUMNS, _ACROSS, 6)


def _place(B, m, k, value):
    """A number's coefficient of c_1, s_1 or 1 at its place, or at both, with c_2 and with s_2."""
    if m < _ALONG:
        at = _ALONG * k
        if k == 2:
            at = _CONSTANTS
        B[at + m] = value
        return
    # (x + i y)(c_2 - i s_2)
    at = _ACROSS_COLUMNS + 2 * _ACROSS * k
    i = m - _ALONG
    B[at + i] = value
    if i % 2 == 0:
        B[at + _ACROSS + i + 1] = -value
    else:
        B[at + _ACROSS + i - 1] = value


def combine(B, F, width, sigma):
    """Writes the six equations, `PLACES` coefficients each in rows of `width`, of the numbers that
    `near_side` and `far_side` have written.
    """
    for r in range(4):
        row = _ALONG_ROWS + _ALONG * r
        constant = 0.0
        for m in range(_ALONG):
            constant += B[row + m] * B[_CONSTANTS + m]
        for k in range(width):
            total = B[row] * F[k] - constant * F[width * EQUATIONS + k]
            for m in range(1, _ALONG):
                total += B[row + m] * F[width * m + k]
            sigma[width * r + k] = total
    for r in range(2):
        row = _ACROSS_ROWS + _ACROSS * r
        for k in range(width):
            total = B[row] * F[width * _ALONG + k]
            for m in range(1, _ACROSS):
                total += B[row + m] * F[width * (_ALONG + m) + k]
            sigma[width * (4 + r) + k] = total
