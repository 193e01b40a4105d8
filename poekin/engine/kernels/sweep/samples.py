"""Samples by their numbers: the same q for a number whoever asks, in any order.

Random numbers are those of SplitMix64 (Steele, Lea and Flood 2014): number i is a mix of the start
and i, so that none needs another. Those of Sobol's sequence differ from one to the next in one
direction number of each coordinate.
"""

import numpy as np

KIND, SEED, COUNTS = range(3)
GRID, RANDOM, SOBOL = range(3)
_BITS = 64  # direction numbers of a coordinate
_STEP = np.uint64(0x9E3779B97F4A7C15)
_FIRST = np.uint64(0xBF58476D1CE4E5B9)
_SECOND = np.uint64(0x94D049BB133111EB)
_UNIT = 2.0**-53


def write_samples(samples, bounds, first, q):
    """Coordinates q (m, N) of samples `first`, first + 1 and so on."""
    if samples[KIND] == GRID:
        for k in range(q.shape[1]):
            write_grid(first + k, samples[COUNTS:], bounds, q[:, k])
    elif samples[KIND] == SOBOL:
        _write_sobol(samples[1:], first, bounds, q)
    else:
        write_random(np.uint64(samples[SEED]), first, bounds, q)


def write_random(seed, first, bounds, q):
    """Evenly between the bounds."""
    m, count = q.shape
    start = mixed(seed)
    # a coordinate's states are an arithmetic progression, of which a loop takes several at once
    step = np.uint64(m) * _STEP
    for i in range(m):
        lower = bounds[0, i]
        width = bounds[1, i]
        state = _state(start, first * m + i + 1)
        for k in range(count):
            q[i, k] = _between(state, lower, width)
            state += step


def drawn(start, number, lower, width):
    """Random number `number`, 1, 2 and so on, between lower and lower + width."""
    return _between(_state(start, number), lower, width)


def _state(start, number):
    return start + np.uint64(number) * _STEP


def _between(state, lower, width):
    return lower + width * _unit(mixed(state))


def _write_sobol(numbers, first, bounds, q):
    """Evenly between the bounds: `numbers` are shifts (m) and direction numbers (m, 64)."""
    m, count = q.shape
    for i in range(m):
        v = numbers[m + _BITS * i :]
        bits = numbers[i]
        gray = first ^ (first >> 1)
        k = 0
        while gray:
            if gray & 1:
                bits ^= v[k]
            gray >>= 1
            k += 1
        for j in range(count):
            q[i, j] = bounds[0, i] + bounds[1, i] * _unit(np.uint64(bits))
            bits ^= v[_lowest_zero(first + j)]


def _lowest_zero(number):
    """Place of the lowest bit that is 0: where the Gray codes of a number and the next one differ."""
    k = 0
    while number & 1:
        number >>= 1
        k += 1
    return k


def _unit(bits):
    """The number from 0 to 1, 1 left out, of the highest 53 of 64 bits."""
    return np.int64(bits >> np.uint64(11)) * _UNIT


def mixed(x):
    """64 bits of which each depends on each of x."""
    x = (x ^ (x >> np.uint64(30))) * _FIRST
    x = (x ^ (x >> np.uint64(27))) * _SECOND
    return x ^ (x >> np.uint64(31))


def write_grid(number, counts, bounds, q):
    """In the middles of `counts` (m,) equal parts; the last coordinate changes first."""
    for i in range(len(q) - 1, -1, -1):
        q[i] = divided(number, counts[i], bounds[0, i], bounds[1, i])
        number = number // counts[i]


def divided(number, count, lower, width):
    """Middle of part number % count, of `count` equal ones between lower and lower + width."""
    part = number % count
    return lower + width * ((part + 0.5) / count)
