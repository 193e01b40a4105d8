"""Listed solutions of many targets with the numbers that tell how they were found, put together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from .found import Tally, scattered
from .places import Places


class Listing(NamedTuple):
    """Places of the solutions of N targets, their errors (S, 2) in m and rad, and what was found of
    each target without limits.
    """

    places: Places
    errors: Array
    tally: Tally


class ListedPart(NamedTuple):
    """The numbers (N,) of some targets, and their listing."""

    numbers: np.ndarray
    listing: Listing


def gathered(parts: Sequence[ListedPart], count: int) -> Listing:
    """The listing of `count` targets, of parts that each have the numbers of theirs; targets of no
    part have no solutions.
    """
    if len(parts) == 1 and len(parts[0].numbers) == count:
        return parts[0].listing
    numbers = [part.numbers for part in parts]
    listings = [part.listing for part in parts]
    found = [one.places for one in listings]
    tallies = [one.tally for one in listings]
    owner = np.concatenate([part.numbers[part.listing.places.owner] for part in parts])
    order = np.argsort(owner, kind="stable")
    q = np.concatenate([one.q for one in found])
    number = np.concatenate([one.number for one in found])
    errors = np.concatenate([one.errors for one in listings])
    self_motion = {}
    for own, tally in zip(numbers, tallies, strict=True):
        for k, motion in tally.self_motion.items():
            self_motion[int(own[k])] = motion

    def of_all(name: str, records: Sequence[Places | Tally]) -> np.ndarray:
        values = [getattr(record, name) for record in records]
        return scattered(numbers, values, count)

    within = of_all("within", found)
    places = Places(q[order], owner[order], number[order], within)
    of_targets = {name: of_all(name, tallies) for name in Tally._fields[:-1]}
    tally = Tally(**of_targets, self_motion=self_motion)
    return Listing(places, errors[order], tally)
