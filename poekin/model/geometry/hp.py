"""A chain of turning joints as directions H and steps P, the form of the closed solvers (EAIK,
IK-Geo, ssik).
"""

from __future__ import annotations

from decimal import Decimal
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...errors import InputError, quote
from ...groups.arrays import Array
from .normals import Vector, axis_near, common_normal, digits, exact, length

if TYPE_CHECKING:
    from ..chain import Chain

MEETING = Decimal("1e-14")
"""Axes meet that pass each other within this many times the chain's reach, the rounding of their
numbers.
"""

SLANT = Decimal("0.01")
"""The sine of the angle below which two axes are not taken to meet: their point would be too far to
be known well.
"""


class HPForm(NamedTuple):
    """f(q) = (E_n R_nt, P_0 + E_1 P_1 + ... + E_n P_n) with E_i = e^{[h_1] q_1} ... e^{[h_i] q_i}.

    H (n, 3): unit directions h_i of the axes in the base frame at q = 0. P (n + 1, 3): the steps
    from the base's origin to a point of the first axis, from there to a point of the second, ...,
    and to the tip, in base axes at q = 0, m. R_nt (3, 3): the rotation of the tip at q = 0.
    """

    H: Array
    P: Array
    R_nt: Array


def to_hp(self: Chain) -> HPForm:
    """The chain as directions H (n, 3), steps P (n + 1, 3) and the tip's rotation R_nt (3, 3), in q
    itself.

    EAIK's `HPRobot(H, P)` takes H and P as they are, and so do IK-Geo and ssik as rows; the pose
    that they solve for has the rotation R_st R_nt^T. Base and tool are part of P, zero offsets of
    all three.
    The points are chosen so that steps that can be zero are zero to the last bit: axes that meet
    share their point (three in a row and more before two, towards the tip before towards the base),
    and an axis that meets none has its point nearest to the one before. A step between parallel
    axes is so perpendicular to them.

    Returns: HPForm, in the order of `q_names`.
    Raises: InputError where a joint is not revolute, or joints are coupled.
    Accuracy: a point is within 1e-14 reach of its axis, so the pose within 4e-14 n reach of `fk`
    (tests/model/geometry/test_hp.py).
    Source: Elias and Wen, IK-Geo (arXiv 2211.05737), Section II, for the form; the points are
    poekin's choice.
    """
    for name, kind in zip(self.joint_names, self.kinds, strict=True):
        if kind != "revolute":
            raise InputError(f"to_hp: expected revolute joints only, {quote(name)} is {kind}")
    if self._coupling is not None:
        raise InputError(
            f"to_hp: expected one coordinate a joint, the {len(self.kinds)} joints of {quote(self.base)} -> "
            f"{quote(self.tip)} are coupled to {self.dof} coordinates"
        )
    zero = (
        self._with(offset=np.zeros(self.dof)).rezeroed(self.offset) if self.offset.any() else self
    )
    with digits():
        points = [exact((0.0, 0.0, 0.0)), *_points(zero), exact(zero.home[:3, 3])]
        steps = [[float(x) for x in subtract(b, a)] for a, b in pairwise(points)]
    return HPForm(zero.screws[:, :3].copy(), np.array(steps), zero.home[:3, :3].copy())


def _points(chain: Chain) -> list[Vector]:
    """One point of each axis, those of axes that meet the same."""
    origin, near = exact((0.0, 0.0, 0.0)), MEETING * Decimal(chain.reach)
    lines = [axis_near(S, False, origin) for S in chain.screws]
    shared: dict[int, Vector] = {}
    for first, last, point in _meetings(lines, near):
        if not any(i in shared for i in range(first, last + 1)):
            shared.update(dict.fromkeys(range(first, last + 1), point))
    points = [origin]
    for i, (z, p) in enumerate(lines):
        points.append(
            shared[i] if i in shared else add(p, scale(dot(subtract(points[-1], p), z), z))
        )
    return points[1:]


def _meetings(lines: list[tuple[Vector, Vector]], near: Decimal) -> list[tuple[int, int, Vector]]:
    """First axis, last axis and point of all runs of axes that meet, those that have precedence
    first.
    """
    found = []
    for first in range(len(lines) - 1):
        (z, p), (z2, p2) = lines[first : first + 2]
        if length(cross(z, z2)) < SLANT:
            continue
        normal = common_normal(p, z, p2, z2)
        point = add(normal.foot, scale(normal.a / 2, normal.x))
        last = first
        while last + 1 < len(lines) and _distance(point, lines[last + 1]) <= near:
            last += 1
        if last > first:
            found.append((first, last, point))
    return sorted(found, key=lambda run: (run[1] - run[0], run[1]), reverse=True)


def _distance(point: Vector, line: tuple[Vector, Vector]) -> Decimal:
    """How far a point is from a line (direction, point)."""
    z, p = line
    return length(cross(subtract(point, p), z))
