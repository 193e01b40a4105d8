"""Screws of an arm, three of which meet in a point or are parallel, and how they may move."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ....analysis.axis_lines import Marks, place, prismatic
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import directions, dots, normalised
from ....model.chain_data import AnyChain, ChainData
from ..structure import Family, meeting_point


class Motions(NamedTuple):
    """Motions of the axes with p parameters: a turn about a centre, then a shift.

    Attributes: turns (n, 3, p), rad; shifts (n, 3, p), m; centres (n, 3), m.
    """

    turns: Array
    shifts: Array
    centres: Array

    def twists(self) -> Array:
        """Twists (n, 6, p) of the axes, of first order."""
        centres = self.centres[:, :, None]
        about = np.cross(centres, self.turns, axis=1)
        return np.concatenate([self.turns, about + self.shifts], axis=1)


@dataclass(frozen=True, eq=False)
class ConstrainedArm:
    """Axes as directions and points, home pose and pitches; of the family's three axes the points,
    or the directions, are the same to the last bit.

    Attributes: family; slides (n,), whether each joint is prismatic; directions (n, 3), unit;
    points (n, 3), m; pitches (n,), m/rad; home (4, 4).
    """

    family: Family
    slides: Marks
    directions: Array
    points: Array
    pitches: Array
    home: Array

    def screws(self) -> Array:
        """Screws (n, 6) in the base frame."""
        w = self.directions
        along = self.pitches[:, None] * w
        moments = np.cross(self.points, w) + along
        turning = np.concatenate([w, moments], axis=1)
        sliding = np.pad(w, [(0, 0), (3, 0)])
        return np.where(self.slides[:, None], sliding, turning)

    def chain(self, given: AnyChain) -> AnyChain:
        """The chain with these screws and this home pose, everything else as it is."""
        return given.replace(screws=self.screws(), home=self.home, pitches=given.pitches)

    def motions(self) -> Motions:
        """The minimal set of motions that keep the family: four of a free axis (two of a prismatic
        one), nine of three that meet, eight of three that are parallel.
        """
        n = len(self.slides)
        three = list(self.family.joints)
        across = _perpendicular(self.directions)
        single = [[i] for i in range(n)]
        others = [[i] for i in range(n) if i not in three]
        centres = self.points.copy()
        if self.family.kind == "meeting":
            turning = single
            shifting = others
            together = [_only(n, three, u) for u in np.eye(3)]
        else:
            turning = [*others, three]
            shifting = single
            together = []
            centres[three] = self.points[three].mean(axis=0)
        shifting = [group for group in shifting if not self.slides[group[0]]]
        turns = _across(n, turning, across)
        shifts = _across(n, shifting, across) + together
        nothing = np.zeros((n, 3))
        only_turns = turns + [nothing] * len(shifts)
        only_shifts = [nothing] * len(turns) + shifts
        return Motions(np.stack(only_turns, axis=2), np.stack(only_shifts, axis=2), centres)

    def moved(self, motions: Motions, x: Array, home: Array) -> ConstrainedArm:
        """The arm moved by parameters x (p,) and the home pose by a twist (6,) in the tool frame."""
        R = so3.exp(_products(motions.turns, x))
        lever = self.points - motions.centres
        return replace(
            self,
            directions=normalised(_products(R, self.directions[:, None])),
            points=motions.centres + _products(R, lever[:, None]) + _products(motions.shifts, x),
            home=self.home @ se3.exp(home),
        )


def _products(M: Array, x: Array) -> Array:
    """M x, the same for equal rows: BLAS may round them by where they lie in memory."""
    return (M * x).sum(axis=-1)


def rounded_arm(chain: ChainData, family: Family) -> ConstrainedArm:
    """The arm with three axes moved to the point nearest to them, or turned to their mean direction;
    all else stays.
    """
    slides = prismatic(chain)
    w = directions(chain.screws)
    points = place(chain.screws)
    three = list(family.joints)
    if family.kind == "meeting":
        points[three] = meeting_point(chain.screws[three])
    else:
        # the points nearest to each other stay where they are: those of a line in its middle
        points[three] = _nearest_points(w[three], points[three])
        mean = np.linalg.svd(w[three])[2][0]
        reversed_ = w[three] @ mean < 0
        w[three] = np.where(reversed_[:, None], -mean, mean)
    pitches = np.array(chain.pitches)
    return ConstrainedArm(family, slides, w, points, pitches, chain.home.copy())


def _nearest_points(w: Array, points: Array) -> Array:
    """Points of lines that are nearest to the centre of the points given."""
    centre = points.mean(axis=0)
    along = dots(centre - points, w)
    return points + along * w


def _perpendicular(w: Array) -> Array:
    """Two unit vectors (n, 2, 3) that are perpendicular to unit vectors (n, 3), and to each other."""
    smallest = np.argmin(np.abs(w), axis=1)
    least = np.eye(3)[smallest]
    u = normalised(np.cross(w, least))
    v = np.cross(w, u)
    return np.stack([u, v], axis=1)


def _across(n: int, groups: list[list[int]], across: Array) -> list[Array]:
    """Rows (n, 3) for each group of joints: the two directions across the first of them."""
    return [_only(n, group, u) for group in groups for u in across[group[0]]]


def _only(n: int, joints: list[int], u: Array) -> Array:
    """Rows (n, 3) that are u for some joints and 0 for the others."""
    rows = np.zeros((n, 3))
    rows[joints] = u
    return rows
