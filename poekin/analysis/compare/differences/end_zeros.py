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
    for end in _moved_ends(a, b, reading, tol):
        z = turn_about(end.T, end.S, tol)
        if z is not None:
            yield EndTurn(end.frame, end.k, z)


def with_end_zeros(
    pair: Matched,
    reading: Hypothesis,
    tol: Tolerances,
) -> Hypothesis:
    """The reading with a zero offset of an end joint where the base or tool has moved and this
    joint's limits say so: in place of a turn about its axis, or beside another motion.
    """
    for end in _moved_ends(pair.a, pair.b, reading, tol):
        if not np.isfinite([pair.a.limits[end.k], pair.b.limits[end.k]]).all():
            continue
        z = turn_about(end.T, end.S, tol)
        stays = np.eye(4)
        if z is None:
            z = _shift_of_limits(pair, reading, end.k)
            stays = se3.exp(-z * end.S) @ end.T
        if _limits_say(pair, reading, end.k, z, tol):
            zeros = reading.zeros.copy()
            offset = reading.offset.copy()
            zeros[end.k] += z
            offset[end.k] = True
            reading = replace(reading, zeros=zeros, offset=offset, **{end.frame: stays})
    return reading


class _End(NamedTuple):
    """A frame, "base" or "tool", that moved by T beside joint k, the first or the last, of screw
    S.
    """

    frame: str
    k: int
    T: Array
    S: Array


def _moved_ends(
    a: Chain,
    b: Chain,
    reading: Hypothesis,
    tol: Tolerances,
) -> list[_End]:
    if not len(reading.zeros):
        return []
    first = a.screws[0] * reading.directions[0]
    last = se3.adjoint(se3.inverse(b.home)) @ b.screws[-1]
    ends = [
        _End("base", 0, reading.base, first),
        _End("tool", len(b.screws) - 1, reading.tool, last),
    ]
    return [end for end in ends if not still(end.T, tol)]


def _shift_of_limits(pair: Matched, reading: Hypothesis, k: int) -> float:
    """The zero offset of joint k, beside the reading's, with which its middle is a's."""
    theirs = (pair.b.limits[k] - reading.zeros[k]).mean()
    return float(theirs - reading.directions[k] * pair.a.limits[k].mean())


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
    if abs(z) <= small:
        return False
    misses = [_apart(pair, reading, k, shift) for shift in (z, 0.0)]
    return bool(misses[0] <= small < misses[1])


def _apart(pair: Matched, reading: Hypothesis, k: int, z: float) -> float:
    theirs: Array = reading.directions[k] * (pair.b.limits[k] - reading.zeros[k] - z)
    return float(abs(np.sort(theirs) - pair.a.limits[k]).max())
