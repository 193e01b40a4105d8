"""Cubic spline through configurations: a path q(s) with continuous curvature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms

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
        last = len(self.knots) - 2
        k = np.searchsorted(self.knots, s, side="right") - 1
        k = np.clip(k, 0, last)
        h = (self.knots[k + 1] - self.knots[k])[..., None]
        b = (s - self.knots[k])[..., None] / h
        a = 1.0 - b
        q_a = self.q[k]
        q_b = self.q[k + 1]
        second_a = self.second[k]
        second_b = self.second[k + 1]
        sag = (a**3 - a) * second_a + (b**3 - b) * second_b
        tilt = (3 * b * b - 1) * second_b - (3 * a * a - 1) * second_a
        return PathDerivatives(
            a * q_a + b * q_b + h * h / 6 * sag,
            (q_b - q_a) / h + h / 6 * tilt,
            a * second_a + b * second_b,
        )


def distinct_points(q: Array) -> np.ndarray:
    """Numbers of the points (N,) but for those that repeat the one before."""
    steps = norms(np.diff(q, axis=0))
    least = SAME_POINT * steps.max(initial=0.0)
    kept = [0]
    for k in range(1, len(q)):
        if np.linalg.norm(q[k] - q[kept[-1]]) > least:
            kept.append(k)
    return np.array(kept)


def make_joint_spline(q: Array) -> JointSpline:
    """Spline through points (N, m), N >= 2, no two neighbours the same.

    The third derivative is continuous at the second point and the last but one ("not a knot", as
    SciPy's `CubicSpline`): two points give a line, three a parabola, four one cubic.
    """
    h = norms(np.diff(q, axis=0))
    knots = np.concatenate([[0.0], np.cumsum(h)])
    h = np.diff(knots)
    slopes = np.diff(q, axis=0) / h[:, None]
    second = np.zeros_like(q)
    if len(q) == 3:
        second[:] = 2 * (slopes[1] - slopes[0]) / (h[0] + h[1])
    elif len(q) > 3:
        second[1:-1] = _inner(h, 6 * np.diff(slopes, axis=0))
        second[0] = second[1] + h[0] / h[1] * (second[1] - second[2])
        second[-1] = second[-2] + h[-1] / h[-2] * (second[-2] - second[-3])
    return JointSpline(knots, q, second)


def _inner(h: Array, right: Array) -> Array:
    """Second derivatives (N - 2, m) at the inner knots, of a tridiagonal system.

    h_{k-1} M_{k-1} + 2 (h_{k-1} + h_k) M_k + h_k M_{k+1} = 6 (slope_k - slope_{k-1}), where M at
    the ends is put in as not-a-knot has it.
    """
    diagonal = 2 * (h[:-1] + h[1:])
    above = h[1:].copy()
    below = h[:-1].copy()
    diagonal[0] += h[0] * (1 + h[0] / h[1])
    above[0] -= h[0] * (h[0] / h[1])
    diagonal[-1] += h[-1] * (1 + h[-1] / h[-2])
    below[-1] -= h[-1] * (h[-1] / h[-2])
    solved = right.copy()
    for k in range(1, len(diagonal)):
        share = below[k] / diagonal[k - 1]
        diagonal[k] -= share * above[k - 1]
        solved[k] -= share * solved[k - 1]
    solved[-1] /= diagonal[-1]
    for k in range(len(diagonal) - 2, -1, -1):
        solved[k] = (solved[k] - above[k] * solved[k + 1]) / diagonal[k]
    return solved
