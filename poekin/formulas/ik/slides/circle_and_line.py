"""An angle and a length of two equations that are linear in the angle's sine and cosine:

    a c + a' s + b t = d,   A c + A' s + B t + K t^2 = D,   (c, s) on the unit circle

What a revolute and a prismatic joint leave to the joint between them is this: of a revolute one the
height along its axis and the distance from a point of it (K = -+ 1/2), of a prismatic one two
components across it (K = 0). The first equation gives t and leaves a conic of the circle
(`circle_conic`), or where b is next to 0 an angle and then a quadratic in t, in turn; of K = 0 a line is left.
Newton's rule sharpens both unknowns together. Accuracy: rounding over the singular values of the
equations' slopes (tests/formulas/ik/slides/test_circle_and_line.py).
Source: Elias and Wen 2025, subproblems 4 and 5 with a line in place of a circle.
"""

from ... import elementary
from .. import circle_conic, circle_line
from . import quadratic
from .two_lines import NO_ROW

# of b, the cosine of the angle between the line and the middle joint's axis: below it the conic's
# points come in pairs that are too close to be told apart well
_ACROSS = 1e-3
_TURNS = 4  # each gains the factor b
_SHARPENED = 3  # steps


def roots(first, second):
    """Four rows (c, s, t, 0, margin) of the equations (a, a', b, 0, d) and (A, A', B, K, D).

    Rows that are none have the margin -infinity: the last two of K = 0.
    """
    if second[3] == 0.0:
        found = _of_line(first, second)
    elif abs(first[2]) > _ACROSS:
        found = _of_conic(first, second)
    else:
        found = _one_by_one(first, second)
    p, q, r, t = found
    return (
        _sharpened(first, second, p),
        _sharpened(first, second, q),
        _sharpened(first, second, r),
        _sharpened(first, second, t),
    )


def _of_line(first, second):
    """Roots of two linear equations: t goes out, and comes from the one that has more of it."""
    k = first[2]
    m = second[2]
    c, s, cosine, sine, margin = circle_line.roots(
        m * first[0] - k * second[0],
        m * first[1] - k * second[1],
        m * first[4] - k * second[4],
    )
    more = first
    if abs(k) < abs(m):
        more = second
    none = 0.0 * k
    if more[2] == 0.0:
        margin = none - 1.0
        t = none
        other = none
    else:
        t = (more[4] - more[0] * c - more[1] * s) / more[2]
        other = (more[4] - more[0] * cosine - more[1] * sine) / more[2]
    absent = (c, s, t, none, none - NO_ROW)
    return (c, s, t, none, margin), (cosine, sine, other, none, margin), absent, absent


def _of_conic(first, second):
    """Roots where the first equation gives t = (d - a c - a' s) / b."""
    a, b, k, _, d = first
    e, f, B, K, D = second
    t0 = d / k
    t1 = -a / k
    t2 = -b / k
    found = circle_conic.roots(
        K * t1 * t1,
        2.0 * K * t1 * t2,
        K * t2 * t2,
        (2.0 * K * t0 + B) * t1 + e,
        (2.0 * K * t0 + B) * t2 + f,
        (K * t0 + B) * t0 - D,
    )
    t = (t0, t1, t2)
    return (
        _with_length(t, found[0], found[1], found[4]),
        _with_length(t, found[2], found[3], found[4]),
        _with_length(t, found[5], found[6], found[9]),
        _with_length(t, found[7], found[8], found[9]),
    )


def _with_length(t, c, s, margin):
    return c, s, t[0] + t[1] * c + t[2] * s, 0.0 * c, margin


def _one_by_one(first, second):
    """Roots where the first equation holds next to no t."""
    return (
        _in_turn(first, second, False, False),
        _in_turn(first, second, False, True),
        _in_turn(first, second, True, False),
        _in_turn(first, second, True, True),
    )


def _in_turn(first, second, other_angle, other_length):
    """A root by solving the first equation for the angle and the second for t, in turn."""
    a, b, k, _, d = first
    A, B, h, K, D = second
    rest = d
    for _ in range(_TURNS):
        c, s, cosine, sine, margin = circle_line.roots(a, b, rest)
        if other_angle:
            c = cosine
            s = sine
        t, length, here = quadratic.roots(K, 0.5 * h, A * c + B * s - D)
        if other_length:
            t = length
        before = rest
        rest = d - k * t
        if rest == before:
            break
    return c, s, t, 0.0 * c, min(margin, here)


def _residuals(first, second, c, s, t):
    return (
        first[0] * c + first[1] * s + first[2] * t - first[4],
        second[0] * c + second[1] * s + (second[2] + second[3] * t) * t - second[4],
    )


def _sharpened(first, second, root):
    """A root by Newton's rule in both unknowns, as long as the residual becomes smaller."""
    c, s, t, none, margin = root
    if not margin > 0.0:
        return root
    e, f = _residuals(first, second, c, s, t)
    size = e * e + f * f
    for _ in range(_SHARPENED):
        e_c = first[1] * c - first[0] * s
        f_c = second[1] * c - second[0] * s
        f_t = second[2] + 2.0 * second[3] * t
        det = e_c * f_t - first[2] * f_c
        if det == 0.0:
            break
        turn = (first[2] * f - e * f_t) / det
        length = elementary.sqrt(1.0 + turn * turn)
        x = (c - s * turn) / length
        y = (s + c * turn) / length
        z = t + (e * f_c - e_c * f) / det
        e, f = _residuals(first, second, x, y, z)
        smaller = e * e + f * f
        if not smaller < size:
            break
        size = smaller
        c = x
        s = y
        t = z
    return c, s, t, none, margin
