"""Six joints that an arm is part of, and the three of them by which they are solved.

An arm of n < 6 joints is one of six of which 6 - n stay at 0. Joints are added so that three axes
meet or are parallel. Between two axes that meet the added one is across both, between two that are
parallel it is the apex of a triangle: the angles at 0 are clear of any double root then, whatever
the other joints do. What is left for the position is added at the end of the arm, prismatic.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ....engine.kernels.branches.closed_arm import PARALLEL, WRIST
from ....groups.arrays import Array
from ....groups.vectors import norm
from .joints import LoopJoint, Tolerance, across, meeting_point, parallel, planar

# Shares of the reach, along an axis and of points: any that nothing else is at.
_ALONG = (0.37, -0.61)
_PLACES = ((0.41, -0.29, 0.53), (-0.33, 0.47, 0.21), (0.17, 0.59, -0.43))
# Directions square to each other and askew to everything: arms are drawn, and posed, at right angles.
_ASKEW = ((0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6))
_SLANTED = (0.28, -0.576, 0.768)


class Completion(NamedTuple):
    """Six joints in a loop, of which those from `first` on are a wrist or parallel; and in words."""

    joints: list[LoopJoint]
    first: int
    family: int
    words: str


def completions(
    joints: Sequence[LoopJoint],
    reach: float,
    tolerance: Tolerance,
) -> Iterator[Completion]:
    """All ways in which an arm of up to six joints is solved, those with fewer added joints in the
    three axes first.
    """
    n = len(joints)
    room = 6 - n
    for made_of in (3, 2, 1):
        if 3 - made_of <= room:
            for i in reversed(range(n - made_of + 1)):
                yield from _wrists(joints, i, made_of, reach, tolerance)
                yield from _parallels(joints, i, made_of, reach, tolerance)
    place = _generic_point(joints, reach, _PLACES[0])
    wrist = [_turns(e, place) for e in np.array(_ASKEW)]
    yield from _filled([*joints, *wrist], n, "a point of the tip")


def _wrists(
    joints: Sequence[LoopJoint],
    i: int,
    made_of: int,
    reach: float,
    tolerance: Tolerance,
) -> Iterator[Completion]:
    """Completions to a wrist of the joints from i on."""
    group = list(joints[i : i + made_of])
    before = list(joints[:i])
    behind = list(joints[i + made_of :])
    if made_of == 1:
        joint = joints[i]
        if joint.slides:
            return
        h = joint.direction
        for share in _ALONG:
            place = joint.point + share * reach * h
            own = joint._replace(point=place)
            u = across(h)
            wrist = [own, _turns(u, place), _turns(np.cross(h, u), place)]
            words = f"a point of axis {i + 1}"
            yield from _filled([*before, *wrist, *behind], i, words)
        return
    place = meeting_point(group, tolerance)
    if place is None:
        return
    wrist = [joint._replace(point=place) for joint in group]
    words = f"axes {_listed(i, made_of)} meet"
    if made_of == 2:
        first, second = group
        normal = np.cross(first.direction, second.direction)
        wrist.insert(1, _turns(normal / norm(normal), place))
    else:
        words = f"spherical wrist: {words}"
    yield from _filled([*before, *wrist, *behind], i, words)


def _parallels(
    joints: Sequence[LoopJoint],
    i: int,
    made_of: int,
    reach: float,
    tolerance: Tolerance,
) -> Iterator[Completion]:
    """Completions to three parallel axes of the joints from i on, the other three revolute."""
    group = list(joints[i : i + made_of])
    others = [*joints[:i], *joints[i + made_of :]]
    if made_of == 1 or any(joint.slides for joint in others):
        return
    words = f"axes {_listed(i, made_of)} are parallel"
    if made_of == 3 and len(joints) == 6 and planar(group, tolerance):
        words = f"joints {_listed(i, made_of)} move in a plane"
    elif not parallel(group, tolerance):
        return
    if made_of == 2:
        a, b = group
        gap = b.point - a.point
        way = np.cross(a.direction, np.cross(gap, a.direction))
        aside = np.cross(a.direction, way)
        apex = a.point + 0.5 * way + 0.5 * aside
        group.insert(1, _turns(a.direction, apex))
    six = [*joints[:i], *group, *joints[i + made_of :]]
    short = 6 - len(six)
    directions = np.array((*_ASKEW, _SLANTED))
    for chosen in combinations(directions, short):
        added = [
            _turns(h, _generic_point(joints, reach, share))
            for h, share in zip(chosen, _PLACES, strict=False)
        ]
        yield Completion([*six, *added], i, PARALLEL, words)


def _filled(
    six: list[LoopJoint],
    first: int,
    words: str,
) -> Iterator[Completion]:
    """Completions of joints with a wrist to six, by prismatic joints at the end; none of more."""
    short = 6 - len(six)
    if short < 0:
        return
    directions = np.array((*_ASKEW, _SLANTED))
    if short == 3:
        directions = directions[:3]
    for chosen in combinations(directions, short):
        place = six[-1].point
        added = [LoopJoint(d, place, True) for d in chosen]
        yield Completion([*six, *added], first, WRIST, words)


def _turns(direction: Array, point: Array) -> LoopJoint:
    return LoopJoint(direction, point, False)


def _generic_point(
    joints: Sequence[LoopJoint],
    reach: float,
    share: Sequence[float],
) -> Array:
    """A point that lies on no axis but by chance."""
    return joints[-1].point + reach * np.array(share)


def _listed(i: int, count: int) -> str:
    """The numbers of joints, from 1: "4, 5 and 6"."""
    *numbers, last = (str(k + 1) for k in range(i, i + count))
    return f"{', '.join(numbers)} and {last}"
