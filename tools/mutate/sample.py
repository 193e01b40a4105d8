"""Which mutants are drawn, and what their outcomes say of all: bars by room, and when a sample
proves one broken.

A sample holds of each room in proportion. Where all mutants of a room were run its share is
compared with the bar. A sample of a few from a room scatters: it fails where so many survivors
would be seen in less than one sample of a thousand if the room were exactly at its bar, and the
whole sample where that holds of all rooms together in less than one of a hundred. A run that fails
so proves an untested place; one that passes proves no share. As most that the tests near a module
let through others catch, which takes minutes for each, these are tried only where the sample fails
else.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence

import numpy as np

from .mutants import Mutant

BAR = 0.95
BARS = {"formulas": 0.97, "groups": 0.97, "model": 0.97, "engine": 0.97}
MOST_EQUIVALENT = 0.03
RARE_IN_A_ROOM, RARE = 0.001, 0.01


def bar(room: str) -> float:
    """The share of a room's mutants that the tests have to catch."""
    return BARS.get(room, BAR)


def drawn(mutants: Sequence[Mutant], size: int, seed: int) -> list[Mutant]:
    """That many, of each room in proportion to what it has; the remainders' largest are rounded up."""
    if size >= len(mutants):
        return list(mutants)
    rooms: dict[str, list[int]] = {}
    for k, mutant in enumerate(mutants):
        rooms.setdefault(mutant.room, []).append(k)
    exact = {name: size * len(places) / len(mutants) for name, places in rooms.items()}
    counts = {name: math.floor(share) for name, share in exact.items()}
    rest = size - sum(counts.values())
    for name in sorted(exact, key=lambda name: (counts[name] - exact[name], name))[:rest]:
        counts[name] += 1
    chosen = {
        k
        for name, places in rooms.items()
        for k in random.Random(f"{seed} {name}").sample(places, counts[name])
    }
    return [mutant for k, mutant in enumerate(mutants) if k in chosen]


def chance(survivors: int, sizes: Mapping[str, int]) -> float:
    """How likely at least so many survivors are where each room is exactly at its bar; `sizes` are
    drawn of each.
    """
    spread = np.ones(1)  # the probability of each number of survivors
    for name, size in sizes.items():
        p = 1 - bar(name)
        ways = [
            math.lgamma(size + 1) - math.lgamma(k + 1) - math.lgamma(size - k + 1)
            for k in range(size + 1)
        ]
        one = [
            math.exp(way + k * math.log(p) + (size - k) * math.log1p(-p))
            for k, way in enumerate(ways)
        ]
        spread = np.convolve(spread, one)
    return math.fsum(spread[survivors:])


def room_is_sound(name: str, survivors: int, size: int, whole: bool) -> bool:
    """Whether what was seen of a room, all of it or a sample, is in keeping with its bar."""
    if whole:
        return survivors <= (1 - bar(name)) * size
    return chance(survivors, {name: size}) >= RARE_IN_A_ROOM


def most(name: str, size: int) -> int:
    """The most survivors that a sample of a room may have."""
    return max(k for k in range(size + 1) if room_is_sound(name, k, size, whole=False))
