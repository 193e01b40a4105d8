"""Bytes as angles, axes, vectors and rotations: what the strategies read off, each a function of a
`BytesReader`.

Every byte of zeros reads as the simplest: angle 0, the x axis, length 0. Raises: nothing; bounds
are checked by who offers them. Source: `group_strategies` says why magnitudes are spread as they
are.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from ....groups.arrays import Array
from .bytes_reader import BytesReader

SWITCHES = (2e-140, 1.0, 2.0)
"""Angles in rad at which the package's formulas for exp, log and the Jacobians of exp change their
form.
"""
SMALLEST = 1e-150
"""The smallest angle in rad that is drawn beside 0."""


def around(x: float) -> tuple[float, float, float]:
    """Number with the floats on both sides of it.

    Parameters
    ----------
    x : float
        The number.

    Returns
    -------
    neighbours : tuple of float
        The number, the float below it and the float above it.
    """
    return x, math.nextafter(x, -math.inf), math.nextafter(x, math.inf)


def angle(
    r: BytesReader,
    largest: float,
    smallest: float,
) -> float:
    """An angle from 0 to largest in rad, smallest the least beside 0. Takes 6 bytes."""
    kind = r.byte() % 12
    fresh = min(max(smallest, 1e-12), largest)
    if kind < 5:
        return r.magnitude(fresh, largest)
    if kind < 6:
        return r.magnitude(smallest, max(smallest, 1e-12))
    if kind < 8 and (marks := _marks(largest, smallest)):
        return r.pick(marks)
    if kind < 10 and smallest <= math.pi - 1.0 and largest >= math.pi:
        return math.pi - 10.0 ** -r.fraction(0.0, 16.0)
    return r.fraction(min(smallest, largest), largest)


def axis(r: BytesReader) -> Array:
    """A unit vector (3,): an axis of the frame, nearly one, or any. Takes 12 bytes."""
    kind = r.byte() % 4
    place = r.byte()
    sign = 1.0
    if r.byte() >= 128:
        sign = -1.0
    n = np.array([sign, 0.0, 0.0])
    if kind == 1:
        n[1] = 10.0 ** -r.fraction(1.0, 17.0)
        n[2] = -(10.0 ** -r.fraction(1.0, 17.0))
    elif kind:
        shares = [r.fraction(-1.0, 1.0) for _ in range(3)]
        anywhere = np.array(shares)
        if math.hypot(*anywhere) > 0.1:
            n = anywhere
    n /= math.hypot(*n)
    return n[(np.arange(3) - place) % 3]


def vector(r: BytesReader, lengths: tuple[float, float]) -> Array:
    """A vector (3,) in m, of length 0 or within lengths. Takes 16 bytes."""
    return r.magnitude(*lengths) * axis(r)


def rotation(r: BytesReader) -> Array:
    """A rotation (3, 3) by 0 to π. Takes 18 bytes."""
    n = axis(r)
    return turned(n, angle(r, math.pi, SMALLEST))


def turned(n: Array, by: float) -> Array:
    """The rotation (3, 3) by an angle `by` in rad about the unit vector n (3,): I + sin θ [n] + 2
    sin²(θ/2) [n]².
    """
    x, y, z = n
    rows = [
        [0, -z, y],
        [z, 0, -x],
        [-y, x, 0],
    ]
    N = np.array(rows)
    versine = 2 * math.sin(by / 2) ** 2
    return np.eye(3) + math.sin(by) * N + versine * (N @ N)


@functools.cache
def _marks(largest: float, smallest: float) -> list[float]:
    marks: list[float] = []
    for switch in SWITCHES:
        marks += around(switch)
    marks.append(math.pi)
    for quarters in (2, 1, 4):
        marks += around(quarters * math.pi / 2)
    return [x for x in marks if smallest <= x <= largest]
