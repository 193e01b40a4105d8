"""Shapes that an arm's axes make at every q: spherical joints, parallel axes, and what solves in
closed form.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..groups.arrays import Array
from ..model.chain import Chain
from .compare.alignment.lines import cross

__all__ = ["Shape", "shapes"]


@dataclass(frozen=True)
class Shape:
    """Something that some joints of an arm make together.

    Attributes: kind ("spherical wrist", "spherical shoulder", "spherical joint", "three parallel
    axes", "Pieper", "S-R-S"); joints, their numbers from 1; error, by how much they miss it: mm
    that axes pass their common point by, or deg from parallel; words.
    """

    kind: str
    joints: tuple[int, ...]
    error: float
    words: str


def shapes(chain: Chain, tol_mm: float, tol_deg: float) -> tuple[Shape, ...]:
    """The shapes of a chain at rest.

    Three revolute axes that meet in one point at q = 0 meet at every q, as each turns about a line
    through the point; three parallel axes stay parallel for the same reason. Three that lie along
    one another are neither.
    """
    n = len(chain.kinds)
    revolute = [kind == "revolute" for kind in chain.kinds]
    found: list[Shape] = []
    spherical = []
    parallel = []
    for i in range(n - 2):
        if not all(revolute[i : i + 3]):
            continue
        numbers = (i + 1, i + 2, i + 3)
        three = chain.screws[i : i + 3]
        off = _apart(three)
        if off <= tol_deg:
            parallel.append(i)
            words = f"joints {_list(numbers)}: three parallel axes (within {off:.2g}°)"
            found.append(Shape("three parallel axes", numbers, off, words))
            continue
        miss = _meeting(three)
        # Neighbours along one line leave two axes only, which is no spherical joint.
        if miss <= tol_mm and min(_apart(three[:2]), _apart(three[1:])) > tol_deg:
            spherical.append(i)
            kind = "spherical joint"
            if i == n - 3:
                kind = "spherical wrist"
            elif i == 0:
                kind = "spherical shoulder"
            meet = f"the axes meet in one point (within {miss:.2g} mm)"
            words = f"joints {_list(numbers)}: {kind}, {meet}"
            found.append(Shape(kind, numbers, miss, words))
    return (*found, *_solvable(n, all(revolute), spherical, parallel))


def _solvable(
    n: int, all_revolute: bool, spherical: list[int], parallel: list[int]
) -> Iterator[Shape]:
    """Arms of n joints known by three axes that meet or are parallel, told by the first of each."""
    if n == 6 and all_revolute and (spherical or parallel):
        why = "three axes are parallel"
        if spherical:
            why = "three axes meet in one point"
        first = (spherical or parallel)[0]
        numbers = (first + 1, first + 2, first + 3)
        words = (
            f"Pieper: joints {_list(numbers)}: {why}, so that the inverse "
            "kinematics has a closed form"
        )
        yield Shape("Pieper", numbers, 0.0, words)
    if n == 7 and all_revolute and 0 in spherical and 4 in spherical:
        words = "S-R-S: a spherical shoulder, an elbow and a spherical wrist, like a human arm"
        yield Shape("S-R-S", tuple(range(1, 8)), 0.0, words)


def _apart(screws: Array) -> float:
    """The largest angle between any two axes, as lines, in deg."""
    return max(
        math.degrees(
            math.atan2(float(np.linalg.norm(cross(a[:3], b[:3]))), abs(float(a[:3] @ b[:3])))
        )
        for i, a in enumerate(screws)
        for b in screws[i + 1 :]
    )


def _meeting(screws: Array) -> float:
    """The largest distance in mm of the axes from the point that is nearest to all of them."""
    feet = cross(screws[:, :3], screws[:, 3:])
    across = np.eye(3) - screws[:, :3, None] * screws[:, None, :3]
    start = feet.mean(axis=0)
    right = (across @ (feet - start)[:, :, None]).reshape(-1)
    # Axes almost parallel meet far away, which is of no use: their meeting point stays near.
    point = start + np.linalg.lstsq(across.reshape(-1, 3), right, rcond=1e-3)[0]
    return 1e3 * float(np.linalg.norm((across @ (feet - point)[:, :, None])[:, :, 0], axis=1).max())


def _list(numbers: tuple[int, ...]) -> str:
    return f"{', '.join(map(str, numbers[:-1]))} and {numbers[-1]}"
