"""Frames as they are typed into a controller, with 95 % intervals."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import quote
from ....formats.poses import PoseFormat, to_numbers
from ....formats.poses.layout import layout
from ....groups import se3
from ....groups.arrays import Array
from ..diagnostics.base_and_tool import FrameEstimate
from ..result import CalibrationData
from .changes import TWO_SIGMA

FORMS: dict[str, PoseFormat] = {
    "UR": "ur",
    "KUKA": "kuka",
    "Fanuc": "fanuc",
    "ROS xyz rpy": "rpy",
    "ROS xyz xyzw": "ros",
}
"""Controllers, and their numbers as `pk.poses` names them."""
_DECIMALS = {"m": 6, "mm": 3, "rad": 6, "deg": 4, "": 7}
_SIZES = {"m": 1.0, "mm": 1e3, "rad": 1.0, "deg": np.rad2deg(1.0), "": 1.0}  # of 1 m or rad
_STEP = 1e-6  # rad or m: central differences are right to 1e-10
_HELD = 0.1  # what a held motion of a radian or a metre changes by less is known


class TypedNumber(NamedTuple):
    """A number to be typed in, half its 95 % interval, and whether it is held."""

    name: str
    value: float
    margin: float
    unit: str
    held: bool

    def __str__(self) -> str:
        digits = _DECIMALS[self.unit]
        rounded = round(self.value, digits) + 0.0  # not -0
        value = f"{self.name} {rounded:.{digits}f}"
        if self.held:
            return f"{value} held"
        return f"{value} ± {self.margin:.{digits}f}"


def typed(
    frame: FrameEstimate,
    form: PoseFormat,
) -> list[TypedNumber]:
    """The numbers of a frame in one form."""
    chosen = layout(form)
    values = to_numbers(frame.T, form)
    J = np.stack([_slope(frame.T, form, axis) for axis in np.eye(6)], axis=1)
    variances = np.einsum("ij,jk,ik->i", J, frame.covariance, J)
    margins = TWO_SIGMA * np.sqrt(np.maximum(variances, 0.0))
    least = _HELD * np.array([_SIZES[unit] for unit in chosen.units])
    held = np.any(np.abs(J @ frame.held) > least[:, None], axis=1)
    columns = (values.tolist(), margins.tolist(), chosen.units, held.tolist())
    return [TypedNumber(*number) for number in zip(chosen.columns, *columns, strict=True)]


def _slope(
    T: Array,
    form: PoseFormat,
    axis: Array,
) -> Array:
    """Change of the numbers by a unit motion of the frame about and along its own axes."""
    ahead = to_numbers(T @ se3.exp(_STEP * axis), form)
    behind = to_numbers(T @ se3.exp(-_STEP * axis), form)
    return (ahead - behind) / (2.0 * _STEP)


def is_held(frame: FrameEstimate) -> bool:
    """Whether nothing of a frame was found."""
    return all(number.held for number in typed(frame, "rpy"))


def title(
    found: CalibrationData,
    frame: FrameEstimate,
) -> str:
    """Name of a frame, and the one in which it stands."""
    if frame.name == "base":
        return f"base {quote(found.nominal.base)} in the frame that was measured in"
    if frame.name == "tool":
        return f"tool in the nominal tip {quote(found.nominal.tip)}"
    return frame.name


def lines(found: CalibrationData) -> list[str]:
    """All frames in all forms, for a terminal."""
    told = []
    for frame in found.tool_and_base:
        head = title(found, frame)
        if is_held(frame):
            told.append(f"{head}: held, these measurements do not tell it")
            continue
        told.append(f"{head}, to be typed in (± 95 %):")
        for name, form in FORMS.items():
            numbers = "  ".join(map(str, typed(frame, form)))
            told.append(f"  {name} ({units(form)}): {numbers}")
    return told


def units(form: PoseFormat) -> str:
    """Units of a form's numbers."""
    return ", ".join(dict.fromkeys(filter(None, layout(form).units)))
