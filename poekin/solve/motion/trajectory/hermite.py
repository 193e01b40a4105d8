"""Cubic interpolation of points with times, coordinates and rates, as controllers do it."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array


def sample(
    times: Array,
    q: Array,
    dq: Array,
    t: Array,
) -> tuple[Array, Array, Array]:
    """q, dq and ddq (..., m) at times t (...) within `times` (N,), of rows q and dq (N, m).

    At a time of a row ddq is that of the step after it.
    """
    last = len(times) - 2
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, last)
    h = (times[k + 1] - times[k])[..., None]
    u = (t - times[k])[..., None] / h
    mean = (q[k + 1] - q[k]) / h
    bow = 3 * mean - 2 * dq[k] - dq[k + 1]
    skew = dq[k] + dq[k + 1] - 2 * mean
    x = q[k] + h * u * (dq[k] + u * (bow + u * skew))
    x = np.where(u == 1, q[k + 1], x)
    rate = dq[k] + u * (2 * bow + 3 * u * skew)
    return x, rate, (2 * bow + 6 * u * skew) / h


def peaks(times: Array, q: Array, dq: Array) -> tuple[Array, Array]:
    """Largest |dq| and |ddq| of each step (N - 1, m), exactly.

    ddq is linear in a step, so it is largest at an end; dq too, or where ddq is 0.
    """
    h = np.diff(times)[:, None]
    mean = np.diff(q, axis=0) / h
    before = dq[:-1]
    after = dq[1:]
    start = (6 * mean - 4 * before - 2 * after) / h
    end = (4 * after + 2 * before - 6 * mean) / h
    turns = start * end < 0
    change = np.where(turns, start - end, 1.0)
    between = np.where(turns, before + 0.5 * h * start * start / change, 0.0)
    rate = np.maximum(np.abs(before), np.abs(after))
    rate = np.maximum(rate, np.abs(between))
    return rate, np.maximum(np.abs(start), np.abs(end))
