"""Options that the commands of sweeps share, and what they say."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import numpy as np
from typer import Option

from ...errors import InputError
from ...model.chain import Chain
from ...model.robot import Robot
from ...model.sampling import angle_mask
from ...sweep.masks.self_collision import SelfCollision
from ...sweep.measures.measure import Measure
from ...sweep.measures.names import measure_of
from ...sweep.measures.pose_uncertainty import ErrorPart, PoseUncertainty
from ...sweep.pose_samples import PoseSamples
from ...sweep.samples import Random
from ..output import path_text


class MeasureName(StrEnum):
    """Measure that a map keeps of each cell."""

    reach = "reach"
    manipulability = "manipulability"
    inverse_condition = "inverse_condition"
    smallest_singular_value = "smallest_singular_value"
    limit_margin = "limit_margin"
    travel = "travel"
    solutions = "solutions"
    position_error = "position_error"
    orientation_error = "orientation_error"


class DrawnName(StrEnum):
    """Kind of samples."""

    configurations = "configurations"
    poses = "poses"


class KeepName(StrEnum):
    """Which measure of a cell a map keeps."""

    best = "best"
    worst = "worst"
    mean = "mean"


Samples = Annotated[
    str,
    Option("--samples", metavar="N", help="Number of samples, as 10000000 or 1e8."),
]
Measured = Annotated[MeasureName, Option("--measure", help="What is kept of each cell.")]
Drawn = Annotated[
    DrawnName,
    Option("--by", help="Draw configurations, or poses and take the best IK solution of each."),
]
Kept = Annotated[
    KeepName, Option("--keep", help="Keep the best, the worst or the mean measure of a cell.")
]
SelfCollisionFree = Annotated[
    bool,
    Option(
        "--self-collision",
        help="Leave configurations out in which spheres around the robot's collision geometry touch.",
    ),
]
SigmaAngle = Annotated[
    float | None,
    Option(
        "--sigma-angle",
        min=0,
        help="Of the errors: standard deviation of each axis's tilts and each coordinate's offset, rad.",
    ),
]
SigmaLength = Annotated[
    float | None,
    Option(
        "--sigma-length",
        min=0,
        help="Of the errors: standard deviation of each axis's shifts, m.",
    ),
]
Workers = Annotated[
    int | None,
    Option("--workers", min=1, help="Number of threads (default: one for each processor)."),
]

_PARTS: dict[MeasureName, ErrorPart] = {
    MeasureName.position_error: "position",
    MeasureName.orientation_error: "orientation",
}


def mask_from(robot: Robot, chain: Chain, self_collision: bool) -> SelfCollision | None:
    """Mask by the robot's collision geometry, if it is asked for."""
    return SelfCollision.of_robot(robot, chain) if self_collision else None


def measure_from(
    name: MeasureName, chain: Chain, angle: float | None, length: float | None
) -> Measure:
    """The measure of a name. Raises: InputError where its errors are not given, or not asked for."""
    part = _PARTS.get(name)
    is_given = angle is not None or length is not None
    if (part is not None) != is_given:
        raise InputError(
            "--sigma-angle, --sigma-length: expected, one or both, with --measure position_error or "
            "orientation_error, and with no other"
        )
    if part is None:
        return measure_of(name.value)  # type: ignore[arg-type]  # its names are some of those
    # a coordinate that slides is off by a length
    offset = np.where(angle_mask(chain), angle or 0.0, length or 0.0)
    return PoseUncertainty.by_tolerances(
        chain, tilt=angle or 0.0, shift=length or 0.0, offset=offset, part=part
    )


def count_from(text: str) -> int:
    """A whole number, in digits or as 1e8. Raises: InputError."""
    try:
        number = float(text)
    except ValueError:
        number = 0.5
    if not (number.is_integer() and number >= 1):
        raise InputError(
            f"--samples: expected a whole number from 1 on, as 10000000 or 1e8, got {path_text(text)}"
        )
    return int(number)


def samples_from(chain: Chain, text: str, seed: int, by: DrawnName) -> Random | PoseSamples:
    """Random configurations, or poses. Raises: InputError."""
    kinds = {DrawnName.configurations: Random, DrawnName.poses: PoseSamples}
    return kinds[by].of(chain, count_from(text), seed)
