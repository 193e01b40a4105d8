"""Six revolute joints of which the second to the fourth are parallel (Universal Robots' arms).

    R = E_6 R_nt,  p = P_0 + E_1 P_1 + ... + E_6 P_6,  E_i = e^{[h_1] x_1} ... e^{[h_i] x_i}

Three parallel joints leave the direction h_2 and the height along it as they are. Of
R' = e^{-[h_1] x_1} R and the place p' of the sixth axis after it

    h_2 . R' h_6 = h_2 . e^{[h_5] x_5} h_6
    h_2 . p' = h_2 . (P_1 + P_2 + P_3 + P_4 + e^{[h_5] x_5} P_5)

which are two circles of x_1 and x_5 (`two_circles`). Then x_6 and the sum x_2 + x_3 + x_4 follow, and
the triangle of the parallel axes. Accuracy: that of `two_circles`
(tests/formulas/ik/test_three_parallel.py). Source: Elias and Wen 2025, Section IV.
"""

from ...algebra import add, dot, rotate, subtract, unrotate
from .. import elementary
from . import circle_line, two_circles
from .rotation_onto import rotated, rotation_onto
from .rounding import least, told
from .turned_component import turned_component


def outer(h, P, R, p):
    """Four roots (c, s of x_1, of x_5, margin), R = E_6 and p the place of the sixth axis less P_0; the
    margins are those of `two_circles.roots`.
    """
    between = add(add(P[1], P[2]), add(P[3], P[4]))
    height = dot(h[1], between)
    last = rotate(R, h[5])
    directions = _along_second(h, last, h[5], 0.0 * height)
    heights = _along_second(h, p, P[5], height)
    terms = dot(p, p) + dot(between, between) + dot(P[5], P[5])
    directions = told(directions, 1.0 + 0.0 * height)
    heights = told(heights, elementary.sqrt(terms))
    return two_circles.roots(directions, heights)


def _along_second(h, a, b, d):
    """Coefficients of h_2 . e^{-[h_1] x_1} a = h_2 . e^{[h_5] x_5} b + d."""
    A, B, C = turned_component(h[1], h[0], a)
    D, E, F = turned_component(h[1], h[4], b)
    return A, -B, -D, -E, d + F - C


def inner(h, P, n, across, R, p, root):
    """The (c, s) of x_6 at a root of `outer`, and the task of joints 2 to 4: the vector that they turn
    `across`, one across n, to, the (c, s) of this turn about n, and the place r to reach.
    """
    c1, s1, c5, s5, _ = root
    before = rotated(h[0], c1, s1, n)
    after = rotated(h[4], c5, -s5, n)
    c6, s6, _ = rotation_onto(h[5], unrotate(R, before), after)
    turned = rotated(h[4], c5, -s5, across)
    turned = rotated(h[5], c6, -s6, turned)
    turned = rotated(h[0], c1, -s1, rotate(R, turned))
    c, s, _ = rotation_onto(n, across, turned)
    ahead = add(P[4], rotated(h[4], c5, s5, P[5]))
    ahead = rotated(n, c, s, ahead)
    place = rotated(h[0], c1, -s1, p)
    r = subtract(subtract(place, P[1]), ahead)
    return (c6, s6), turned, (c, s), r


def with_outer(h, P, across, R, p, root):
    """Two rows (c, s of x_1, ..., of x_6, margin) of one root of `outer`; `across` is a vector across
    h_2.

    Of a margin of 0 the rows meet, with the other of `outer` or with each other, to rounding; below
    0 the pose is out of reach, and the elbow stretched or folded towards it.
    """
    last, turned, _, r = inner(h, P, h[1], across, R, p, root)
    # |r|^2 = |P_2 + e^{[h_3] x_3} P_3|^2
    A, B, C = turned_component(P[2], h[2], P[3])
    squares = dot(r, r) - dot(P[2], P[2]) - dot(P[3], P[3])
    rest = 0.5 * squares - C
    c3, s3, cosine, sine, here = circle_line.roots(A, B, rest)
    outside = root[:4] + last + (least(root[4], here),)
    return (
        _with_elbow(h, P, across, turned, r, (c3, s3), outside),
        _with_elbow(h, P, across, turned, r, (cosine, sine), outside),
    )


def _with_elbow(h, P, across, turned, r, elbow, outside):
    """The row of one x_3: x_2 turns the triangle's side to r, and x_4 is what is left of the sum."""
    c3, s3 = elbow
    c1, s1, c5, s5, c6, s6, margin = outside
    side = add(P[2], rotated(h[2], c3, s3, P[3]))
    c2, s2, _ = rotation_onto(h[1], side, r)
    rest = rotated(h[1], c2, -s2, turned)
    rest = rotated(h[2], c3, -s3, rest)
    c4, s4, _ = rotation_onto(h[3], across, rest)
    return c1, s1, c2, s2, c3, s3, c4, s4, c5, s5, c6, s6, margin
