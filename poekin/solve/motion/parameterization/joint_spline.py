"""Cubic spline through configurations: a path q(s) with continuous curvature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norm, norms

SAME_POINT = 1e-6
"""Points nearer than this share of the longest step are one point: what lies between them is the
solver's rounding, and no part of the path.
"""


class PathDerivatives(NamedTuple):
    """Configurations q (..., m) at parameters s (...), and their derivatives by s."""

    q: Array
    first: Array
    second: Array


class JointSpline(NamedTuple):
    """Cubic spline q(s) over its chord length: knots (N,), and q and d²q/ds² (N, m) at them."""

    knots: Array
    q: Array
    second: Array

    def at(self, s: Array) -> PathDerivatives:
        """q, dq/ds and d²q/ds² at s (...) within the knots; q itself at a knot."""
        k = np.searchsorted(self.knots[1:-1], s, side="right")
        start = self.knots[k]
        h = (self.knots[k + 1] - start)[..., None]
        b = (s - start)[..., None] / h
        a = 1.0 - b
        q_a = self.q[k]
        q_b = self.q[k + 1]
        second_a = self.second[k]
        second_b = self.second[k + 1]
        sag_a = (a**3 - a) * second_a
        sag_b = (b**3 - b) * second_b
        tilt_a = (3 * a * a - 1) * second_a
        tilt_b = (3 * b * b - 1) * second_b
        return PathDerivatives(
            a * q_a + b * q_b + h * h / 6 * (sag_a + sag_b),
            (q_b - q_a) / h + h / 6 * (tilt_b - tilt_a),
            a * second_a + b * second_b,
        )


def distinct_points(q: Array) -> np.ndarray:
    """Numbers of the points (N,) but for those that repeat the one before."""
    steps = norms(np.diff(q, axis=0))
    least = SAME_POINT * steps.max(initial=0.0)
    kept = [0]
    for k in range(1, len(q)):
        last = q[kept[-1]]
        if norm(q[k] - last) > least:
            kept.append(k)
    return np.array(kept)


def make_joint_spline(q: Array) -> JointSpline:
    """Spline through points (N, m), N >= 2, no two neighbours the same.

    The third derivative is continuous at the second point and the last but one ("not a knot", as
    SciPy's `CubicSpline`): two points give a line, three a parabola, four one cubic.
    """
    steps = np.diff(q, axis=0)
    knots = np.concatenate([[0.0], np.cumsum(norms(steps))])
    h = np.diff(knots)
    slopes = steps / h[:, None]
    bends = np.diff(slopes, axis=0)
    second = np.zeros_like(q)
    if len(q) == 3:
        second[:] = 2 * bends[0] / (h[0] + h[1])
    elif len(q) > 3:
        second[1:-1] = _inner(h, 6 * bends)
        second[0] = _continued(second[1], second[2], h[0] / h[1])
        second[-1] = _continued(second[-2], second[-3], h[-1] / h[-2])
    return JointSpline(knots, q, second)


def _continued(end: Array, before: Array, ratio: float) -> Array:
    """Value at an outer knot on the line through the two before it, whose lengths have a ratio."""
    return end + ratio * (end - before)


def _inner(h: Array, right: Array) -> Array:
    """Second derivatives (N - 2, m) at the inner knots, of a tridiagonal system.

    h_{k-1} M_{k-1} + 2 (h_{k-1} + h_k) M_k + h_k M_{k+1} = 6 (slope_k - slope_{k-1}), where M at
    the ends is put in as not-a-knot has it.
    """
    diagonal = 2 * (h[:-1] + h[1:])
    above = h[1:].copy()
    below = h[:-1].copy()
    first = h[0] / h[1]
    last = h[-1] / h[-2]
    diagonal[0] += h[0] * (1 + first)
    above[0] -= h[0] * first
    diagonal[-1] += h[-1] * (1 + last)
    below[-1] -= h[-1] * last
    solved = right.copy()
    for k in range(1, len(diagonal)):
        share = below[k] / diagonal[k - 1]
        diagonal[k] -= share * above[k - 1]
        solved[k] -= share * solved[k - 1]
    solved[-1] /= diagonal[-1]
    for k in range(len(diagonal) - 2, -1, -1):
        known = above[k] * solved[k + 1]
        solved[k] = (solved[k] - known) / diagonal[k]
    return solved
