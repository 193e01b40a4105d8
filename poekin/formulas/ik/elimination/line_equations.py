"""Equations of a closed loop of six revolute joints in five angles: a line seen from both sides.

    e_3 e_4 e_5 L_6 = e_2^-1 e_1^-1 L,   L = G L_6,   e_1 ... e_6 = G

Of the line's point p and direction d

    p, d, p . p, p . d, p x d, (p . p) d - 2 (p . d) p

are bilinear in the points (c, s, 1) of x_1 and x_2 on one side, and trilinear in those of x_3, x_4
and x_5 on the other: fourteen equations. Six combinations of them hold none of the eight products
of x_1 and x_2. The origin is the second axis's point.
Accuracy: rounding (tests/formulas/ik/elimination/test_line_equations.py). Source: Raghavan and Roth
1993, Inverse Kinematics of the General 6R Manipulator and Related Linkages, ASME Journal of
Mechanical Design 115.
"""

from ....algebra import add, cross, dot, scale, subtract
from . import null_rows

EQUATIONS = 14
PRODUCTS = 8
KEPT = 6


def moments(p, d, out, at):
    """Writes the fourteen numbers of a line with a point p and a direction d from a place on."""
    pp = dot(p, p)
    pl = dot(p, d)
    m = cross(p, d)
    along_d = scale(pp, d)
    along_p = scale(2.0 * pl, p)
    turned = subtract(along_d, along_p)
    _put(out, at, p)
    _put(out, at + 3, d)
    out[at + 6] = pp
    out[at + 7] = pl
    _put(out, at + 8, m)
    _put(out, at + 11, turned)


def _put(out, at, a):
    out[at] = a[0]
    out[at + 1] = a[1]
    out[at + 2] = a[2]


def quarter_turns(h, a):
    """e^{[h] x} a at x = 0, pi/2 and pi."""
    along = scale(dot(h, a), h)
    quarter = add(along, cross(h, a))
    half = subtract(scale(2.0, along), a)
    return a, quarter, half


def eliminate(h, P, p, d, scratch, sigma):
    """Writes the six combinations into sigma: 27 numbers each, the coefficients of

        (C^2, C S, S^2)_3 x (C^2, C S, S^2)_4 x (C^2, C S, S^2)_5,   C = cos(x/2), S = sin(x/2).

    h are the six axes and P_i the steps from the i-th axis's point to the next; p is the place of
    L, less the point of the first axis, and d its direction. `scratch` has room for 210 numbers.
    """
    near_side(h, P, p, d, scratch)
    null_rows.fill(scratch)
    p5 = quarter_turns(h[4], P[4])
    d5 = quarter_turns(h[4], h[5])
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
                place = 9 * k + 3 * j + i
                moments(before, d3[k], scratch, 0)
                _combine(scratch, sigma, place)
    for step in (1, 3, 9):
        _to_half_angles(sigma, step)


def _to_half_angles(sigma, step):
    """Values at 0, pi/2 and pi become coefficients of C^2, C S and S^2."""
    for k in range(27 * KEPT):
        digit = (k // step) % 3
        if digit == 1:
            start = sigma[k - step]
            end = sigma[k + step]
            doubled = 2.0 * sigma[k]
            sigma[k] = doubled - start - end


def near_side(h, P, p, d, B):
    """Fourteen coefficients of each of the eight products of x_1 and x_2, then the constants."""
    back = scale(-1.0, h[0])
    further_back = scale(-1.0, h[1])
    p1 = quarter_turns(back, p)
    d1 = quarter_turns(back, d)
    for k in range(3):
        seen = subtract(p1[k], P[0])
        p2 = quarter_turns(further_back, seen)
        d2 = quarter_turns(further_back, d1[k])
        for j in range(3):
            product = 3 * k + j
            at = EQUATIONS * product
            moments(p2[j], d2[j], B, at)
    _to_points(B, EQUATIONS)
    _to_points(B, 3 * EQUATIONS)


def _to_points(B, step):
    """Values at 0, pi/2 and pi become coefficients of c, s and 1."""
    for i in range(9 * EQUATIONS):
        digit = (i // step) % 3
        if digit == 0:
            middle = i + step
            end = middle + step
            first = B[i]
            last = B[end]
            constant = 0.5 * (first + last)
            B[i] = 0.5 * (first - last)
            B[middle] -= constant
            B[end] = constant


def _combine(scratch, sigma, place):
    """Six combinations of the first fourteen numbers, less the constants, by the null rows."""
    constants = PRODUCTS * EQUATIONS
    row = constants + EQUATIONS
    for m in range(EQUATIONS):
        scratch[m] -= scratch[constants + m]
    for r in range(KEPT):
        total = 0.0
        for m in range(EQUATIONS):
            coefficient = scratch[row + m]
            total += coefficient * scratch[m]
        sigma[27 * r + place] = total
        row += EQUATIONS
