"""The other five angles, of one angle and the products of two.

Of the vector v of products C_4^(3-a) S_4^a C_5^(2-b) S_5^b its largest column tells x_4, its largest
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
from ..position import turned_component
from ..rotation_onto import rotated, rotation_onto


def unit(c, s):
    """A point brought to the circle."""
    length = elementary.sqrt(c * c + s * s)
    if length > 0.0:
        return c / length, s / length
    return 1.0 + length, length


def doubled(C, S):
    """The point of twice the angle of a direction (C, S)."""
    c = C * C - S * S
    s = 2.0 * C * S
    return unit(c, s)


def outer(v):
    """(c, s) of x_4 and of x_5 of a vector of products."""
    row = 0
    column = 0
    most = 0.0
    for i in range(12):
        size = abs(v[i])
        if size > most:
            most = size
            row = i // 3
            column = i % 3
    upper = column + 3
    lower = column + 6
    last = column + 9
    if abs(v[column]) >= abs(v[last]):
        c4, s4 = doubled(v[column], v[upper])
    else:
        c4, s4 = doubled(v[lower], v[last])
    left = 3 * row
    middle = left + 1
    right = left + 2
    if abs(v[left]) >= abs(v[right]):
        c5, s5 = doubled(v[left], v[middle])
    else:
        c5, s5 = doubled(v[middle], v[right])
    return (
        c4,
        s4,
        c5,
        s5,
    )


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
    told = size
    if size > 0.0:
        told = det / (size * size)
    return (
        c,
        s,
        told,
    )


def _row(w, k, a, value):
    A, B, C = turned_component(w, k, a)
    return A, B, value - C


def every(h, P, W, d0, G, across, points):
    """(c, s) of x_1 ... x_6, and how well x_2 is told; points are those of x_3, x_4 and x_5, G the
    rotation that all make, and `across` a vector across the sixth axis.
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
    c1, s1 = first(h[0], add(P[0], place), W, way, d0)
    rest = rotate(G, across)
    rest = rotated(h[0], c1, -s1, rest)
    rest = rotated(h[1], c2, -s2, rest)
    rest = rotated(h[2], c3, -s3, rest)
    rest = rotated(h[3], c4, -s4, rest)
    rest = rotated(h[4], c5, -s5, rest)
    c6, s6, _ = rotation_onto(h[5], across, rest)
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
    return angles, told


def first(h, p, W, d, d0):
    """(c, s) of the turn about h that brings p to W and d to d0 best, by least squares."""
    side = cross(h, p)
    d_side = cross(h, d)
    x = dot(side, cross(h, W)) + dot(d_side, cross(h, d0))
    y = dot(side, W) + dot(d_side, d0)
    return unit(x, y)
