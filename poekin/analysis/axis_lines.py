"""Axes of an arm as lines: their directions, places and distances, and the arm at rest."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..groups.arrays import Array
from ..model.chain import Chain

Marks = NDArray[np.bool_]

POSITION = 1e-5
"""Default of `tol_position`, m: 0.01 mm."""
ROTATION = math.radians(1e-3)
"""Default of `tol_rotation`, rad: 0.001 deg."""

_NEXT = [1, 2, 0]
_LAST = [2, 0, 1]


class Tolerances(NamedTuple):
    """Largest position (m) and rotation (rad) that make no difference."""

    position: float
    rotation: float


def cross(x: Array, y: Array) -> Array:
    """x × y over the last axis (..., 3): `numpy.cross` takes four times as long for so few numbers."""
    return x[..., _NEXT] * y[..., _LAST] - x[..., _LAST] * y[..., _NEXT]


def prismatic(chain: Chain) -> Marks:
    """Whether each joint is prismatic (n)."""
    return np.array([kind == "prismatic" for kind in chain.kinds], bool)


def direction(axes: Array, slides: Marks) -> Array:
    """Unit directions (n, 3) of axes, some of which are those of prismatic joints."""
    return np.where(slides[:, None], axes[:, 3:], axes[:, :3])


def place(axes: Array) -> Array:
    """Points (..., 3) of axes (..., 6) that are nearest to the origin."""
    return cross(axes[..., :3], axes[..., 3:])


def distance_to_line(gap: Array, w: Array) -> float:
    """Distance (m) of a point from a line along w, `gap` from a point of the line."""
    return float(np.linalg.norm(gap - w * (w @ gap)))


def normal_length(w: Array, u: Array, gap: Array) -> float:
    """Length (m) of the common normal of lines along w and u that are not parallel, `gap` between
    them.
    """
    across = cross(w, u)
    return abs(float(gap @ across)) / float(np.linalg.norm(across))


def uncoupled_at_zero(chain: Chain) -> Chain:
    """The chain with every joint its own coordinate x, x = 0 where q = 0, and limits where one
    coordinate sets them.
    """
    C = chain.coupling
    if np.array_equal(C, np.eye(len(C))) and not chain.offset.any():
        return chain
    limits = np.tile([-np.inf, np.inf], (len(C), 1))
    for i, row in enumerate(C):
        (ks,) = np.nonzero(row)
        if len(ks) == 1:
            limits[i] = np.sort(row[ks[0]] * chain.limits[ks[0]]) + chain.offset[i]
    bare = Chain.from_space(
        chain.screws,
        chain.home,
        joint_names=chain.joint_names,
        limits=limits,
        base=chain.base,
        tip=chain.tip,
        pitches=chain.pitches,
    )
    if chain.offset.any():
        return bare.rezeroed(chain.offset)
    return bare
