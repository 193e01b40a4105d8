"""Axes of an arm as lines: their directions, cross products, and the arm at rest."""

from __future__ import annotations

import math

import numpy as np

from ..groups.arrays import Array
from ..model.chain import Chain

POSITION = 1e-5
"""Default of `tol_position`, m: 0.01 mm."""
ROTATION = math.radians(1e-3)
"""Default of `tol_rotation`, rad: 0.001 deg."""

_NEXT = [1, 2, 0]
_LAST = [2, 0, 1]


def cross(x: Array, y: Array) -> Array:
    """x × y over the last axis (..., 3): `numpy.cross` takes four times as long for so few numbers."""
    return x[..., _NEXT] * y[..., _LAST] - x[..., _LAST] * y[..., _NEXT]


def direction(axes: Array, kinds: tuple[str, ...]) -> Array:
    """Unit directions (n, 3) of axes of these kinds."""
    return np.where((np.array(kinds) == "prismatic")[:, None], axes[:, 3:], axes[:, :3])


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
