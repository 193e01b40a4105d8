"""Branches of an arm whose second to fourth axes are parallel, or joints move in a plane."""

import math

from ....algebra import add, cross, dot, rotate, subtract
from ....formulas.ik import three_parallel
from ....formulas.ik.rotation_onto import rotated
from ....formulas.ik.slides import planar
from ....formulas.ik.slides.position import across as any_across
from .closed_arm import (
    ADDED,
    DOUBLE,
    LOST,
    NEAR,
    RULE,
    UNSURE,
    across,
    brought,
    direction,
    doubted,
    point,
    slides,
    store,
)


def fill(arm, R, p, rows):
    """Write up to eight branches for D = (R, p) and return their number."""
    h = (
        direction(arm, 0, R),
        direction(arm, 1, R),
        direction(arm, 2, R),
        direction(arm, 3, R),
        direction(arm, 4, R),
        direction(arm, 5, R),
    )
    P, place = _steps(arm, R, p)
    kinds = (slides(arm, 1), slides(arm, 2), slides(arm, 3))
    if kinds[0] or kinds[1] or kinds[2]:
        return _fill_planar(arm, kinds, h, P, R, place, rows)
    u = across(arm, 1, R)
    at = 0
    for root in three_parallel.outer(h, P, R, place):
        first, second = three_parallel.with_outer(h, P, u, R, place, root)
        # where the sixth axis is parallel to the three, any x_6 was taken
        any_last = abs(root[4]) < DOUBLE
        for x in (first, second):
            if store(arm, x[:12], doubted(x[12], root[4]), rows[at]):
                at += 1
            elif arm[RULE, ADDED] and (any_last or _lost(h, P, x, R, place)):
                rows[at, -1] = UNSURE
                at += 1
    return at


def _fill_planar(arm, kinds, h, P, R, place, rows):
    """Write the branches of an arm whose second to fourth joints are not all revolute."""
    if not kinds[0]:
        n = h[1]
    elif not kinds[1]:
        n = h[2]
    else:
        n = h[3]
    u = any_across(n)
    at = 0
    for root in three_parallel.outer((h[0], n, n, n, h[4], h[5]), P, R, place):
        both = planar.with_outer(kinds, h, P, n, u, R, place, root)
        # of two prismatic joints both are the same
        number = 3 - (kinds[0] + kinds[1] + kinds[2])
        for k in range(number):
            x = both[k]
            if store(arm, x[:12], doubted(x[12], root[4]), rows[at]):
                at += 1
    return at


def _lost(h, P, x, R, place):
    """Whether the joints reach D and cannot move the tool every way: the determinant, as a share of
    the largest, of the first and fifth joint's equations, the triangle and the sixth joint is small.
    """
    back = rotated(h[0], x[0], -x[1], place)
    ahead = rotated(h[4], x[8], x[9], P[5])
    turned = rotated(h[0], x[0], -x[1], rotate(R, h[5]))
    end = rotated(h[4], x[8], x[9], h[5])
    elbow = rotated(h[2], x[4], x[5], add(P[3], rotated(h[3], x[6], x[7], add(P[4], ahead))))
    away = subtract(add(P[1], rotated(h[1], x[2], x[3], add(P[2], elbow))), back)
    size = math.sqrt(dot(back, back) + dot(ahead, ahead))
    tilt = dot(h[1], subtract(turned, end))
    if dot(away, away) > NEAR * NEAR * size * size or abs(tilt) > NEAR:
        return False
    a = dot(h[1], cross(h[0], turned)) * dot(h[1], cross(h[4], ahead))
    b = dot(h[1], cross(h[4], end)) * dot(h[1], cross(h[0], back))
    lengths = math.sqrt(dot(P[2], P[2]) * dot(P[3], P[3]))
    triangle = dot(h[1], cross(P[2], rotated(h[2], x[4], x[5], P[3]))) / lengths
    last = cross(h[1], end)
    return abs((a - b) / size * triangle) * dot(last, last) < LOST


def _steps(arm, R, p):
    """P_0 = 0, P_1 to P_5, and the place that the joints bring the sixth axis to from the first."""
    a = point(arm, 0, R, p)
    b = point(arm, 1, R, p)
    c = point(arm, 2, R, p)
    d = point(arm, 3, R, p)
    e = point(arm, 4, R, p)
    f = point(arm, 5, R, p)
    P = (
        subtract(a, a),
        subtract(b, a),
        subtract(c, b),
        subtract(d, c),
        subtract(e, d),
        subtract(f, e),
    )
    return P, subtract(brought(R, p, f), a)
