"""`poekin sweep reach`: a map of where a tool can be, from which directions, and how well."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

from typer import Option

from ...errors import InputError
from ...progress_line import ProgressLine
from ...sweep.maps import map_files
from ...sweep.maps.reach import reach
from .. import array_files
from ..kinematics.arm import Base, File, Json, Seed, Tip
from ..model import model_and_chain
from ..output import as_json, path_text, say
from .options import (
    KeepName,
    Kept,
    Measured,
    MeasureName,
    Samples,
    SelfCollisionFree,
    SigmaAngle,
    SigmaLength,
    Workers,
    count_from,
    mask_from,
    measure_from,
)
from .scheduler import Scheduler, executor

Resolution = Annotated[float, Option("--resolution", help="Side of a cube, m.")]
Side = Annotated[
    int,
    Option(
        "--side",
        min=0,
        help="Tell 12 SIDE² directions of the tool's z axis apart (4: 192 of them).",
    ),
]


class TriedName(StrEnum):
    """Kind of samples of a map."""

    configurations = "configurations"
    poses = "poses"
    middles = "middles"


Tried = Annotated[
    TriedName,
    Option(
        "--by",
        help="Draw configurations; or ask the IK of poses that are drawn, or of the middles of cells.",
    ),
]
Turns = Annotated[
    int, Option("--turns", min=1, help="Of middles: turns of the tool about its z axis in each.")
]
MapFile = Annotated[
    Path | None,
    Option(
        "-o",
        "--output",
        help="Where the map goes: a .npz file, or a .zarr directory (extra sweep).",
    ),
]
StorePlace = Annotated[
    Path | None,
    Option("--store", help="Directory that keeps each part as soon as it is done."),
]
Resume = Annotated[
    bool,
    Option("--resume", help="Go on with what the store holds, of a run that was ended."),
]


def command(
    file: File,
    samples: Samples = "1e7",
    by: Tried = TriedName.configurations,
    turns: Turns = 1,
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
    """Map of the cells that the tool of FILE reaches, from configurations drawn at random, or by
    inverse kinematics. Exit code 0 done, 2 error.
    """
    array_files.check_apart([output], model=file)
    if output is not None:
        map_files.check_place(output, "--output")
    if resume and store is None:
        raise InputError(
            "--resume: expected with --store and the directory of the run to go on with"
        )
    robot, chain = model_and_chain(file, base, tip)
    mask = mask_from(robot, chain, self_collision)
    with executor(scheduler) as runs, ProgressLine("sweep") as progress:
        found = reach(
            chain,
            resolution=resolution,
            samples=count_from(samples),
            by=by.value,
            turns=turns,
            side=side,
            measure=measure_from(measure, chain, sigma_angle, sigma_length),
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
