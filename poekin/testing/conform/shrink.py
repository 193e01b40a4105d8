"""Smaller counterexamples: fewer parts, fewer numbers that are not zero, numbers with fewer digits.

Hypothesis shrinks the bytes that a case was read from, which are not its numbers; here the numbers
themselves shrink.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator

import numpy as np

from .laws.law import Case, SubjectLaw

BUDGET = 1500
"""How many cases are tried at most."""


def shrunk(
    law: SubjectLaw,
    case: Case,
    fails: Callable[[Case], bool],
    budget: int = BUDGET,
) -> Case:
    """The simplest case found, from this one on, that fails as well; the case itself where there is
    none.
    """
    spent = 0
    improved = True
    while improved:
        improved = False
        numbers = (candidate for candidate in _smaller(law, case) if cost(candidate) < cost(case))
        for candidate in itertools.chain(law.simpler(case), numbers):
            if not law.allowed(candidate):
                continue
            if spent >= budget:
                return case
            spent += 1
            if fails(candidate):
                case = candidate
                improved = True
                break
    return case


def cost(case: Case) -> tuple[float, ...]:
    """Complexity of a case, the gravest first: numbers at all, not zero, digits, signs, late places."""
    x = case.numbers
    places = np.flatnonzero(x)
    digits = sum(_digits(float(value)) for value in x[places])
    return (
        len(x),
        len(places),
        digits,
        int(np.sum(x < 0)),
        float(places.sum()),
        float(np.sum(_magnitude(x[places]))),
    )


def _smaller(law: SubjectLaw, case: Case) -> Iterator[Case]:
    x = case.numbers
    directions = list(law.directions(case))
    own = [
        k
        for k in np.flatnonzero(x).tolist()
        if not any(start <= k < start + 3 for start in directions)
    ]
    vectors = {k: x[k : k + 3] for k in law.triples(case)}
    vectors = {k: vector for k, vector in vectors.items() if np.any(vector)}
    for k in vectors:  # a whole vector away
        yield _with(case, k, np.zeros(3))
    for k in own:
        yield _with(case, k, 0.0)
    for k in directions:
        for direction in _simpler_directions(x[k : k + 3]):
            yield _with(case, k, direction)
    for k, vector in vectors.items():  # a vector along an axis
        length = math.hypot(*vector)
        for value in (length, *_rounder(length)):
            for axis in np.eye(3):
                yield _with(case, k, value * axis)
    for k in own:
        for value in _rounder(float(x[k])):
            yield _with(case, k, value)


def _simpler_directions(n: np.ndarray) -> Iterator[np.ndarray]:
    """Unit vectors with fewer numbers or digits: along an axis, in a plane of two axes, nearly
    along an axis.
    """
    for sign in (1.0, -1.0):
        yield from sign * np.eye(3)
    yield from map(np.array, itertools.permutations((0.6, 0.8, 0.0)))
    numbers = np.arange(3)
    largest = int(np.argmax(np.abs(n)))
    for k in np.flatnonzero(n).tolist():
        if k == largest:
            continue
        here = numbers == k
        less = np.where(here, 0.0, n)
        yield less / math.hypot(*less)
        tilt = float(n[k])
        if abs(tilt) < 1e-4:  # the length stays 1 to rounding
            for value in (_power_of_10(tilt), abs(tilt)):
                yield np.where(here, value, n)
    yield np.where(numbers == largest, 1.0, n)


def _rounder(value: float) -> Iterator[float]:
    """Values with fewer digits near a number, the simplest first."""
    yield from (1.0, -1.0, math.pi)
    yield math.copysign(_power_of_10(value), value)
    for digits in range(1, 17):
        short = float(f"{value:.{digits - 1}e}")
        yield from (short, abs(short))
    # Towards π the digits that matter are those of the gap.
    gap = math.pi - abs(value)
    if 0 < gap < 0.1:
        yield math.pi - _power_of_10(gap)


def _power_of_10(value: float) -> float:
    """The power of ten nearest to the size of a number, in its logarithm; 0 for 0."""
    if value == 0:
        return 0.0
    return 10.0 ** round(math.log10(abs(value)))


def _digits(value: float) -> int:
    """Number of digits that a number other than 0 has to be written with."""
    # π is one number to people, and so is what is a power of ten short of it.
    if abs(value) == math.pi:
        return 1
    gap = math.pi - abs(value)
    if 0 < gap < 0.1 and abs(value) == math.pi - _power_of_10(gap):
        return 2
    return len(repr(abs(value)).split("e")[0].replace(".", "").strip("0"))


def _magnitude(x: np.ndarray) -> np.ndarray:
    """Distances of numbers from 1, in powers of ten."""
    return np.abs(np.log10(np.abs(x)))


def _with(
    case: Case,
    k: int,
    value: float | np.ndarray,
) -> Case:
    x = case.numbers.copy()
    x[k : k + np.size(value)] = value
    return case._replace(numbers=x)
