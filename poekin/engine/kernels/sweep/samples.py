"""Samples by their numbers: the same q for a number whoever asks, in any order.

Random numbers are those of SplitMix64 (Steele, Lea and Flood 2014): number i is a mix of the start
and i, so that none needs another.
"""

import numpy as np

KIND, SEED, COUNTS = range(3)
GRID, RANDOM = range(2)
_STEP = np.uint64(0x9E3779B97F4A7C15)
_FIRST = np.uint64(0xBF58476D1CE4E5B9)
_SECOND = np.uint64(0x94D049BB133111EB)
_UNIT = 2.0**-53


def write_samples(samples, bounds, first, q):
    """Coordinates q (N, m) of samples `first`, first + 1 and so on."""
    if samples[KIND] == GRID:
        for k in range(q.shape[0]):
            _write_grid(first + k, samples[COUNTS:], bounds, q[k])
    else:
        _write_random(np.uint64(samples[SEED]), first, bounds, q)


def _write_random(seed, first, bounds, q):
    """Evenly between the bounds."""
    count, m = q.shape
    start = _mixed(seed)
    for k in range(count):
        for i in range(m):
            bits = _mixed(start + np.uint64((first + k) * m + i + 1) * _STEP)
            q[k, i] = bounds[0, i] + bounds[1, i] * (np.int64(bits >> np.uint64(11)) * _UNIT)


def _mixed(x):
    """64 bits of which each depends on each of x."""
    x = (x ^ (x >> np.uint64(30))) * _FIRST
    x = (x ^ (x >> np.uint64(27))) * _SECOND
    return x ^ (x >> np.uint64(31))


def _write_grid(number, counts, bounds, q):
    """In the middles of `counts` (m,) equal parts; the last coordinate changes first."""
    for i in range(len(q) - 1, -1, -1):
        part = number % counts[i]
        number = number // counts[i]
        q[i] = bounds[0, i] + bounds[1, i] * ((part + 0.5) / counts[i])
