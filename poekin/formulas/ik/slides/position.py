"""Three joints, some of them prismatic, that bring a point to a place (the arm in front of a wrist).

    p = X_1 (P_1 + X_2 (P_2 + X_3 P_3)),   X_i y = e^{[h_i] x_i} y  or  y + h_i t_i

The second joint leaves two numbers of a place as they are: a revolute one the height along its axis
and the distance from a point of it, a prismatic one two components across it. So of
Y = X_1^{-1} p - P_1 and y = P_2 + X_3 P_3

    h_2 . Y = h_2 . y, |Y|^2 = |y|^2   or   u . Y = u . y, v . Y = v . y,   u, v across h_2

The first and the third joint move these on circles or lines: `two_circles`, `circle_and_line` or
`two_lines`. Accuracy: theirs (tests/formulas/ik/slides/test_position.py).
Source: Elias and Wen 2025, subproblems 4 to 6; Pieper 1968.
"""

from ....algebra import add, cross, dot, scale, subtract
from ... import elementary
from .. import two_circles
from ..rotation_onto import rotated, rotation_onto
from ..rounding import told
from ..turned_component import turned_component
from . import circle_and_line, two_lines


def roots(slides, h, P, p):
    """Four rows (x_1, y_1, x_2, y_2, x_3, y_3, margin), of axes h = (h_1, h_2, h_3) and steps P.

    `slides` says which joints are prismatic; of these (x, y) is (t, 0), of the others the sine and
    cosine. Rows that are none have the margin -infinity.
    """
    if slides[1]:
        u = across(h[1])
        first = _component(slides, h, P, p, u)
        second = _component(slides, h, P, p, cross(h[1], u))
    else:
        first = _component(slides, h, P, p, h[1])
        second = _distance(slides, h, P, p)
    if not (slides[0] or slides[2]):
        squares = dot(p, p) + dot(P[0], P[0]) + dot(P[1], P[1]) + dot(P[2], P[2])
        length = elementary.sqrt(squares)
        first = told(first, length)
        second = told(second, length if slides[1] else squares)
    a, b, c, d = _outer(slides, first, second)
    return (
        _with_second(slides, h, P, p, a),
        _with_second(slides, h, P, p, b),
        _with_second(slides, h, P, p, c),
        _with_second(slides, h, P, p, d),
    )


def across(h):
    """A unit vector across a unit vector."""
    x, y, z = h
    if abs(x) <= abs(y):  # v is of length 1/sqrt(2) or more either way
        v = (0.0 * x, z, -y)
    else:
        v = (-z, 0.0 * x, x)
    return scale(1.0 / elementary.sqrt(dot(v, v)), v)


def moved(slide, h, x, y, a):
    """X a of a joint."""
    if slide:
        return add(a, scale(x, h))
    return rotated(h, x, y, a)


def moved_back(slide, h, x, y, a):
    """X^{-1} a of a joint."""
    if slide:
        return subtract(a, scale(x, h))
    return rotated(h, x, -y, a)


def _outer(slides, first, second):
    """Four rows (x_1, y_1, x_3, y_3, margin) of the equations, by the kinds of joints 1 and 3."""
    if slides[0] and slides[2]:
        p, q = two_lines.roots(first, second)
        none = p[:4] + (p[1] - two_lines.NO_ROW,)
        return p, q, none, none
    if slides[2]:
        return circle_and_line.roots(first, second)
    if slides[0]:
        p, q, r, t = circle_and_line.roots(_exchanged(first), _exchanged(second))
        return (
            _exchanged(p),
            _exchanged(q),
            _exchanged(r),
            _exchanged(t),
        )
    return two_circles.roots(first, second)


def _exchanged(row):
    a, b, c, d, e = row
    return c, d, a, b, e


def _component(slides, h, P, p, w):
    """(a, a', b, b', d) of w . X_1^{-1} p - w . X_3 P_3 = w . (P_1 + P_2)."""
    d = dot(w, add(P[0], P[1]))
    none = 0.0 * d
    if slides[0]:
        a = -dot(w, h[0])
        a2 = none
        d = d - dot(w, p)
    else:
        a, a2, c = turned_component(w, h[0], p)
        a2 = -a2
        d = d - c
    if slides[2]:
        b = -dot(w, h[2])
        b2 = none
        d = d + dot(w, P[2])
    else:
        b, b2, c = turned_component(w, h[2], P[2])
        b = -b
        b2 = -b2
        d = d + c
    return a, a2, b, b2, d


def _distance(slides, h, P, p):
    """(a, a', b, b', d) of |X_1^{-1} p - P_1|^2 / 2 - |P_2 + X_3 P_3|^2 / 2 = 0."""
    half = 0.5 + 0.0 * p[0]
    if slides[0]:
        rest = subtract(p, P[0])
        a = -dot(h[0], rest)
        a2 = half
        d = -0.5 * dot(rest, rest)
    else:
        a, a2, c = turned_component(P[0], h[0], p)
        a = -a
        d = c - 0.5 * (dot(p, p) + dot(P[0], P[0]))
    if slides[2]:
        rest = add(P[1], P[2])
        b = -dot(h[2], rest)
        b2 = -half
        d = d + 0.5 * dot(rest, rest)
    else:
        b, b2, c = turned_component(P[1], h[2], P[2])
        b = -b
        b2 = -b2
        d = d + c + 0.5 * (dot(P[1], P[1]) + dot(P[2], P[2]))
    return a, a2, b, b2, d


def _with_second(slides, h, P, p, root):
    """The row of a root, X_2 moving y to Y."""
    x1, y1, x3, y3, margin = root
    seen = moved_back(slides[0], h[0], x1, y1, p)
    brought = moved(slides[2], h[2], x3, y3, P[2])
    Y = subtract(seen, P[0])
    y = add(P[1], brought)
    if slides[1]:
        x2 = dot(h[1], subtract(Y, y))
        y2 = 0.0 * x2
    else:
        x2, y2, _ = rotation_onto(h[1], y, Y)
    return x1, y1, x2, y2, x3, y3, margin
