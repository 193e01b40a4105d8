"""`poekin sweep top`: the configurations with the best, or the worst, measures."""

from __future__ import annotations

from typing import Annotated

from typer import Option

from ...progress_line import ProgressLine
from ...sweep.maps.top import top
from ..kinematics.arm import Base, File, Json, Seed, Tip
from ..model import model_and_chain
from ..output import as_json, name, number, say, table
from .options import (
    Drawn,
    DrawnName,
    KeepName,
    Kept,
    Measured,
    MeasureName,
    Samples,
    SelfCollisionFree,
    SigmaAngle,
    SigmaLength,
    Workers,
    mask_from,
    measure_from,
    samples_from,
)
from .scheduler import Scheduler, executor

Count = Annotated[int, Option("--count", min=1, help="Number of configurations that are listed.")]


def command(
    file: File,
    measure: Measured = MeasureName.manipulability,
    count: Count = 10,
    keep: Kept = KeepName.best,
    samples: Samples = "1e7",
    by: Drawn = DrawnName.configurations,
    sigma_angle: SigmaAngle = None,
    sigma_length: SigmaLength = None,
    self_collision: SelfCollisionFree = False,
    seed: Seed = 0,
    tip: Tip = None,
    base: Base = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    json: Json = False,
) -> None:
    """Configurations, or poses, of FILE with the best measures of all that are drawn at random. Exit
    code 0 done, 2 error.
    """
    robot, chain = model_and_chain(file, base, tip)
    mask = mask_from(robot, chain, self_collision)
    with executor(scheduler) as runs, ProgressLine("sweep") as progress:
        found = top(
            chain,
            measure_from(measure, chain, sigma_angle, sigma_length),
            count,
            keep=keep.value,
            samples=samples_from(chain, samples, seed, by),
            mask=mask,
            workers=workers,
            executor=runs,
            progress=progress,
        )
    if json:
        print(as_json(found.to_dict()))
        return
    say(f"{found.summary()}\n")
    rows = [
        [number(value), *(number(x) for x in q)]
        for value, q in zip(found.values, found.q, strict=True)
    ]
    table(["measure", *map(name, chain.q_names)], rows, left=0)
