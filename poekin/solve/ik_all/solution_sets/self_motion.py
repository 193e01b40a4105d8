"""Continua of solutions: which coordinates move along them, and which way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ...joint_units import JointUnits
from .places import Places

_NULL = 1e-9  # of the largest singular value: solutions of a continuum are known to rounding
_ALONG = 0.5  # of the step: of less it does not go that way


class SelfMotion(NamedTuple):
    """Continuum of solutions of one target: names of the coordinates that move along it, and a step
    (m,) along it from the solution that is listed, in joint units.
    """

    names: tuple[str, ...]
    step: Array


def directions(
    units: JointUnits,
    free: np.ndarray,
    places: Places,
    moving: Mapping[int, SelfMotion],
) -> dict[int, Array]:
    """Unit vectors (m,) along which solutions go on, by the solution's number among all places;
    `moving` are the continua by number of the target.
    """
    found = {}
    for target, motion in moving.items():
        first, end = np.searchsorted(places.owner, [target, target + 1]).tolist()
        for row in range(first, end):
            u = units.of(places.q[row])
            J = units.fast.chain.jacobian(u, frame="hybrid")[:, free]
            way = _null_vector(J, motion.step[free])
            if way is not None:
                found[row] = _coordinates(units, free, way)
    return found


def _null_vector(J: Array, step: Array) -> Array | None:
    """The part of a step that a Jacobian (6, m) takes to zero, None where that is little of it."""
    _, sizes, V = np.linalg.svd(J)
    lost = V[: len(sizes)][sizes < _NULL * sizes[0]]
    way = (lost @ step) @ lost
    if np.linalg.norm(way) < _ALONG * np.linalg.norm(step):
        return None
    return way


def _coordinates(units: JointUnits, free: np.ndarray, way: Array) -> Array:
    """Unit vector of the user's coordinates."""
    whole = np.zeros(len(free))
    whole[free] = way
    if units.scale is not None:
        whole = np.linalg.solve(units.scale, whole)
    return whole / np.linalg.norm(whole)
