"""Intervals of a path: the points between which something holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ..ik.diagnosis import AT_LIMIT


@dataclass(frozen=True, order=True)
class PathInterval:
    """Points of a path between which something holds.

    Attributes
    ----------
    first, last : int
        Numbers of the first and the last point.
    name : str
        Name of the coordinate or joint; "" for all of them together.
    worst : int
        Number of the worst point.
    value : float
        Value there.
    bound : float
        Number with which it is compared.
    """

    first: int
    last: int
    name: str
    worst: int
    value: float
    bound: float


def intervals(
    mask: np.ndarray,
    values: Array,
    badness: Array,
    bound: float = 0.0,
    name: str = "",
    shift: int = 0,
) -> list[PathInterval]:
    """Interval for each run of True, shifted; the worst point of it is where the badness is
    largest.
    """
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False))
    found = []
    for first, end in edges.reshape(-1, 2).tolist():
        worst = first + int(np.argmax(badness[first:end]))
        interval = PathInterval(
            first=first + shift,
            last=end - 1 + shift,
            name=name,
            worst=worst + shift,
            value=float(values[worst]),
            bound=float(bound),
        )
        found.append(interval)
    return found


def intervals_at_limits(x: Array, limits: Array, names: Sequence[str]) -> tuple[PathInterval, ...]:
    """Intervals in which one of the values (N, k) is at one of its limits (k, 2)."""
    found = []
    for values, bounds, name in zip(x.T, limits, names, strict=True):
        for bound in bounds:
            off = np.abs(values - bound)
            found += intervals(off <= AT_LIMIT, values, -off, bound, name)
    return tuple(sorted(found))


def limits_of_joints(chain: Chain) -> Array | None:
    """Limits (n, 2) of the joints' own values, rad or m; None where there are none."""
    return chain.joint_limits if np.isfinite(chain.joint_limits).any() else None
