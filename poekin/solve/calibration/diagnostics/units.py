"""Millimetres where metres are due, degrees for radians: detected by what they would explain, never
converted.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ..fit.fitting import frames_only
from ..measurements.measurement import Measurement
from ..model.parameters import Arm
from ..model.problem import Problem
from ..model.residuals import residuals

LARGE = 0.1  # reaches: a nominal arm is off by millimetres
_BETTER = 4.0  # how many times better the other unit has to explain the data
_TURN = 2.0 * np.pi
_DEGREE = _TURN / 360.0
_SLIDES = "the readings of sliding joints look like millimetres: give metres (divide by 1000)"
_DEGREES = "the joint angles look like degrees: give radians (numpy.deg2rad)"


def check(problem: Problem, p: Array) -> None:
    """Refuse data that another unit explains much better.

    Raises: InputError that says which and by how much, where the nominal arm is off by more than a
    tenth of its reach.
    """
    off = _off(problem, p)
    if off <= LARGE * problem.arm.nominal.reach and np.abs(problem.q).max(initial=0.0) <= 4 * _TURN:
        return
    in_degrees = converted(problem.arm.nominal, problem.q, angle=_DEGREE)
    in_millimetres = converted(problem.arm.nominal, problem.q, length=1e-3)
    tries = {
        "the lengths look like millimetres: give metres (divide by 1000)": (problem.q, 1e-3),
        _DEGREES: (in_degrees, 1.0),
        _SLIDES: (in_millimetres, 1.0),
        "all lengths look like millimetres, those of sliding joints, too: give metres (divide by 1000)": (
            in_millimetres, 1e-3,
        ),
        "the lengths look like millimetres and the joint angles like degrees: give metres and radians": (
            in_degrees, 1e-3,
        ),
    }  # fmt: skip
    # in the units as they stand: whatever the model, lengths made a thousandth are off by a
    # thousandth
    found = {words: (_tried(problem, q, unit) / unit, unit) for words, (q, unit) in tries.items()}
    words, (best, unit) = min(found.items(), key=lambda item: item[1][0])
    if best * _BETTER < off:
        best *= unit
        raise InputError(
            f"the nominal arm is off by {off:.3g} m (median) as the data stand, and by {best:.3g} m where {words}"
        )


def built(arm: Arm, q: Array, sets: Sequence[Measurement]) -> Problem:
    """The problem with its unknown frames' first guesses.

    Raises: InputError where there is no guess; it says so if there were one, were q in degrees.
    """
    try:
        return Problem(arm, q, sets)
    except InputError as fault:
        try:
            Problem(arm, converted(arm.nominal, q, angle=_DEGREE), sets)
        except InputError:
            raise fault from None
        raise InputError(f"{_DEGREES}; as the data stand, {fault}") from fault


def converted(arm: Chain, q: Array, angle: float = 1.0, length: float = 1.0) -> Array:
    """Readings (N, m), those of angles times `angle`, of lengths times `length`."""
    return q * [angle if arm.is_angle(k) else length for k in range(arm.dof)]


def _off(problem: Problem, p: Array) -> float:
    return residuals(problem.sets, problem.rows, problem.errors(p)).median_length


def _tried(problem: Problem, q: Array, unit: float) -> float:
    """The median distance with other readings, lengths times `unit`; frames that are not given are
    sought anew.
    """
    sets = [s.scaled(unit) for s in problem.sets]
    try:
        other = Problem(problem.arm, q, sets)
    except InputError:
        return np.inf
    p, _ = frames_only(other, "huber")
    return _off(other, p)
