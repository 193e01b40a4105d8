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
    k = np.searchsorted(times[1:-1], t, side="right")
    before = q[k]
    after = q[k + 1]
    rate_before = dq[k]
    rate_after = dq[k + 1]
    h = (times[k + 1] - times[k])[..., None]
    u = (t - times[k])[..., None] / h
    mean = (after - before) / h
    bow = 3 * mean - 2 * rate_before - rate_after
    skew = rate_before + rate_after - 2 * mean
    x = before + h * u * (rate_before + u * (bow + u * skew))
    x = np.where(u == 1, after, x)
    rate = rate_before + u * (2 * bow + 3 * u * skew)
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
    extreme = before + 0.5 * h * start * start / change
    between = np.where(turns, extreme, 0.0)
    rate = np.maximum(np.abs(before), np.abs(after))
    rate = np.maximum(rate, np.abs(between))
    acceleration = np.maximum(np.abs(start), np.abs(end))
    return rate, acceleration
