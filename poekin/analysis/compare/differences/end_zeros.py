"""Zero offsets of the first and the last joint, which a turned base or tool says as well."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ...axis_lines import Tolerances
from ..alignment.hypotheses import Hypothesis, still, turn_about
from .matching import Matched


class EndTurn(NamedTuple):
    """A frame, "base" or "tool", that moved by e^{S z} of joint k, the first or the last."""

    frame: str
    k: int
    z: float


def end_turns(
    a: Chain,
    b: Chain,
    reading: Hypothesis,
    tol: Tolerances,
) -> Iterator[EndTurn]:
    """The base or tool of a reading turned about an end joint's axis: zero offsets say the same.

    Axes alone cannot tell the two apart: e^{A z} f(x) = f(x + z) in the first joint.
    """
    if not len(reading.zeros):
        return
    first = a.screws[0] * reading.directions[0]
    last = se3.adjoint(se3.inverse(b.home)) @ b.screws[-1]
    ends = (
        ("base", 0, reading.base, first),
        ("tool", len(b.screws) - 1, reading.tool, last),
    )
    for frame, k, T, S in ends:
        z = turn_about(T, S, tol)
        if z is not None and not still(T, tol):
            yield EndTurn(frame, k, z)


def with_end_zeros(
    pair: Matched,
    reading: Hypothesis,
    tol: Tolerances,
) -> Hypothesis:
    """The reading with a zero offset in place of a base or tool turned about an end joint's axis,
    where that joint's limits have moved by as much.
    """
    for frame, k, z in end_turns(pair.a, pair.b, reading, tol):
        if _limits_say(pair, reading, k, z, tol):
            zeros = reading.zeros.copy()
            offset = reading.offset.copy()
            zeros[k] += z
            offset[k] = True
            stays = {frame: np.eye(4)}
            reading = replace(
                reading,
                zeros=zeros,
                offset=offset,
                frames=reading.frames - 1,
                **stays,
            )
    return reading


def _limits_say(
    pair: Matched,
    reading: Hypothesis,
    k: int,
    z: float,
    tol: Tolerances,
) -> bool:
    """Whether the limits of joint k agree with a further zero offset z, and without it do not."""
    small = tol.rotation
    if pair.b.kinds[k] == "prismatic":
        small = tol.position
    ours = pair.a.limits[k]
    if not np.isfinite(ours).all() or abs(z) <= small:
        return False
    misses = [_apart(pair, reading, k, shift) for shift in (z, 0.0)]
    return bool(misses[0] <= small < misses[1])


def _apart(pair: Matched, reading: Hypothesis, k: int, z: float) -> float:
    theirs: Array = reading.directions[k] * (pair.b.limits[k] - reading.zeros[k] - z)
    return float(abs(np.sort(theirs) - pair.a.limits[k]).max())
