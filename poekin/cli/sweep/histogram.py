"""`poekin sweep histogram`: how often a measure has which value."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

from typer import Option

from ...progress_line import ProgressLine
from ...sweep.maps.histogram import histogram
from ..kinematics.arm import Base, File, Json, Seed, Tip
from ..model import model_and_chain
from ..output import as_json, number, say, table
from .options import (
    Drawn,
    DrawnName,
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

Bins = Annotated[int, Option("--bins", min=1, help="Number of bins.")]
Ends = Annotated[
    tuple[float, float] | None,
    Option("--ends", help="Ends of the bins, in SI units (default: of 100000 configurations)."),
]


def command(
    file: File,
    measure: Measured = MeasureName.manipulability,
    bins: Bins = 20,
    ends: Ends = None,
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
    """Numbers of configurations, or poses, of FILE, drawn at random, by their measure. Exit code 0
    done, 2 error.
    """
    robot, chain = model_and_chain(file, base, tip)
    mask = mask_from(robot, chain, self_collision)
    with executor(scheduler) as runs, ProgressLine("sweep") as progress:
        found = histogram(
            chain,
            measure_from(measure, chain, sigma_angle, sigma_length),
            bins=bins,
            ends=ends,
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
    edges = pairwise(found.edges)
    rows = [
        (number(low), number(high), count)
        for (low, high), count in zip(edges, found.counts.tolist(), strict=True)
    ]
    table(("from", "to", by.value), rows, left=0)
