"""A chain of turning joints as directions H and steps P, the form of the closed solvers (EAIK,
IK-Geo, ssik).
"""

from __future__ import annotations

from decimal import Decimal
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...algebra import add, cross, scale, subtract
from ...errors import InputError, quote
from ...groups.arrays import Array
from ...groups.vectors import angular_part, rotation_part, translation_part
from ..chain_data import ChainData
from .normals import (
    BASE,
    Vector,
    axis_near,
    common_normal,
    digits,
    exact,
    length,
    nearest_on_line,
)
from .other_frames import without_offset

MEETING = Decimal("1e-14")
"""Axes meet that pass each other within this many times the chain's reach, the rounding of their
numbers.
"""

SLANT = Decimal("0.01")
"""The sine of the angle below which two axes are not taken to meet: their point would be too far to
be known well.
"""


class HPForm(NamedTuple):
    """Directions and steps: f(q) = (E_n R_nt, P_0 + E_1 P_1 + ... + E_n P_n).

    E_i = e^{[h_1] q_1} ... e^{[h_i] q_i}.

    Attributes
    ----------
    H : (n, 3) ndarray
        Unit directions h_i of the axes in the base frame at q = 0.
    P : (n + 1, 3) ndarray
        Steps from the base's origin to a point of the first axis, from there to a point of the
        second, ..., and to the tip, in base axes at q = 0, m.
    R_nt : (3, 3) ndarray
        Rotation of the tip at q = 0.
    """

    H: Array
    P: Array
    R_nt: Array


def to_hp(chain: ChainData) -> HPForm:
    """Directions H (n, 3), steps P (n + 1, 3) and the tip's rotation R_nt (3, 3)."""
    for name, kind in zip(chain.joint_names, chain.kinds, strict=True):
        if kind != "revolute":
            raise InputError(f"to_hp: expected revolute joints only, {quote(name)} is {kind}")
    if chain.nontrivial_coupling is not None:
        raise InputError(
            f"to_hp: expected one coordinate a joint, the {len(chain.kinds)} joints of {quote(chain.base)} -> "
            f"{quote(chain.tip)} are coupled to {chain.dof} coordinates"
        )
    chain = without_offset(chain)
    with digits():
        points = [BASE.o, *_points(chain), exact(translation_part(chain.home))]
        steps = [[float(x) for x in subtract(b, a)] for a, b in pairwise(points)]
    return HPForm(
        angular_part(chain.screws).copy(),
        np.array(steps),
        rotation_part(chain.home).copy(),
    )


def _points(chain: ChainData) -> list[Vector]:
    """One point of each axis, those of axes that meet the same."""
    lines = [axis_near(S, False, BASE.o) for S in chain.screws]
    shared: dict[int, Vector] = {}
    for run in _meetings(lines, MEETING * Decimal(chain.reach)):
        joints = range(run.first, run.last + 1)
        if not any(i in shared for i in joints):
            shared.update(dict.fromkeys(joints, run.point))
    points = []
    last = BASE.o
    for i, (z, p) in enumerate(lines):
        if i in shared:
            last = shared[i]
        else:
            last = nearest_on_line(p, z, last)
        points.append(last)
    return points


class _Meeting(NamedTuple):
    """A run of axes that meet in a point, from the first to the last."""

    first: int
    last: int
    point: Vector


def _meetings(lines: list[tuple[Vector, Vector]], near: Decimal) -> list[_Meeting]:
    """All runs of axes that meet, those that have precedence first."""
    found = []
    for first, ((z, p), (z2, p2)) in enumerate(pairwise(lines)):
        if length(cross(z, z2)) < SLANT:
            continue
        normal = common_normal(p, z, p2, z2)
        point = add(normal.foot, scale(normal.a / 2, normal.x))
        last = first
        while last + 1 < len(lines) and _distance(point, lines[last + 1]) <= near:
            last += 1
        if last > first:
            found.append(_Meeting(first, last, point))
    return sorted(found, key=lambda run: (run.last - run.first, run.last), reverse=True)


def _distance(point: Vector, line: tuple[Vector, Vector]) -> Decimal:
    """Distance of a point from a line (direction, point)."""
    z, p = line
    return length(cross(subtract(point, p), z))
