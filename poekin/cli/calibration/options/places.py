"""Places out of the options of choose-poses: boxes, and the cone that a camera sees."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from typer import Option

from ....errors import InputError
from ....groups.arrays import Array
from ....solve.calibration.design.visibility import ViewCone, WorkspaceBox
from ...formats.units import SaidUnits
from ...kinematics.poses import option_numbers
from .. import measured as measured_files
from ..measured import MeasurementOptions

BoxNumbers = Annotated[
    str | None,
    Option(
        "--box",
        metavar="X,Y,Z,X,Y,Z",
        help="Measure only with the tool in this box: its two corners in the base frame, m.",
    ),
]
ConeNumbers = Annotated[
    str | None,
    Option(
        "--cone",
        metavar="X,Y,Z,DX,DY,DZ,ANGLE",
        help="Measure only where a camera sees the tool: its place, where it looks, half its angle of view, rad.",
    ),
]
WorkspaceNumbers = Annotated[
    str | None,
    Option(
        "--workspace",
        metavar="X,Y,Z,X,Y,Z",
        help="The box in which the arm is to be accurate (default: all candidates).",
    ),
]


def tool_point(said: MeasurementOptions) -> Array:
    """The first measured point of the tool, else its origin."""
    for text in said.point:
        return measured_files.point(text, "--point", said)
    return np.zeros(3)


def box(
    text: str | None,
    option: str,
    units: SaidUnits,
    point: Array,
) -> WorkspaceBox | None:
    """The box of two corners for a point of the tool; None without an option. Raises: InputError."""
    if text is None:
        return None
    numbers = _numbers(text, option, 6, "two corners, x,y,z,x,y,z")
    if units.mm:
        numbers = numbers / 1000.0
    corners = numbers.reshape(2, 3)
    return WorkspaceBox(corners.min(axis=0), corners.max(axis=0), point)


def cone(text: str | None, units: SaidUnits, point: Array) -> ViewCone | None:
    """The cone in which a point of the tool is seen; None without an option. Raises: InputError."""
    if text is None:
        return None
    numbers = _numbers(text, "--cone", 7, "a place, a direction and an angle")
    apex, axis, (half_angle,) = np.split(numbers, [3, 6])
    if units.mm:
        apex = apex / 1000.0
    if units.deg:
        half_angle = np.deg2rad(half_angle)
    try:
        return ViewCone(apex, axis, float(half_angle), point)
    except InputError as fault:
        raise InputError(f"--cone: {fault}") from fault


def _numbers(
    text: str,
    option: str,
    count: int,
    what: str,
) -> Array:
    values = option_numbers(text, option)
    if len(values) != count:
        raise InputError(f"{option}: {count} numbers expected ({what}), got {len(values)}")
    return values
