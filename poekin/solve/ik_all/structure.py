"""Families of arms whose inverse kinematics has a closed form: three axes that meet or are parallel."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np

from ...analysis.axis_lines import line_angle, nearest_point, place, sine
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, norm
from ...model.chain_data import ChainData

FamilyKind = Literal["meeting", "parallel"]

MOST_JOINTS = 6
"""Joints up to which an arm has finitely many solutions for a pose."""

_SLANT = 1e-3  # sine below which neighbouring axes turn as one joint, or as parallel ones
_SINGULAR = 1e-5  # rad, and of the reach: four axes that meet or are parallel within this

EXACT = 1e-12
"""Angle, rad, and part of the reach within which axes are parallel, or meet, to rounding."""


@dataclass(frozen=True)
class Family:
    """Three consecutive revolute joints whose axes meet in a point, or are parallel.

    Attributes: kind; first, number of the first of the three joints, from 0; reversed, whether the
    arm is solved from its tip: the three stand nearer to the base than a closed form needs them
    (meeting), or nearer to the tip (parallel).
    """

    kind: FamilyKind
    first: int
    reversed: bool

    @property
    def joints(self) -> tuple[int, int, int]:
        """Numbers of the three joints, from 0."""
        return (self.first, self.first + 1, self.first + 2)


@dataclass(frozen=True)
class Misfit:
    """Family that an arm nearly belongs to, and by how much it misses.

    Attributes: family; angle, the largest between two of the three axes, rad (0 for axes that shall
    meet); distance, the largest of an axis from the point nearest to all three, m (0 for axes that
    shall be parallel); exact, whether nothing but rounding is missed.
    """

    family: Family
    angle: float
    distance: float
    exact: bool


def misfits(chain: ChainData, angle: float, distance: float) -> list[Misfit]:
    """Families that an arm misses by at most an angle, rad, and a distance, m; the best first.

    Four axes that meet in one point, or are parallel, make none.
    """
    every = all_misfits(chain)
    n = len(chain.kinds)
    near = [
        misfit
        for misfit in every
        if misfit.angle <= angle
        and misfit.distance <= distance
        and not _singular(misfit, every, chain.reach)
    ]
    return sorted(near, key=lambda misfit: (not misfit.exact, _rank(misfit.family, n)))


def all_misfits(chain: ChainData) -> list[Misfit]:
    """Families of any three consecutive revolute joints of an arm of up to six, near or not."""
    n = len(chain.kinds)
    if n > MOST_JOINTS:
        return []
    return [
        misfit
        for first in range(n - 2)
        if chain.kinds[first : first + 3] == ("revolute",) * 3
        for misfit in _misfits_at(chain, first)
    ]


def _misfits_at(chain: ChainData, first: int) -> Iterator[Misfit]:
    """Families of the three joints from `first` on: meeting and parallel axes."""
    three = chain.screws[first : first + 3]
    last = len(chain.kinds) - 3
    w = three[:, :3]
    angle = max(line_angle(a, b) for a, b in combinations(w, 2))
    neighbours = min(sine(w[0], w[1]), sine(w[1], w[2]))
    if neighbours > _SLANT:
        point = meeting_point(three)
        off = max(_distance(S, point) for S in three)
        family = Family("meeting", first, first < last - first)
        yield Misfit(family, 0.0, off, off <= EXACT * chain.reach)
    foot = place(three[1])
    apart = min(_distance(three[0], foot), _distance(three[2], foot))
    if apart > _SLANT * chain.reach:
        family = Family("parallel", first, first > last - first)
        yield Misfit(family, angle, 0.0, angle <= EXACT)


def _singular(misfit: Misfit, every: list[Misfit], reach: float) -> bool:
    """Whether four axes meet in one point or are parallel: the arm is singular at every q."""
    family = misfit.family
    alike = (other for other in every if other.family.kind == family.kind)
    four = (other for other in alike if abs(other.family.first - family.first) <= 1)
    close = [_miss(other, reach) <= _SINGULAR for other in four]
    return _miss(misfit, reach) <= _SINGULAR and sum(close) > 1


def _miss(misfit: Misfit, reach: float) -> float:
    """Angle, and distance in reaches, by which a family is missed."""
    return misfit.angle + misfit.distance / reach


def _rank(family: Family, n: int) -> int:
    """Order of families: what is cheaper to solve has less."""
    outer = family.first in (0, n - 3)
    rank = 6
    if family.kind == "meeting" and outer:
        rank = 0
    elif family.kind == "parallel":
        rank = 4 if outer else 2
    return rank + int(family.reversed)


def meeting_point(screws: Array) -> Array:
    """The point (3,) that is nearest to revolute axes (k, 6), in least squares."""
    # Axes almost parallel meet far away: what they leave free stays near.
    return nearest_point(screws, place(screws).mean(axis=0), 1e-3)


def _distance(S: Array, point: Array) -> float:
    """Distance of a point from a revolute axis."""
    return norm(np.cross(angular_part(S), point) + linear_part(S))
