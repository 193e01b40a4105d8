"""Changes by a calibration: the errors, and each joint's axis, with how well that is known."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norm
from ..model.residuals import Residuals
from ..result import CalibrationData

TWO_SIGMA = 1.959963984540054
"""Of a normal number, 95 % lie within so many standard deviations."""
# of an axis: a home pose is shifted "along x"
TILT = "tilt about ("
SHIFT = "shift along ("


HEADS = ("joint", "tilt (mrad)", "± 95 %", "shift (mm)", "± 95 %")


class NamedResiduals(NamedTuple):
    """Residuals, and their name."""

    name: str
    residuals: Residuals


def errors(found: CalibrationData) -> list[NamedResiduals]:
    """Residuals of the nominal and the calibrated arm, those on held-out data first."""
    every = [
        NamedResiduals("nominal, all data", found.before),
        NamedResiduals("calibrated, all data", found.after),
    ]
    held_out = found.cross_validation
    if held_out is None:
        return every
    return [
        NamedResiduals("nominal, held out", held_out.before),
        NamedResiduals("calibrated, held out", held_out.after),
        *every,
    ]


def sentence(found: CalibrationData) -> str:
    """The result in a sentence or two: on held-out data, where there are any."""
    before, after, *_ = (r.residuals for r in errors(found))
    where = "On the data it was fitted to"
    if found.cross_validation is not None:
        where = "On held-out data"
    words = (
        f"{where}, the median position error goes from {milli(before.median_length)} to "
        f"{milli(after.median_length)} mm"
    )
    if not math.isnan(after.median_angle):
        was = milli(before.median_angle)
        words += f", the rotation error from {was} to {milli(after.median_angle)} mrad"
    if not found.success:
        words = f"The search did NOT converge: this is the best that was found. {words}"
    return f"{words}."


def milli(value: float) -> str:
    """A length in m as mm, an angle in rad as mrad, to three digits; nothing where there is none."""
    if math.isnan(value):
        return ""
    return f"{1e3 * value + 0.0:.3g}"


class AxisChange(NamedTuple):
    """The tilts (rad) or shifts (m) of one joint's axis: values (k,), k = 0 or 2, with covariance
    (k, k).
    """

    values: Array
    covariance: Array

    @property
    def size(self) -> float:
        """Their length; NaN where none was a parameter."""
        if len(self.values):
            return norm(self.values)
        return math.nan

    @property
    def margins(self) -> Array:
        """Half the 95 % interval of each (k,)."""
        return TWO_SIGMA * np.sqrt(np.diag(self.covariance))

    @property
    def margin(self) -> float:
        """Half the 95 % interval of the length; of a length of 0, that of the worst direction."""
        if not len(self.values):
            return math.nan
        if self.size:
            u = self.values / self.size
            variance = u @ self.covariance @ u
        else:
            variance = np.linalg.eigvalsh(self.covariance)[-1]
        return TWO_SIGMA * float(np.sqrt(max(variance, 0.0)))


class MovableJoint(NamedTuple):
    """One joint whose axis could move."""

    name: str
    tilt: AxisChange
    shift: AxisChange


def joints(found: CalibrationData) -> list[MovableJoint]:
    """The joints whose axes could move, in the order of the chain."""
    own = found.error_model.parameters
    tilted = dict.fromkeys(p.owner for p in own if p.what.startswith(TILT))
    return [
        MovableJoint(
            name,
            _change(found, name, TILT),
            _change(found, name, SHIFT),
        )
        for name in tilted
    ]


def _change(found: CalibrationData, name: str, word: str) -> AxisChange:
    own = found.error_model.parameters
    mine = [k for k, p in enumerate(own) if p.owner == name and p.what.startswith(word)]
    return AxisChange(found.values[mine], found.covariance[np.ix_(mine, mine)])


def row(joint: MovableJoint) -> tuple[str, ...]:
    """Name, tilt and its interval (mrad), shift and its interval (mm)."""
    moved = (joint.tilt, joint.shift)
    figures = (x for change in moved for x in (change.size, change.margin))
    return joint.name, *map(milli, figures)
