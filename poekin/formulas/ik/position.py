"""Three revolute joints that bring a point to a place (the arm in front of a wrist).

    p = e^{[h_1] x_1} (P_1 + e^{[h_2] x_2} y),   y = P_2 + e^{[h_3] x_3} P_3

The second joint leaves two numbers as they are, the height of a point along its axis and the point's
distance from a place on it. So with Y = e^{-[h_1] x_1} p - P_1

    h_2 . Y = h_2 . y,   |Y|^2 = |y|^2

whose left sides are linear in the sine and cosine of x_1, and right sides in those of x_3: two
circles (`two_circles`), which x_2 turns onto each other. Accuracy: that of `two_circles`
(tests/formulas/ik/test_position.py). Source: Elias and Wen 2025, subproblem 5; Pieper 1968.
"""

from ...algebra import add, cross, dot, subtract
from .. import elementary
from . import two_circles
from .rotation_onto import rotated, rotation_onto
from .rounding import told


def turned_component(w, k, a):
    """(A, B, C) of w . e^{[k] theta} a = A cos(theta) + B sin(theta) + C."""
    along = dot(w, k) * dot(k, a)
    cosine = dot(w, a) - along
    sine = dot(w, cross(k, a))
    return cosine, sine, along


def roots(h, P, p):
    """Four rows (c, s of x_1, of x_2, of x_3, margin), of axes h = (h_1, h_2, h_3) and steps P.

    The margins are those of `two_circles.roots`: 0 of a double root or one of a continuum, as on the
    first axis, below 0 where p is out of reach; x_2 then brings y as near to Y as it can. Rounding of
    the coefficients, products of h, P and p, may set the margin of a stretched arm 64 u below 0.
    """
    height = dot(h[1], add(P[0], P[1]))
    heights = _equation(h, P, p, (h[1], h[1]), -1.0, height)
    squares = dot(p, p) + dot(P[0], P[0])
    squares = squares - dot(P[1], P[1])
    squares = squares - dot(P[2], P[2])
    distances = _equation(h, P, p, (P[0], P[1]), 1.0, 0.5 * squares)
    terms = dot(p, p) + dot(P[0], P[0]) + dot(P[1], P[1]) + dot(P[2], P[2])
    heights = told(heights, elementary.sqrt(terms))
    distances = told(distances, terms)
    first, second, third, fourth = two_circles.roots(heights, distances)
    return (
        _with_second(h, P, p, first),
        _with_second(h, P, p, second),
        _with_second(h, P, p, third),
        _with_second(h, P, p, fourth),
    )


def _equation(h, P, p, ways, sign, d):
    """Coefficients of w . e^{-[h_1] x_1} p +- z . e^{[h_3] x_3} P_3 = d, (w, z) = ways."""
    w, z = ways
    A, B, C = turned_component(w, h[0], p)
    D, E, F = turned_component(z, h[2], P[2])
    return A, -B, sign * D, sign * E, d - C - sign * F


def _with_second(h, P, p, root):
    """The row of a root, x_2 turning y to Y."""
    c1, s1, c3, s3, margin = root
    seen = rotated(h[0], c1, -s1, p)
    brought = rotated(h[2], c3, s3, P[2])
    Y = subtract(seen, P[0])
    y = add(P[1], brought)
    c2, s2, _ = rotation_onto(h[1], y, Y)
    return c1, s1, c2, s2, c3, s3, margin
