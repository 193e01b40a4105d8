"""Branches of an arm whose fourth to sixth axes meet in a point (spherical wrist)."""

import math

from ....algebra import add, cross, dot, scale, subtract
from ....formulas.ik import orientation
from ....formulas.ik.rotation_onto import rotated
from ....formulas.ik.slides import position
from ....formulas.ik.slides.position import moved, moved_back
from .closed_arm import (
    ADDED,
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
    h, P, place = _in_front(arm, R, p)
    k = (
        direction(arm, 3, R),
        direction(arm, 4, R),
        direction(arm, 5, R),
    )
    u = across(arm, 5, R)
    kinds = (slides(arm, 0), slides(arm, 1), slides(arm, 2))
    at = 0
    for x in position.roots(kinds, h, P, place):
        first, second = orientation.roots(k, u, _rest(kinds, h, x, R))
        for wrist in (first, second):
            margin = min(x[6], wrist[6])
            if margin == -math.inf:
                continue
            margin = doubted(margin, x[6])
            if store(arm, x[:6] + wrist[:6], margin, rows[at]):
                at += 1
            elif arm[RULE, ADDED] and _lost(kinds, h, P, x, place):
                rows[at, -1] = UNSURE
                at += 1
    return at


def _lost(kinds, h, P, x, place):
    """Whether the first three joints bring the wrist to its place and cannot move it every way: the
    determinant of its velocities is small, as a share of the largest.
    """
    size = math.sqrt(dot(P[0], P[0]) + dot(P[1], P[1]) + dot(P[2], P[2]))
    first = moved_back(kinds[0], h[0], x[0], x[1], place)
    a = _velocity(kinds[0], h[0], scale(1.0 / size, first))
    second = subtract(first, P[0])
    b = _velocity(kinds[1], h[1], scale(1.0 / size, second))
    third = moved(kinds[2], h[2], x[4], x[5], P[2])
    c = _velocity(kinds[2], h[2], scale(1.0 / size, third))
    if not kinds[1]:
        c = rotated(h[1], x[2], x[3], c)
    away = subtract(moved(kinds[1], h[1], x[2], x[3], add(P[1], third)), second)
    near = dot(away, away) <= NEAR * NEAR * size * size
    return near and abs(dot(a, cross(b, c))) < LOST


def _velocity(slide, h, place):
    if slide:
        return h
    return cross(h, place)


def _in_front(arm, R, p):
    """Axes and steps of the first three joints, and the place that they bring the wrist to."""
    h = (
        direction(arm, 0, R),
        direction(arm, 1, R),
        direction(arm, 2, R),
    )
    a = point(arm, 0, R, p)
    b = point(arm, 1, R, p)
    c = point(arm, 2, R, p)
    wrist = point(arm, 5, R, p)
    P = (subtract(b, a), subtract(c, b), subtract(wrist, c))
    return h, P, subtract(brought(R, p, wrist), a)


def _rest(kinds, h, x, R):
    """Rotation that the first three joints leave of R to the wrist."""
    a = _turned_back(kinds, h, x, (R[0], R[3], R[6]))
    b = _turned_back(kinds, h, x, (R[1], R[4], R[7]))
    c = cross(a, b)
    return (a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2])


def _turned_back(kinds, h, x, a):
    """A vector before the rotations of the first three joints."""
    if not kinds[0]:
        a = rotated(h[0], x[0], -x[1], a)
    if not kinds[1]:
        a = rotated(h[1], x[2], -x[3], a)
    if not kinds[2]:
        a = rotated(h[2], x[4], -x[5], a)
    return a
