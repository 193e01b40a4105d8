"""Millimetres where metres are due, degrees for radians: detected by what they would explain, never
converted.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.sampling import angle_mask
from ..fit.fitting import fit_frames
from ..model.problem import Problem

LARGE = 0.1  # reaches: a nominal arm is off by millimetres
_BETTER = 4.0  # how many times better the other unit has to explain the data
_TURN = 2.0 * np.pi


class Units(NamedTuple):
    """Other units in words, and factors of readings that are angles, of those that are lengths, and
    of measured lengths.
    """

    words: str
    angle: float = 1.0
    slide: float = 1.0
    length: float = 1.0


_DEGREES = Units(
    "the joint angles look like degrees: give radians (numpy.deg2rad)",
    angle=_TURN / 360.0,
)
TRIES = (
    Units(
        "the lengths look like millimetres: give metres (divide by 1000)",
        length=1e-3,
    ),
    _DEGREES,
    Units(
        "the readings of sliding joints look like millimetres: give metres (divide by 1000)",
        slide=1e-3,
    ),
    Units(
        "all lengths look like millimetres, those of sliding joints, too: give metres (divide by "
        "1000)",
        slide=1e-3,
        length=1e-3,
    ),
    Units(
        "the lengths look like millimetres and the joint angles like degrees: give metres and "
        "radians",
        angle=_DEGREES.angle,
        length=1e-3,
    ),
)


def check(problem: Problem, p: Array) -> None:
    """Refuse data that another unit explains much better.

    Raises: InputError that says which and by how much, where the nominal arm is off by more than a
    tenth of its reach.
    """
    off = problem.residuals(p).median_length
    arm = problem.model.nominal
    largest = np.abs(problem.q).max(initial=0.0)
    if off <= LARGE * arm.reach and largest <= 4 * _TURN:
        return
    # in the units as they stand: whatever the model, lengths made a thousandth are off by a
    # thousandth
    found = {units: _tried(problem, units) / units.length for units in TRIES}
    best = min(found, key=found.__getitem__)
    if found[best] * _BETTER < off:
        raise InputError(
            f"the nominal arm is off by {off:.3g} m (median) as the data stand, and by "
            f"{found[best] * best.length:.3g} m where {best.words}"
        )


def converted(chain: Chain, q: Array, units: Units) -> Array:
    """Readings (N, m) in other units."""
    return q * np.where(angle_mask(chain), units.angle, units.slide)


def _tried(problem: Problem, units: Units) -> float:
    """The median distance in these units; frames that are not given are estimated anew."""
    sets = [s.scaled(units.length) for s in problem.sets]
    q = converted(problem.model.nominal, problem.q, units)
    try:
        other = Problem(problem.model, q, sets)
    except InputError:
        return np.inf
    p = fit_frames(other, "huber")
    return other.residuals(p).median_length
