"""`poekin sweep reach`: a map of where a tool can be, from which directions, and how well."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import numpy as np
from typer import Exit, Option

from ...errors import InputError
from ...model.chain import Chain
from ...model.sampling import angle_mask
from ...sweep.maps import map_files
from ...sweep.maps.reach import reach
from ...sweep.masks.self_collision import SelfCollision
from ...sweep.measures.measure import Measure
from ...sweep.measures.names import measure_of
from ...sweep.measures.pose_uncertainty import ErrorPart, PoseUncertainty
from .. import array_files
from ..kinematics.arm import Base, File, Json, Seed, Tip
from ..model import model
from ..output import Progress, as_json, path_text, say
from .scheduler import Scheduler, executor


class MeasureName(StrEnum):
    """Measure that a map keeps of each cell."""

    reach = "reach"
    manipulability = "manipulability"
    inverse_condition = "inverse_condition"
    smallest_singular_value = "smallest_singular_value"
    limit_margin = "limit_margin"
    travel = "travel"
    position_error = "position_error"
    orientation_error = "orientation_error"


class KeepName(StrEnum):
    """Which measure of a cell a map keeps."""

    best = "best"
    worst = "worst"
    mean = "mean"


Samples = Annotated[
    str,
    Option("--samples", metavar="N", help="Number of configurations, as 10000000 or 1e8."),
]
Resolution = Annotated[float, Option("--resolution", help="Side of a cube, m.")]
Side = Annotated[
    int,
    Option(
        "--side",
        min=0,
        help="Tell 12 SIDE² directions of the tool's z axis apart (4: 192 of them).",
    ),
]
Measured = Annotated[MeasureName, Option("--measure", help="What is kept of each cell.")]
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
MapFile = Annotated[
    Path | None,
    Option("--output", help="Where the map goes: a .npz file, or a .zarr directory (extra sweep)."),
]
StorePlace = Annotated[
    Path | None,
    Option("--store", help="Directory that keeps each part as soon as it is done."),
]
Resume = Annotated[
    bool,
    Option("--resume", help="Go on with what the store holds, of a run that was ended."),
]
Workers = Annotated[
    int | None,
    Option("--workers", min=1, help="Number of threads (default: one for each processor)."),
]


def command(
    file: File,
    samples: Samples = "1e7",
    resolution: Resolution = 0.05,
    side: Side = 0,
    measure: Measured = MeasureName.reach,
    keep: Kept = KeepName.best,
    sigma_angle: SigmaAngle = None,
    sigma_length: SigmaLength = None,
    self_collision: SelfCollisionFree = False,
    seed: Seed = 0,
    tip: Tip = None,
    base: Base = None,
    output: MapFile = None,
    store: StorePlace = None,
    resume: Resume = False,
    workers: Workers = None,
    scheduler: Scheduler = None,
    json: Json = False,
) -> None:
    """Map of the cells that the tool of FILE reaches, from configurations drawn at random. Exit code
    0 done, 2 error.
    """
    array_files.check_apart([output], model=file)
    if output is not None:
        map_files.check_place(output, "--output")
    if resume and store is None:
        raise InputError(
            "--resume: expected with --store and the directory of the run to go on with"
        )
    robot = model(file)
    chain = robot.chain(base=base, tip=tip)
    mask = SelfCollision.of_robot(robot, chain) if self_collision else None
    with executor(scheduler) as runs, Progress("sweep") as progress:
        found = reach(
            chain,
            resolution=resolution,
            samples=_count(samples),
            side=side,
            measure=_measure(measure, chain, sigma_angle, sigma_length),
            keep=keep.value,
            mask=mask,
            seed=seed,
            workers=workers,
            executor=runs,
            store=store,
            resume=resume,
            progress=progress,
        )
    if output is not None:
        found.save(output)
    if json:
        print(as_json(found.to_dict()))
    else:
        say(found.summary())
        if mask is not None:
            say(f"\n{mask.summary()}")
        if output is not None:
            say(f"\nthe map: {path_text(output)}")
    raise Exit(0)


def _measure(name: MeasureName, chain: Chain, angle: float | None, length: float | None) -> Measure:
    """The measure of a name. Raises: InputError where its errors are not given, or not asked for."""
    is_error = name in (MeasureName.position_error, MeasureName.orientation_error)
    is_given = angle is not None or length is not None
    if is_error != is_given:
        raise InputError(
            "--sigma-angle, --sigma-length: expected, one or both, with --measure position_error or "
            "orientation_error, and with no other"
        )
    if not is_error:
        return measure_of(name.value)  # type: ignore[arg-type]  # its names are some of those
    part: ErrorPart = "position" if name is MeasureName.position_error else "orientation"
    # a coordinate that slides is off by a length
    offset = np.where(angle_mask(chain), angle or 0.0, length or 0.0)
    return PoseUncertainty.by_tolerances(
        chain, tilt=angle or 0.0, shift=length or 0.0, offset=offset, part=part
    )


def _count(text: str) -> int:
    """A whole number, in digits or as 1e8. Raises: InputError."""
    try:
        number = float(text)
    except ValueError:
        number = 0.5
    if not number.is_integer():
        raise InputError(
            f"--samples: expected a whole number, as 10000000 or 1e8, got {path_text(text)}"
        )
    return int(number)
