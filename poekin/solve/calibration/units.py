"""Millimetres where metres are due, degrees for radians: detected by what they would explain, never converted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from .fitting import frames_only
from .measurement import Measurement
from .parameters import Arm
from .problem import Problem
from .residuals import residuals

_LARGE = 0.1  # reaches: a nominal arm is off by millimetres
_BETTER = 4.0  # how many times better the other unit has to explain the data
_TURN = 2.0 * np.pi
_DEGREES = "the joint angles look like degrees: give radians (numpy.deg2rad)"


def check(problem: Problem, p: Array) -> None:
    """Refuse data that another unit explains much better.

    Raises: InputError that says which and by how much, where the nominal arm is off by more than a tenth of its reach.
    """
    off = _off(problem, p)
    if off <= _LARGE * problem.arm.nominal.reach and np.abs(problem.q).max(initial=0.0) <= 4 * _TURN:
        return
    in_degrees = from_degrees(problem.arm.nominal, problem.q)
    tries = {
        "the lengths look like millimetres: give metres (divide by 1000)": (problem.q, 1e-3),
        _DEGREES: (in_degrees, 1.0),
        "the lengths look like millimetres and the joint angles like degrees: give metres and radians": (
            in_degrees, 1e-3,
        ),
    }  # fmt: skip
    found = {words: _tried(problem, *what) for words, what in tries.items()}
    words, best = min(found.items(), key=lambda item: item[1])
    if best * _BETTER < off:
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
            Problem(arm, from_degrees(arm.nominal, q), sets)
        except InputError:
            raise fault from None
        raise InputError(f"{_DEGREES}; as the data stand, {fault}") from fault


def from_degrees(arm: Chain, q: Array) -> Array:
    """Readings (N, m) whose angles were in degrees, in rad."""
    turning = [arm._turns(k) for k in range(arm.dof)]
    return np.where(turning, np.deg2rad(q), q)


def _off(problem: Problem, p: Array) -> float:
    return residuals(problem.sets, problem.rows, problem.errors(p)).median_length


def _tried(problem: Problem, q: Array, unit: float) -> float:
    """The median distance with other readings, lengths times `unit`; frames that are not given are sought anew."""
    sets = [s.scaled(unit) for s in problem.sets]
    try:
        other = Problem(problem.arm, q, sets)
    except InputError:
        return np.inf
    p, _ = frames_only(other, "huber")
    return _off(other, p)
