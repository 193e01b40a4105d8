"""Changes by a calibration: the errors, and each joint's axis, whatever base and tool are."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....analysis.compare.compare import compare
from ....analysis.compare.comparison import JointComparison
from ..diagnostics.base_and_tool import base_and_tool, pose_points
from ..model.residuals import Residuals
from ..result import CalibrationData

TWO_SIGMA = 1.959963984540054
"""Of a normal number, 95 % lie within so many standard deviations."""
HEADS = ("joint", "angle of the axes (°)", "common normal (mm)", "at the arm (mm)", "zero")


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


def aligned_joints(found: CalibrationData) -> tuple[JointComparison, ...]:
    """The joints of the nominal arm, base and tool aligned to the calibrated one, beside its own:
    what no choice of frames changes.
    """
    base, tool, *_ = base_and_tool(found.estimate, pose_points(found.nominal.reach))
    aligned = found.nominal.rebased(base).retooled(tool)
    return compare(aligned, found.chain).joints


def row(joint: JointComparison) -> tuple[str, ...]:
    """Name, and how far the calibrated axis and its zero are from the nominal ones."""
    zero = f"{_degrees(joint.zero_offset)} °"
    if joint.unit == "m":
        zero = f"{_millimetres(joint.zero_offset)} mm"
    return (
        joint.name_a,
        _degrees(joint.angle),
        _millimetres(joint.normal),
        _millimetres(joint.shift),
        zero,
    )


def _millimetres(length: float | None) -> str:
    if length is None:
        return ""
    return _seen(1e3 * length)


def _degrees(angle: float) -> str:
    return _seen(math.degrees(angle))


def _seen(value: float) -> str:
    """A figure in mm or degrees; what is far below them is rounding."""
    return f"{0.0 if abs(value) < 1e-9 else value:.3g}"
