"""Millimetres where metres are due, degrees for radians: detected by what they would explain, never
converted.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ..fit.fitting import fit_frames
from ..measurements.measurement import Measurement
from ..model.error_model import ErrorModel
from ..model.problem import Problem

LARGE = 0.1  # reaches: a nominal arm is off by millimetres
_BETTER = 4.0  # how many times better the other unit has to explain the data
_TURN = 2.0 * np.pi
_DEGREE = _TURN / 360.0
_LENGTHS = "the lengths look like millimetres: give metres (divide by 1000)"
_SLIDES = "the readings of sliding joints look like millimetres: give metres (divide by 1000)"
_DEGREES = "the joint angles look like degrees: give radians (numpy.deg2rad)"
_ALL_LENGTHS = (
    "all lengths look like millimetres, those of sliding joints, too: give metres (divide by 1000)"
)
_BOTH = (
    "the lengths look like millimetres and the joint angles like degrees: give metres and radians"
)


class Units(NamedTuple):
    """Readings, and the factor of measured lengths."""

    q: Array
    length: float


def check(problem: Problem, p: Array) -> None:
    """Refuse data that another unit explains much better.

    Raises: InputError that says which and by how much, where the nominal arm is off by more than a
    tenth of its reach.
    """
    off = problem.residuals(p).median_length
    arm = problem.model.nominal
    if off <= LARGE * arm.reach and np.abs(problem.q).max(initial=0.0) <= 4 * _TURN:
        return
    in_degrees = converted(arm, problem.q, angle=_DEGREE)
    in_millimetres = converted(arm, problem.q, length=1e-3)
    tries = {
        _LENGTHS: Units(problem.q, 1e-3),
        _DEGREES: Units(in_degrees, 1.0),
        _SLIDES: Units(in_millimetres, 1.0),
        _ALL_LENGTHS: Units(in_millimetres, 1e-3),
        _BOTH: Units(in_degrees, 1e-3),
    }
    # in the units as they stand: whatever the model, lengths made a thousandth are off by a
    # thousandth
    found = {words: _tried(problem, units) / units.length for words, units in tries.items()}
    words = min(found, key=lambda words: found[words])
    if found[words] * _BETTER < off:
        best = found[words] * tries[words].length
        raise InputError(
            f"the nominal arm is off by {off:.3g} m (median) as the data stand, and by {best:.3g} m"
            f" where {words}"
        )


def build_problem(model: ErrorModel, q: Array, sets: Sequence[Measurement]) -> Problem:
    """The problem with initial guesses of its unknown frames.

    Raises: InputError where there is no guess; it says so if there were one, were q in degrees.
    """
    try:
        return Problem(model, q, sets)
    except InputError as fault:
        try:
            Problem(model, converted(model.nominal, q, angle=_DEGREE), sets)
        except InputError:
            raise fault from None
        raise InputError(f"{_DEGREES}; as the data stand, {fault}") from fault


def converted(chain: Chain, q: Array, angle: float = 1.0, length: float = 1.0) -> Array:
    """Readings (N, m), those of angles times `angle`, of lengths times `length`."""
    return q * [angle if chain.is_angle(k) else length for k in range(chain.dof)]


def _tried(problem: Problem, units: Units) -> float:
    """The median distance in these units; frames that are not given are estimated anew."""
    sets = [s.scaled(units.length) for s in problem.sets]
    try:
        other = Problem(problem.model, units.q, sets)
    except InputError:
        return np.inf
    p = fit_frames(other, "huber")
    return other.residuals(p).median_length
