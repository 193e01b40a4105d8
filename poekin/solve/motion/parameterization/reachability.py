"""Reachability analysis: the fastest ds/dt along a path within limits of speed and acceleration.

With x = (ds/dt)² and u = d²s/dt², dx/ds = 2 u, and every limit of a coordinate is linear in x and
u: |q' u + q'' x| <= a, and q'² x <= v² (primes are derivatives by s). Two passes over a grid of s
find the largest x: backward, from which x the rest of the path can still be kept to (controllable
sets, intervals from 0); forward, as fast as u allows within them.

Source: Pham and Pham 2018, "A new approach to time-optimal path parameterization based on
reachability analysis" (IEEE T-RO), with the limits at both ends of a step ("interpolation scheme").
The linear programs of two unknowns are solved by elimination of u.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from .joint_spline import PathDerivatives

NEGLIGIBLE = 1e-12
"""Share of a step's largest coefficient of u below which a limit does not depend on u."""


class _Limits(NamedTuple):
    """Limits of the steps: 2 ds (N,); -h - g x <= u <= h - g x, h and g (N, k); x <= most (N + 1,).

    The last column of h and g is that of 0 <= x + 2 u ds <= K at the step's end: it is filled in
    when K is known.
    """

    width: Array
    h: Array
    g: Array
    most: Array


def fastest(
    s: Array,
    path: PathDerivatives,
    speed: Array,
    acceleration: Array,
) -> Array:
    """Largest x = (ds/dt)² at grid points s (N + 1,), at rest at both ends.

    Parameters: path, derivatives (N + 1, m) at the grid points; speed, acceleration (m,), limits,
    infinite where there are none.
    """
    limits = _limits(s, path, speed, acceleration)
    controllable = _backward(limits)
    return _forward(limits, controllable)


def times_of(s: Array, x: Array) -> Array:
    """Times (N + 1,) of the points of a grid, from 0, u constant in each step."""
    rate = np.sqrt(x)
    mean_rate = rate[1:] + rate[:-1]
    times = np.zeros(len(s))
    np.cumsum(2 * np.diff(s) / mean_rate, out=times[1:])
    return times


def _limits(s: Array, path: PathDerivatives, speed: Array, acceleration: Array) -> _Limits:
    width = 2 * np.diff(s)
    turning = path.first / acceleration
    bending = path.second / acceleration
    turning_ahead = turning[1:] + width[:, None] * bending[1:]
    of_u = np.concatenate([turning[:-1], turning_ahead], axis=1)
    of_x = np.concatenate([bending[:-1], bending[1:]], axis=1)
    size = np.abs(of_u)
    binding = size > NEGLIGIBLE * size.max(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        h = np.where(binding, 1 / size, np.inf)
        g = np.where(binding, of_x / of_u, 0.0)
        fastest = speed / np.abs(path.first)
        most = np.min(fastest**2, axis=1)
    last = np.zeros((len(width), 1))
    return _Limits(
        width,
        np.append(h, last, axis=1),
        np.append(g, 1 / width[:, None], axis=1),
        most,
    )


def _backward(limits: _Limits) -> Array:
    """Largest controllable x (N + 1,): from it the path can be kept to, to rest at its end."""
    largest = np.zeros(len(limits.most))
    for i in reversed(range(len(limits.width))):
        above = limits.h[i].copy()
        above[-1] = largest[i + 1] / limits.width[i]
        below = limits.h[i]
        g = limits.g[i]
        slope = g[:, None] - g
        room = above[:, None] + below
        binding = slope > 0
        crossings = room[binding] / slope[binding]
        by_pairs = np.min(crossings, initial=np.inf)
        largest[i] = min(limits.most[i], by_pairs)
    return largest


def _forward(limits: _Limits, controllable: Array) -> Array:
    x = np.zeros(len(controllable))
    for i, width in enumerate(limits.width):
        h = limits.h[i, :-1]
        g = limits.g[i, :-1]
        u = np.min(h - g * x[i])
        # below 0 by a rounding, where the arm all but rests
        ahead = min(controllable[i + 1], x[i] + width * u)
        x[i + 1] = max(ahead, 0.0)
    return x
