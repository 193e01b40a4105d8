"""Two lengths of two equations:

    a t + b w = d,   A t + K t^2 + B w + L w^2 = D

What two prismatic joints leave to the joint between them: of a revolute one the height along its
axis and the distance from a point of it (K = 1/2, L = -1/2), of a prismatic one two components
across it (K = L = 0). Accuracy: of the former that of `quadratic`, of the latter 4 u over the
determinant (tests/formulas/ik/slides/test_two_lines.py). Source: Cramer's rule, and the line of the
first equation set into the second.
"""

from . import quadratic

NO_ROW = 1e400  # infinite: less it is the margin of a row that is none


def roots(first, second):
    """Two rows (t, 0, w, 0, margin) of the equations (a, 0, b, 0, d) and (A, K, B, L, D); of K = L =
    0 there is one only, and the other has the margin -infinity.
    """
    a, none, b, _, d = first
    A, K, B, L, D = second
    if K == 0.0 and L == 0.0:
        return _of_lines(a, b, d, A, B, D)
    square = a * a + b * b
    if square == 0.0:
        return (none, none, none, none, none - 1.0), (none, none, none, none, none - 1.0)
    t = d * a / square
    w = d * b / square
    # (t + b x, w - a x)
    k = K * b * b + L * a * a
    h = (0.5 * A + K * t) * b - (0.5 * B + L * w) * a
    e = (A + K * t) * t + (B + L * w) * w - D
    if k == 0.0:
        return _of_one(t, w, a, b, h, e)
    x, y, margin = quadratic.roots(k, h, e)
    return (
        (t + b * x, none, w - a * x, none, margin),
        (t + b * y, none, w - a * y, none, margin),
    )


def _of_lines(a, b, d, A, B, D):
    det = a * B - b * A
    none = 0.0 * det
    if det == 0.0:
        return (none, none, none, none, none - 1.0), (none, none, none, none, none - 1.0)
    row = ((d * B - b * D) / det, none, (a * D - d * A) / det, none, 1.0 + none)
    return row, row[:4] + (none - NO_ROW,)


def _of_one(t, w, a, b, h, e):
    """The root where the squares go out along the line: both slides are as far from the axis."""
    none = 0.0 * h
    if h == 0.0:
        return (t, none, w, none, none - 1.0), (t, none, w, none, none - 1.0)
    x = -0.5 * e / h
    row = (t + b * x, none, w - a * x, none, 1.0 + none)
    return row, row[:4] + (none - NO_ROW,)
