"""Six joints of which the second to the fourth move in a plane: revolute ones with the normal n,
prismatic ones across it.

They leave the direction n and the height along it as they are, so the first and the fifth joint
come from `three_parallel.outer`, and then the sixth, the whole turn phi of the three and the place r
in the plane that they bring a point to. Of one prismatic joint

    |y + u t|^2 = |z|^2

tells its t (`quadratic`), of two  u t + v w = y  tells both; u, v, y and z are known for each order of
the joints. Accuracy: that of `two_circles` and `quadratic`
(tests/formulas/ik/slides/test_planar.py). Source: Elias and Wen 2025, Section IV, with prismatic
joints in place of the triangle's.
"""

from ....algebra import add, cross, dot, scale, subtract
from ... import elementary
from .. import three_parallel
from ..rotation_onto import rotated, rotation_onto
from ..rounding import is_rounding
from . import quadratic

_ROUNDING = 0.0625  # 1 / 16: 16 u


def with_outer(slides, h, P, n, across, R, p, root):
    """Two rows (x_1, y_1, ..., x_6, y_6, margin) of one root of `three_parallel.outer`.

    `slides` says which of the joints 2 to 4 are prismatic, one or two of them; `across` is a vector
    across n.
    """
    last, turned, phi, r = three_parallel.inner(h, P, n, across, R, p, root)
    if slides[0] + slides[1] + slides[2] == 2:
        x, y = _of_two(slides, h, P, n, phi, r)
    else:
        x, y = _of_one(slides, h, P, n, (across, turned), phi, r)
    return (
        root[:2] + x[:6] + root[2:4] + last + (min(root[4], x[6]),),
        root[:2] + y[:6] + root[2:4] + last + (min(root[4], y[6]),),
    )


def _size(P):
    """Length of which rounding of places is a share."""
    squares = dot(P[1], P[1]) + dot(P[2], P[2]) + dot(P[3], P[3])
    return elementary.sqrt(squares + dot(P[4], P[4]) + dot(P[5], P[5]))


def _of_two(slides, h, P, n, phi, r):
    """The row of two prismatic joints, twice: the revolute one makes the whole turn."""
    c, s = phi
    both = add(P[2], P[3])
    if not slides[0]:
        u = rotated(n, c, s, h[2])
        v = rotated(n, c, s, h[3])
        y = subtract(r, rotated(n, c, s, both))
        own = h[1]
    elif not slides[1]:
        u = h[1]
        v = rotated(n, c, s, h[3])
        y = subtract(subtract(r, P[2]), rotated(n, c, s, P[3]))
        own = h[2]
    else:
        u = h[1]
        v = h[2]
        y = subtract(r, both)
        own = h[3]
    det = dot(n, cross(u, v))
    none = 0.0 * det
    margin = 1.0 + none
    if is_rounding(_ROUNDING * det, 1.0):
        # one slides along the other: the way is left to the first, or is none of theirs
        off = dot(n, cross(u, y))
        margin = none if is_rounding(_ROUNDING * off, _size(P)) else none - 1.0
        v = cross(n, u)
        det = 1.0 + none
    t = dot(n, cross(y, v)) / det
    w = dot(n, cross(u, y)) / det
    if dot(own, n) < 0.0:
        s = -s
    if not slides[0]:
        row = (c, s, t, none, w, none, margin)
    elif not slides[1]:
        row = (t, none, c, s, w, none, margin)
    else:
        row = (t, none, w, none, c, s, margin)
    return row, row


def _of_one(slides, h, P, n, turns, phi, r):
    """Both rows of one prismatic joint: the quadratic, then the revolute ones."""
    c, s = phi
    if slides[0]:
        u = scale(-1.0, h[1])
        y = subtract(r, P[2])
        z = P[3]
    elif slides[1]:
        u = h[2]
        y = add(P[2], P[3])
        z = r
    else:
        u = scale(-1.0, rotated(n, c, s, h[3]))
        y = subtract(r, rotated(n, c, s, P[3]))
        z = P[2]
    squares = dot(y, y) - dot(z, z)
    t, w, margin = quadratic.roots(dot(u, u), dot(u, y), squares)
    # a point on the axis that should turn it: any angle serves
    if is_rounding(_ROUNDING * elementary.sqrt(dot(y, y) + dot(z, z)), _size(P)):
        margin = 0.0 * margin
    one = add(y, scale(t, u))
    other = add(y, scale(w, u))
    return (
        _with_length(slides, h, turns, z, one, (t, margin)),
        _with_length(slides, h, turns, z, other, (w, margin)),
    )


def _with_length(slides, h, turns, z, y, root):
    """The row of one t: a revolute joint turns z and y onto each other, and the last what is left."""
    t, margin = root
    across, turned = turns
    none = 0.0 * t
    if slides[0]:
        c, s, _ = rotation_onto(h[2], z, y)
        rest = rotated(h[2], c, -s, turned)
        x, w, _ = rotation_onto(h[3], across, rest)
        return t, none, c, s, x, w, margin
    if slides[1]:
        c, s, _ = rotation_onto(h[1], y, z)
        rest = rotated(h[1], c, -s, turned)
        x, w, _ = rotation_onto(h[3], across, rest)
        return c, s, t, none, x, w, margin
    c, s, _ = rotation_onto(h[1], z, y)
    rest = rotated(h[1], c, -s, turned)
    x, w, _ = rotation_onto(h[2], across, rest)
    return c, s, x, w, t, none, margin
