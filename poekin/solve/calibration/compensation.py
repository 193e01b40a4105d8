"""Compensation: what to command an uncalibrated controller so that the true arm is where it should."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, escape_unprintable
from ...groups.arrays import Array
from ...groups.vectors import translation_part
from ...results import brief
from ..ik.ik import ik
from .result import CalibrationData
from .terms.conditions import later_conditions

_ROUNDS = 30
_SETTLED = 1e-13  # rad or m: a change of a command that is rounding


class Command(NamedTuple):
    """Target for an uncalibrated controller.

    Parameters
    ----------
    q : (..., m) ndarray
        Joint readings to drive to, rad or m.
    T : (..., 4, 4) ndarray
        Poses of the nominal arm there, m: what a controller with its own inverse kinematics is told.
    """

    q: Array
    T: Array

    def __repr__(self) -> str:
        if self.q.ndim > 1:
            return brief(self, f"readings and poses of shape {self.q.shape} and {self.T.shape}")
        readings = ", ".join(f"{x:.6g}" for x in self.q)
        place = ", ".join(f"{x:.6g}" for x in translation_part(self.T))
        return brief(self, f"q = ({readings}), where the nominal arm is at ({place})")


def true_joints(found: CalibrationData, q: Array, conditions: Mapping[str, Any] | None) -> Array:
    """See `Calibration.true_joints`."""
    model = found.error_model
    rows = q.reshape(-1, q.shape[-1])
    given = later_conditions(conditions, rows, model.reference)
    p = found.values[: len(model.parameters)]
    return model.true_joints(p, rows, given).reshape(q.shape)


def compensate(
    found: CalibrationData, T: ArrayLike, nearest_to: Any, conditions: Mapping[str, Any] | None
) -> Command:
    """See `Calibration.compensate`."""
    solution = ik(found.chain, T, nearest_to=nearest_to)
    if not np.all(solution.success):
        raise InputError(
            f"compensate: the calibrated arm cannot reach T: {escape_unprintable(str(solution))}"
        )
    q = solution.q
    for _ in range(_ROUNDS):
        reached = true_joints(found, q, conditions)
        off = reached - solution.q
        q = q - off
        if np.abs(off).max(initial=0.0) <= _SETTLED:
            return Command(q, found.nominal.fk(q))
    raise InputError("compensate: the terms of the calibration change faster than the joints move")
