"""Screws of an arm, three of which meet in a point or are parallel, and how they may move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups import se3, so3
from ....groups.arrays import Array
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
        about = np.cross(self.centres[:, :, None], self.turns, axis=1)
        return np.concatenate([self.turns, about + self.shifts], axis=1)


@dataclass(frozen=True, eq=False)
class ConstrainedArm:
    """Axes as directions and points, home pose and pitches; of the family's three axes the points,
    or the directions, are the same to the last bit.

    Attributes: family; slides (n,), whether each joint is prismatic; directions (n, 3), unit;
    points (n, 3), m; pitches (n,), m/rad; home (4, 4).
    """

    family: Family
    slides: NDArray[np.bool_]
    directions: Array
    points: Array
    pitches: Array
    home: Array

    def screws(self) -> Array:
        """Screws (n, 6) in the base frame."""
        w = self.directions
        moments = np.cross(self.points, w) + self.pitches[:, None] * w
        turning = np.concatenate([w, moments], axis=1)
        sliding = np.concatenate([np.zeros_like(w), w], axis=1)
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
        turns: list[Array] = []
        shifts: list[Array] = []
        meeting = self.family.kind == "meeting"
        own_turns = [[i] for i in range(n) if meeting or i not in three]
        own_shifts = [[i] for i in range(n) if not (self.slides[i] or (meeting and i in three))]
        if not meeting:
            own_turns.append(three)
        for group in own_turns:
            turns += [_only(n, group, u) for u in across[group[0]]]
        for group in own_shifts:
            shifts += [_only(n, group, u) for u in across[group[0]]]
        if meeting:
            shifts += [_only(n, three, u) for u in np.eye(3)]
        centres = self.points.copy()
        if not meeting:
            centres[three] = self.points[three].mean(axis=0)
        nothing = np.zeros((n, 3))
        return Motions(
            np.stack(turns + [nothing] * len(shifts), axis=2),
            np.stack([nothing] * len(turns) + shifts, axis=2),
            centres,
        )

    def moved(self, motions: Motions, x: Array, home: Array) -> ConstrainedArm:
        """The arm moved by parameters x (p,) and the home pose by a twist (6,) in the tool frame."""
        R = so3.exp(motions.turns @ x)
        w = (R @ self.directions[:, :, None])[..., 0]
        lever = self.points - motions.centres
        points = motions.centres + (R @ lever[:, :, None])[..., 0] + motions.shifts @ x
        return ConstrainedArm(
            self.family,
            self.slides,
            w / np.linalg.norm(w, axis=1, keepdims=True),
            points,
            self.pitches,
            self.home @ se3.exp(home),
        )


def rounded_arm(chain: ChainData, family: Family) -> ConstrainedArm:
    """The arm with three axes moved to the point nearest to them, or turned to their mean direction;
    all else stays.
    """
    slides = np.array([kind == "prismatic" for kind in chain.kinds])
    turning = chain.screws[:, :3]
    w = np.where(slides[:, None], chain.screws[:, 3:], turning)
    points = np.cross(turning, chain.screws[:, 3:])
    three = list(family.joints)
    if family.kind == "meeting":
        points[three] = meeting_point(chain.screws[three])
    else:
        # the points nearest to each other stay where they are: those of a line in its middle
        points[three] = _nearest_points(w[three], points[three])
        mean = np.linalg.svd(w[three])[2][0]
        w[three] = np.where((w[three] @ mean)[:, None] < 0, -mean, mean)
    return ConstrainedArm(family, slides, w, points, np.array(chain.pitches), chain.home.copy())


def _nearest_points(w: Array, points: Array) -> Array:
    """Points of lines that are nearest to the centre of the points given."""
    centre = points.mean(axis=0)
    along = ((centre - points) * w).sum(axis=1, keepdims=True)
    return points + along * w


def _perpendicular(w: Array) -> Array:
    """Two unit vectors (n, 2, 3) that are perpendicular to unit vectors (n, 3), and to each other."""
    least = np.eye(3)[np.argmin(np.abs(w), axis=1)]
    u = np.cross(w, least)
    u = np.asarray(u / np.linalg.norm(u, axis=1, keepdims=True), np.float64)
    return np.stack([u, np.cross(w, u)], axis=1)


def _only(n: int, joints: list[int], u: Array) -> Array:
    """Rows (n, 3) that are u for some joints and 0 for the others."""
    rows = np.zeros((n, 3))
    rows[joints] = u
    return rows
