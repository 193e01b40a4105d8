"""Listed solutions of many targets with the numbers that tell how they were found, put together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ....groups.arrays import Array
from .found import Tally
from .places import Places


class Listing(NamedTuple):
    """Places of the solutions of N targets, their errors (S, 2) in m and rad, and what was found of
    each target without limits.
    """

    places: Places
    errors: Array
    tally: Tally


def gathered(parts: Sequence[tuple[np.ndarray, Listing]], count: int) -> Listing:
    """The listing of `count` targets, of parts that each have the numbers of theirs; targets of no
    part have no solutions.
    """
    if len(parts) == 1 and len(parts[0][0]) == count:
        return parts[0][1]
    owner = np.concatenate([numbers[one.places.owner] for numbers, one in parts])
    # a slice takes no copy of what is in order, as of one part
    order: Any = slice(None)
    if (owner[1:] < owner[:-1]).any():
        order = np.argsort(owner, kind="stable")
    places = Places(
        q=np.concatenate([one.places.q for _, one in parts])[order],
        owner=owner[order],
        number=np.concatenate([one.places.number for _, one in parts])[order],
        within=_scattered([(numbers, one.places.within) for numbers, one in parts], count),
    )
    tallies = [(numbers, one.tally) for numbers, one in parts]
    tally = Tally(
        found=_scattered([(numbers, one.found) for numbers, one in tallies], count),
        least_hits=_scattered([(numbers, one.least_hits) for numbers, one in tallies], count),
        ends=_scattered([(numbers, one.ends) for numbers, one in tallies], count),
        restarts=_scattered([(numbers, one.restarts) for numbers, one in tallies], count),
        full=_scattered([(numbers, one.full) for numbers, one in tallies], count),
        sure=_scattered([(numbers, one.sure) for numbers, one in tallies], count),
        self_motion={
            int(numbers[k]): motion
            for numbers, one in tallies
            for k, motion in one.self_motion.items()
        },
    )
    errors = np.concatenate([one.errors for _, one in parts])[order]
    return Listing(places, errors, tally)


def _scattered(parts: Sequence[tuple[np.ndarray, np.ndarray]], count: int) -> np.ndarray:
    whole = np.zeros(count, parts[0][1].dtype)
    for numbers, values in parts:
        whole[numbers] = values
    return whole
