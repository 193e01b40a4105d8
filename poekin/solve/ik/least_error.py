"""Least error: the nearest that joints within bounds come to a target out of reach.

Source: Levenberg 1944, Marquardt 1963.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...groups.arrays import Array
from .ik_problem import IKProblem

STEPS = 30
"""Steps towards a pose that is out of reach."""

REGULAR = 1e-13
"""The least damping of a step, of the largest number on the diagonal: J^T W J may be singular to
its rounding.
"""

Slope = tuple[float, Array, Array]
"""e^T W e, its Gauss-Newton matrix H = J^T W J and half its descent g = J^T W e, where J = -de/dq."""


def least_error(slope: Callable[[Array], Slope], q: Array, low: Array, high: Array) -> Array:
    """Joints within bounds (m,) of the least error that is downhill from q.

    A step is taken only where it makes the error smaller: beyond the reach, where the arm is
    stretched out, the descent to a target that can be reached would leap about.
    """
    damping = 1e-3
    size, H, g = slope(q)
    for _ in range(STEPS):
        least = REGULAR * H.diagonal().max()
        damped = H + max(damping, least) * np.eye(len(q))
        step = np.linalg.solve(damped, g)
        tried = np.clip(q + step, low, high)
        new = slope(tried)
        if new[0] < size:
            gain = size - new[0]
            q = tried
            size, H, g = new
            damping = 0.2 * damping
            if gain < 1e-9 * size:
                break
        else:
            damping *= 5
    return q


def slope_at(problem: IKProblem, target: Array, q: Array) -> Slope:
    """Slope at q (m,), in joint units, with the error of the compiled descent."""
    T, J = problem.fast.fk_jacobian(q, "hybrid")
    e = problem.error(T, target, J)
    problem.task.differentiate(T, e, J)
    weighted = J.T * problem.task.weights
    size = float(problem.task.weights @ e**2)
    return size, weighted @ J, weighted @ e
