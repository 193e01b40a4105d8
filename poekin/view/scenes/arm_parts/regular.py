"""A configuration to open with where that with all joints at zero is singular."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from ....analysis.dexterity.manipulability import manipulability
from ....analysis.dexterity.singularity import singularity
from ....errors import join_names, quote
from ....groups.arrays import Array
from ....model.chain import Chain
from ...scene import SceneTip, Slider
from .geometry import ArmGeometry

MOST = 1500
"""Configurations that are looked at."""
TURN = 0.5 * math.pi
"""Turn of a joint, rad; half of what its limits leave where that is less."""
GOOD = 2.0
"""Condition number by the smallest of all, up to which a configuration is taken."""


def is_one_arm(tips: Sequence[SceneTip]) -> bool:
    """Whether what moves the first tip moves all others too, as an arm does with its fingers."""
    first = set(tips[0].coordinates)
    return all(first.issubset(tip.coordinates) for tip in tips)


def regular_opening(arm: ArmGeometry, chain: Chain, moved: Sequence[int], q: Array) -> Array:
    """Configuration (m,) of the sliders at which a tip is not singular: q where it is not singular
    there, and where nothing better is found.

    Of all ways to turn some of its joints by a quarter turn either way those with nearly the best
    condition number, of these those with the fewest joints turned, and of these the one whose
    lowest point is highest. Always the same.

    Parameters: chain, from the base to the tip; moved (dof,), numbers of its coordinates.
    """
    moved = list(moved)
    found = singularity(chain, q[moved])
    if not found.singular:
        return q
    others = itertools.islice(_turned(arm.sliders, moved, q), MOST)
    turned = np.array([q, *others])
    measures = manipulability(chain, turned[:, moved], length=found.length)
    condition = getattr(measures, found.part).condition
    if not np.isfinite(condition.min()):
        return q
    good = turned[condition <= GOOD * condition.min()]
    count = (good != q).sum(axis=1)
    fewest = good[count == count.min()]
    heights = [arm.points(row)[:, 2].min() for row in fewest]
    lowest = np.round(heights, 9)
    return fewest[np.argmax(lowest)]


def opening_words(arm: ArmGeometry, tip: str, q: Array, opening: Array) -> list[str]:
    """Sentence on the joints that are turned from q to the opening, if any."""
    turned = opening != q
    names = [slider.name for k, slider in enumerate(arm.sliders) if turned[k]]
    if not names:
        return []
    return [f"The page opens with {join_names(names)} turned: otherwise {quote(tip)} is singular."]


def _turned(sliders: Sequence[Slider], moved: Sequence[int], q: Array) -> Iterator[Array]:
    """Configurations with one angle turned, with two, and so on."""
    ways = []
    for k in moved:
        if sliders[k].unit == "rad":
            up = 0.5 * (sliders[k].upper - q[k])
            down = 0.5 * (sliders[k].lower - q[k])
            steps = (min(TURN, up), max(-TURN, down))
            ways.append((k, [q[k] + step for step in steps if step]))
    for count in range(1, len(ways) + 1):
        for chosen in itertools.combinations(ways, count):
            for values in itertools.product(*(values for _, values in chosen)):
                row = q.copy()
                row[[k for k, _ in chosen]] = values
                yield row
