"""What a calibration changed: the errors, and each joint's axis, with how well that is known."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..model.residuals import Residuals
from ..result import CalibrationData

TWO_SIGMA = 1.959963984540054
"""Of a normal number, 95 % lie within so many standard deviations."""


def errors(found: CalibrationData) -> list[tuple[str, Residuals]]:
    """Residuals and what to call them, those on data kept aside first."""
    aside = found.held_out
    kept = (
        []
        if aside is None
        else [("nominal, kept aside", aside.before), ("calibrated, kept aside", aside.after)]
    )
    return [*kept, ("nominal, all data", found.before), ("calibrated, all data", found.after)]


def sentence(found: CalibrationData) -> str:
    """What came out, in a sentence or two: on data kept aside, where there are any."""
    (_, before), (_, after), *_ = errors(found)
    where = "On the data it was fitted to" if found.held_out is None else "On data kept aside"
    length = f"the median position error goes from {milli(before.median_length)} to {milli(after.median_length)} mm"
    angle = f", the rotation error from {milli(before.median_angle)} to {milli(after.median_angle)} mrad"
    warning = (
        "" if found.success else "The search did NOT converge: this is the best that was found. "
    )
    return f"{warning}{where}, {length}{'' if math.isnan(after.median_angle) else angle}."


def milli(value: float) -> str:
    """A length in m as mm, an angle in rad as mrad, to three digits; nothing where there is none."""
    return "" if math.isnan(value) else f"{1e3 * value + 0.0:.3g}"


class Change(NamedTuple):
    """The tilts (rad) or shifts (m) of one joint's axis: values (k,), k = 0 or 2, with covariance
    (k, k), about or along these directions in base axes.
    """

    directions: tuple[str, ...]
    values: Array
    covariance: Array

    @property
    def size(self) -> float:
        """Their length; NaN where none was a parameter."""
        return float(np.linalg.norm(self.values)) if len(self.values) else float("nan")

    @property
    def margins(self) -> Array:
        """Half the 95 % interval of each (k,)."""
        return TWO_SIGMA * np.sqrt(np.diag(self.covariance))

    @property
    def margin(self) -> float:
        """Half the 95 % interval of the length; of a length of 0, that of the worst direction."""
        if not len(self.values):
            return float("nan")
        u = self.values / self.size if self.size else None
        most = np.linalg.eigvalsh(self.covariance)[-1] if u is None else u @ self.covariance @ u
        return TWO_SIGMA * float(np.sqrt(max(most, 0.0)))


class Joint(NamedTuple):
    """One joint whose axis could move."""

    name: str
    tilt: Change
    shift: Change


def joints(found: CalibrationData) -> list[Joint]:
    """The joints whose axes could move, in the order of the chain."""
    own = {
        word: [
            k
            for k, p in enumerate(found.parameters[: len(found.arm.parameters)])
            if p.what.startswith(f"{word} (")
        ]
        for word in ("tilt about", "shift along")
    }
    names = dict.fromkeys(found.parameters[k].owner for rows in own.values() for k in rows)
    return [
        Joint(name, *(_change(found, name, word, rows) for word, rows in own.items()))
        for name in names
    ]


def _change(found: CalibrationData, name: str, word: str, rows: list[int]) -> Change:
    mine = [k for k in rows if found.parameters[k].owner == name]
    directions = tuple(found.parameters[k].what.removeprefix(word).strip() for k in mine)
    return Change(directions, found.values[mine], found.covariance[np.ix_(mine, mine)])
