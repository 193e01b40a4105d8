"""Roots of the determinant of elimination in one of its views, and the arrays that a call uses."""

from typing import NamedTuple

import numpy as np

from ....formulas.ik.elimination import circle_roots, line_equations, resultant
from ...lanes import rows as lanes

GAP = 12
"""Place of how far the last line is from its own, behind (c, s) of six joints."""

_POLAR_FORMS = np.array(circle_roots.POLAR_FORMS)
_CENTRES = np.array(circle_roots.CENTRES)
_HALVES = np.array(circle_roots.HALVES)
_WAVES = np.array(circle_roots.WAVES)
_ROOM = circle_roots.ROOM
_TOGETHER = 4  # roots


class EliminationScratch(NamedTuple):
    """Arrays that every target uses anew, and the far side of those whose own it is."""

    axes: np.ndarray
    far_side: np.ndarray
    near_side: np.ndarray
    sigma: np.ndarray
    A: np.ndarray
    M: np.ndarray
    values: np.ndarray
    f: np.ndarray
    on_arcs: np.ndarray
    segments: np.ndarray
    found: np.ndarray
    brackets: np.ndarray
    v: np.ndarray
    solved: np.ndarray
    angles: np.ndarray


def make_scratch():
    """Arrays for one call."""
    return EliminationScratch(
        np.empty((6, 6)),
        np.empty(line_equations.FAR_SIDE),
        np.empty(line_equations.NEAR_SIDE),
        np.empty(line_equations.KEPT * line_equations.ROOM),
        np.empty(_TOGETHER * resultant.EQUATIONS),
        np.empty(_TOGETHER * resultant.STACKED),
        np.empty(circle_roots.SAMPLES),
        np.empty(circle_roots.COEFFICIENTS),
        np.empty(circle_roots.LENGTH * circle_roots.ARCS),
        np.empty(circle_roots.SCRATCH),
        np.empty(3 * _ROOM),
        np.empty(circle_roots.FIELDS * _ROOM),
        np.empty(_TOGETHER * resultant.SIZE),
        np.empty(_TOGETHER * (GAP + 1)),
        np.empty(_TOGETHER * 6),
    )


def determinant(scratch, view, x, y):
    """The determinant at angles of which (x, y) is half of each, in a view; the factors are left in
    the scratch.

    A view (c, s, k), c and s of half of x_0, is the angle x' of tan((x - x_0) / 2) = k tan(x' / 2):
    of k < 1 the arc around x_0 is seen larger, and the determinant elsewhere, which is many orders
    larger at times, smaller.
    """
    c, s, stretch = view
    y = stretch * y
    C = c * x - s * y
    S = s * x + c * y
    square = x * x + y * y
    share = 1.0 / square
    weights = (
        C * C * share,
        C * S * share,
        S * S * share,
    )
    A = lanes.rows(scratch.A)
    resultant.equations(scratch.sigma, weights, A)
    det = resultant.factor(A, lanes.rows(scratch.M))
    fourth = square * square
    eighth = fourth * fourth
    return det * eighth * eighth


def polynomial(scratch, view):
    """Writes the Fourier coefficients of the determinant in a view, and those on the arcs; returns
    the largest and the noise.
    """
    many = lanes.at_once()
    groups = circle_roots.SAMPLES // many
    halves = lanes.rows(_HALVES)
    values = lanes.rows(scratch.values)
    for k in range(groups):
        values[k] = determinant(scratch, view, halves[k], halves[groups + k])
    circle_roots.fourier(
        lanes.rows(_WAVES),
        scratch.values,
        lanes.rows(scratch.f),
        circle_roots.COEFFICIENTS // many,
    )
    return circle_roots.size_and_noise(scratch.f)


def roots(scratch, zero, steepest, is_whole):
    """Number of roots of the polynomial, in `found` half of each as a point (cos, sin), and the
    slope; those far from a view's quarter are left out.
    """
    many = lanes.at_once()
    circle_roots.on_arcs(
        _POLAR_FORMS,
        lanes.rows(_CENTRES),
        scratch.f,
        lanes.rows(scratch.on_arcs),
        circle_roots.ARCS // many,
    )
    brackets = scratch.brackets
    number = circle_roots.brackets(
        scratch.on_arcs,
        zero,
        scratch.segments,
        brackets,
        is_whole,
    )
    width = circle_roots.ROOM // many
    rows = lanes.rows(brackets)
    groups = -(-number // many)
    for k in range(number, many * groups):
        for i in range(circle_roots.FIELDS):
            brackets[circle_roots.ROOM * i + k] = brackets[circle_roots.ROOM * i]
    found = lanes.rows(scratch.found)
    for group in range(groups):
        _polish(scratch, rows, group, width, steepest)
        C, S = circle_roots.half_of_root(rows, group, width)
        found[group] = C
        found[width + group] = S
        found[2 * width + group] = lanes.rows(scratch.values)[1]
    return number


def _polish(scratch, rows, group, width, steepest):
    """Newton's rule on some roots, until it is done with all; leaves their slopes."""
    many = lanes.at_once()
    values = lanes.rows(scratch.values)
    for _ in range(circle_roots.STEPS):
        step, slope = circle_roots.newton(scratch.f, rows, group, width)
        values[0] = step
        values[1] = slope
        is_done = True
        for k in range(many):
            is_done = is_done and circle_roots.is_found(
                scratch.values[k],
                scratch.values[many + k],
                steepest,
            )
        if is_done:
            break
