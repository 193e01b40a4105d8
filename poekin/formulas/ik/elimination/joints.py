"""The other five angles, of one angle and the products of two.

Of the vector v of products C_4^(3-a) S_4^a C_5^(2-b) S_5^b its longest column tells x_4, its longest
row x_5. Then the line L_6 is known as the second joint sees it, p and d, and four equations are
linear in the point of x_2, W and d_0 the line's place and direction seen from the first joint's point:

    h_1 . e_2 p = h_1 . (W - P_1),  h_1 . e_2 d = h_1 . d_0
    2 P_1 . e_2 p = |W|^2 - |P_1|^2 - |p|^2,  P_1 . e_2 d = W . d_0 - p . d

of which the least-squares answer is taken. x_1 turns the line to its place, x_6 is what is left.
Accuracy: that of the vector, some ten times (tests/formulas/ik/elimination/test_joints.py). Source:
Raghavan and Roth 1993.
"""

from ....algebra import add, cross, dot, rotate, subtract
from ... import elementary
from ..rotation_onto import rotated
from ..turned_component import turned_component


def unit(c, s):
    """A point brought to the circle."""
    length = elementary.sqrt(c * c + s * s)
    divisor = elementary.where_less(0.0, length, length, 1.0)
    c = elementary.where_less(0.0, length, c, 1.0)
    return c / divisor, s / divisor


def doubled(C, S):
    """The point of twice the angle of a direction (C, S)."""
    c = C * C - S * S
    s = 2.0 * C * S
    return unit(c, s)


def outer(v):
    """(c, s) of x_4 and of x_5 of a vector of products."""
    column = (v[0], v[3], v[6], v[9])
    for k in range(1, 3):
        column = _longer(column, (v[k], v[k + 3], v[k + 6], v[k + 9]))
    row = (v[0], v[1], v[1], v[2])
    for k in range(3, 12, 3):
        row = _longer(row, (v[k], v[k + 1], v[k + 1], v[k + 2]))
    c4, s4 = _ratio(column)
    c5, s5 = _ratio(row)
    return c4, s4, c5, s5


def _longer(a, b):
    p = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]
    q = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3]
    return (
        elementary.where_less(p, q, b[0], a[0]),
        elementary.where_less(p, q, b[1], a[1]),
        elementary.where_less(p, q, b[2], a[2]),
        elementary.where_less(p, q, b[3], a[3]),
    )


def _ratio(a):
    """The point of twice the angle of the first two numbers, or of the last two if these are larger."""
    C = elementary.where_less(abs(a[0]), abs(a[3]), a[2], a[0])
    S = elementary.where_less(abs(a[0]), abs(a[3]), a[3], a[1])
    return doubled(C, S)


def second(h, P, W, d0, p, d):
    """(c, s) of x_2, and how well it is told: the determinant of the four equations' normal ones
    over the square of their size, between 0 and 1.
    """
    to_line = subtract(W, P[0])
    lengths = dot(W, W) - dot(P[0], P[0]) - dot(p, p)
    mixed = dot(W, d0) - dot(p, d)
    axis = h[0]
    to_axis = P[0]
    rows = (
        _row(axis, h[1], p, dot(axis, to_line)),
        _row(axis, h[1], d, dot(axis, d0)),
        _row(to_axis, h[1], p, 0.5 * lengths),
        _row(to_axis, h[1], d, mixed),
    )
    aa = 0.0
    ab = 0.0
    bb = 0.0
    ad = 0.0
    bd = 0.0
    for i in range(4):
        a, b, value = rows[i]
        aa += a * a
        ab += a * b
        bb += b * b
        ad += a * value
        bd += b * value
    x = bb * ad - ab * bd
    y = aa * bd - ab * ad
    c, s = unit(x, y)
    det = aa * bb - ab * ab
    size = 0.5 * (aa + bb)
    told = det / elementary.where_less(0.0, size, size * size, 1.0)
    return (
        c,
        s,
        told,
    )


def _row(w, k, a, value):
    A, B, C = turned_component(w, k, a)
    return A, B, value - C


def every(h, P, W, d0, G, across, points):
    """(c, s) of x_1 ... x_6, how well x_2 is told, and how far the last line is from where it should
    be, point and direction; points are those of x_3, x_4 and x_5, G the rotation that all make, and
    `across` a vector across the sixth axis.
    """
    c3, s3, c4, s4, c5, s5 = points
    d = rotated(h[4], c5, s5, h[5])
    d = rotated(h[3], c4, s4, d)
    d = rotated(h[2], c3, s3, d)
    p = rotated(h[4], c5, s5, P[4])
    p = rotated(h[3], c4, s4, add(P[3], p))
    p = rotated(h[2], c3, s3, add(P[2], p))
    p = add(P[1], p)
    c2, s2, told = second(h, P, W, d0, p, d)
    place = rotated(h[1], c2, s2, p)
    way = rotated(h[1], c2, s2, d)
    place = add(P[0], place)
    c1, s1 = first(h[0], place, W, way, d0)
    off = subtract(rotated(h[0], c1, s1, place), W)
    turned = subtract(rotated(h[0], c1, s1, way), d0)
    gap = elementary.sqrt(dot(off, off) + dot(turned, turned))
    rest = rotate(G, across)
    rest = rotated(h[0], c1, -s1, rest)
    rest = rotated(h[1], c2, -s2, rest)
    rest = rotated(h[2], c3, -s3, rest)
    rest = rotated(h[3], c4, -s4, rest)
    rest = rotated(h[4], c5, -s5, rest)
    side = cross(h[5], across)
    c6, s6 = unit(dot(side, cross(h[5], rest)), dot(side, rest))
    angles = (
        c1,
        s1,
        c2,
        s2,
        c3,
        s3,
        c4,
        s4,
        c5,
        s5,
        c6,
        s6,
    )
    return angles, told, gap


def first(h, p, W, d, d0):
    """(c, s) of the turn about h that brings p to W and d to d0 best, by least squares."""
    side = cross(h, p)
    d_side = cross(h, d)
    x = dot(side, cross(h, W)) + dot(d_side, cross(h, d0))
    y = dot(side, W) + dot(d_side, d0)
    return unit(x, y)
