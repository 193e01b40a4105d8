"""Shapes that an arm's axes make at every q: spherical joints, parallel axes, and what solves in
closed form.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

from ..groups.arrays import Array
from ..groups.vectors import angular_part
from ..model.chain import Chain
from ..results import Result
from .amounts import amount
from .axis_lines import Tolerances, distance_to_line, line_angle, nearest_point, place

ShapeKind = Literal[
    "spherical wrist",
    "spherical shoulder",
    "spherical joint",
    "three parallel axes",
    "Pieper",
    "S-R-S",
]


@dataclass(frozen=True)
class Shape(Result):
    """Shape that some joints of an arm make together, at every q.

    Attributes
    ----------
    kind : str
        Name of the shape: "spherical wrist", "spherical shoulder", "spherical joint",
        "three parallel axes", "Pieper" or "S-R-S".
    joints : tuple of int
        Numbers of the joints, from 1.
    error : float
        Largest distance of an axis from the common point, m; of parallel axes the largest angle
        between two, rad.
    parallel : bool
        Whether the axes are parallel, else they meet in a point.
    """

    kind: ShapeKind
    joints: tuple[int, ...]
    error: float
    parallel: bool = False

    def summary(self) -> str:
        """Text with the joints, and by how much they miss the shape, in mm and degrees."""
        if self.kind == "S-R-S":
            return "S-R-S: a spherical shoulder, an elbow and a spherical wrist, like a human arm"
        joints = f"joints {', '.join(map(str, self.joints[:-1]))} and {self.joints[-1]}"
        if self.kind == "Pieper":
            why = "three axes are parallel" if self.parallel else "three axes meet in one point"
            end = "so that the inverse kinematics has a closed form"
            return f"Pieper: {joints}: {why}, {end}"
        if self.parallel:
            return f"{joints}: {self.kind} (within {amount(self.error, 'rad', 2)})"
        meet = f"the axes meet in one point (within {amount(self.error, 'm', 2)})"
        return f"{joints}: {self.kind}, {meet}"


def shapes(
    chain: Chain,
    coaxial: Sequence[bool],
    tol: Tolerances,
) -> tuple[Shape, ...]:
    """The shapes of a chain at rest, of whose joints k and k + 1 are coaxial or not.

    Three revolute axes that meet in one point at q = 0 meet at every q, as each turns about a line
    through the point; three parallel axes stay parallel for the same reason. Neighbours along one
    line turn as one joint: with a third axis they make no shape, and an arm of six or seven joints
    that has them is solved by none.
    """
    n = len(chain.kinds)
    revolute = [kind == "revolute" for kind in chain.kinds]
    found: list[Shape] = []
    for i in range(n - 2):
        if not all(revolute[i : i + 3]):
            continue
        numbers = (i + 1, i + 2, i + 3)
        three = chain.screws[i : i + 3]
        angle = _apart(three)
        if angle <= tol.rotation:
            if not any(coaxial[i : i + 2]):
                found.append(Shape("three parallel axes", numbers, angle, parallel=True))
            continue
        miss = _meeting(three)
        # Neighbours along one line leave two axes only, which is no spherical joint.
        least = min(_apart(three[:2]), _apart(three[1:]))
        if miss <= tol.position and least > tol.rotation:
            kind: ShapeKind = "spherical joint"
            if i == n - 3:
                kind = "spherical wrist"
            elif i == 0:
                kind = "spherical shoulder"
            found.append(Shape(kind, numbers, miss))
    if all(revolute) and not any(coaxial):
        return (*found, *_solvable(n, found))
    return tuple(found)


def _solvable(n: int, threes: list[Shape]) -> Iterator[Shape]:
    """Arms of n revolute joints known by three axes that meet or are parallel.

    Four that meet in one point, or are parallel, leave an arm of six joints singular everywhere.
    """
    starts = {shape.joints[0] for shape in threes}
    if n == 6 and threes and not any(start + 1 in starts for start in starts):
        first = min(threes, key=lambda shape: shape.parallel)
        yield Shape("Pieper", first.joints, first.error, first.parallel)
    meeting = (shape for shape in threes if not shape.parallel)
    errors = [shape.error for shape in meeting if shape.joints[0] in (1, 5)]
    if n == 7 and len(errors) == 2:
        yield Shape("S-R-S", tuple(range(1, 8)), max(errors))


def _apart(screws: Array) -> float:
    """The largest angle between any two axes, as lines, in rad."""
    return max(line_angle(a[:3], b[:3]) for a, b in combinations(screws, 2))


def _meeting(screws: Array) -> float:
    """The largest distance in m of the axes from the point that is nearest to all of them."""
    feet = place(screws)
    # Axes almost parallel meet far away, which is of no use: their meeting point stays near.
    point = nearest_point(screws, feet.mean(axis=0), 1e-3)
    lines = zip(feet - point, angular_part(screws), strict=True)
    return max(distance_to_line(gap, w) for gap, w in lines)
