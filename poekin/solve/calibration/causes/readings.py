"""Joint readings taken otherwise: coupled, reversed, exchanged, with another zero, in other units."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....errors import escape_unprintable
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.sampling import angle_mask

_ZEROS = (90, -90, 180)  # degrees


class Reading(NamedTuple):
    """Joint readings (N, m) taken otherwise, and that in words."""

    words: str
    q: Array


def other_readings(chain: Chain, q: Array) -> Iterator[Reading]:
    """The joint readings taken otherwise: they follow one another, are reversed, or stand in another
    order.
    """
    names = short_names(chain)
    turns = np.flatnonzero(angle_mask(chain)).tolist()
    for i, j in itertools.permutations(turns, 2):
        for sign, word in ((1.0, "+"), (-1.0, "-")):
            other = q.copy()
            other[:, i] += sign * q[:, j]
            words = f"{names[i]} = {names[i]} {word} {names[j]}"
            yield Reading(f"the readings coupled, {words!r}", other)
    for i in range(chain.dof):
        other = q.copy()
        other[:, i] *= -1.0
        yield Reading(f"{names[i]} reversed", other)
    for j, i in itertools.combinations(range(chain.dof), 2):
        other = q.copy()
        other[:, i] = q[:, j]
        other[:, j] = q[:, i]
        yield Reading(f"{names[j]} and {names[i]} exchanged", other)


def other_zeros(chain: Chain, q: Array) -> Iterator[Reading]:
    """The joint readings of each angle with a quarter or half a turn added."""
    names = short_names(chain)
    turns = np.flatnonzero(angle_mask(chain)).tolist()
    for i, degrees in itertools.product(turns, _ZEROS):
        other = q.copy()
        other[:, i] += np.deg2rad(degrees)
        yield Reading(f"{degrees}° added to {names[i]}", other)


def short_names(chain: Chain) -> list[str]:
    """Names of the coordinates as messages have them."""
    return [escape_unprintable(name, 40) for name in chain.q_names]
