"""The shortest time along a path by linear programming over the whole of it at once."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.interpolate import CubicSpline
from scipy.optimize import linprog


def shortest_time(
    spline: CubicSpline,
    speed: np.ndarray,
    acceleration: np.ndarray,
    s: np.ndarray,
) -> float:
    """Time along a spline at grid points s, at rest at both ends.

    Unknown is x = (ds/dt)² at all points. The fastest x is the largest at every s, so its sum is
    the largest, too. d²s/dt² is half the slope between two x, and the accelerations are limited
    in the middle of each step: neither this scheme nor its solver, HiGHS, is poekin's.
    """
    count = len(s)
    ds = np.diff(s)
    middle = 0.5 * (s[1:] + s[:-1])
    first = spline(middle, 1) / acceleration
    bending = 0.5 * spline(middle, 2) / acceleration
    turning = first / (2 * ds[:, None])
    steps = np.repeat(np.arange(count - 1), len(acceleration))
    rows = np.arange(len(steps))
    at_start = sparse.coo_array(((bending - turning).ravel(), (rows, steps)), (len(rows), count))
    at_end = sparse.coo_array(((bending + turning).ravel(), (rows, steps + 1)), (len(rows), count))
    limits = sparse.csr_array(at_start + at_end)
    most = np.min((speed / np.maximum(np.abs(spline(s, 1)), 1e-6)) ** 2, axis=1)
    most[[0, -1]] = 0
    found = linprog(
        -np.ones(count),
        A_ub=sparse.vstack([limits, -limits]),
        b_ub=np.ones(2 * len(rows)),
        bounds=np.stack([0 * most, most], axis=1),
    )
    assert found.success
    rate = np.sqrt(np.maximum(found.x, 0))
    return float(np.sum(2 * ds / (rate[1:] + rate[:-1])))
