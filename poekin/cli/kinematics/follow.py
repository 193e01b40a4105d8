"""`poekin follow`: joints along a path of poses, and where it is hard or impossible."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, cast

import numpy as np
from typer import Exit, Option

from ...checks import positive
from ...errors import InputError
from ...formats.text import csv_rows
from ...formats.text.atomic_write import write_whole
from ...model.chain import Chain
from ...progress_line import ProgressLine
from ...solve.ik.task import TaskName
from ...solve.path.follow import follow
from ...solve.path.path_result import PathResult
from ...view.view import view
from .. import array_files
from ..formats import draw as pages
from ..formats.units import Deg, Mm, SaidUnits
from ..model import model_and_chain
from ..output import as_json, complain, heading, path_text, say
from . import fastest_files, poses
from .arm import Base, File, Json, Tip

Start = Annotated[
    str | None,
    Option(
        "--q0",
        metavar="Q,...",
        help="Where the arm is (commas between); default: chosen by trial.",
    ),
]
Duration = Annotated[
    float | None,
    Option("--duration", help="Seconds from the first pose to the last, evenly."),
]
Fastest = Annotated[
    bool,
    Option(
        "--fastest",
        help="As fast as --speed and --acceleration allow: times and velocities for a controller.",
    ),
]
Speed = Annotated[
    str | None,
    Option(
        "--speed",
        metavar="V[,...]",
        help="Limits of speed, with --duration or --fastest (default there: the model's).",
    ),
]
Acceleration = Annotated[
    str | None,
    Option(
        "--acceleration",
        metavar="A[,...]",
        help="Limits of acceleration, with --duration or --fastest.",
    ),
]
Output = Annotated[
    Path | None,
    Option(
        "--output",
        "-o",
        help="Where the joints go: a .csv, .npy or .json file; with --fastest .csv, .yaml or .json "
        "(JointTrajectory of ROS), or .script (URScript).",
    ),
]
Step = Annotated[
    float,
    Option(
        "--max-step",
        help="How far (rad or m) a joint may go at a step; longer ones are divided.",
    ),
]
Plot = Annotated[
    Path | None,
    Option("--plot", help="Draw the joints over time: an .svg file."),
]


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    given: poses.Input = None,
    format: poses.Format = None,
    quaternion: poses.Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    q0: Start = None,
    duration: Duration = None,
    fastest: Fastest = False,
    speed: Speed = None,
    acceleration: Acceleration = None,
    max_step: Step = 0.1,
    task: poses.Task = "pose",
    no_limits: poses.NoLimits = False,
    seed: poses.Seed = 0,
    output: Output = None,
    plot: Plot = None,
    draw: pages.Draw = None,
    json: Json = False,
) -> None:
    """Joints along the path of poses in --input, without a jump where there is such a way.

    Exit code 0: followed, within the limits; 1: some pose is not reached, the branch changes, or a
    limit is exceeded; 2: an error. With --fastest nothing is written where the path breaks.
    """
    if fastest:
        fastest_files.check(output, duration, acceleration)
    else:
        fastest_files.check_unasked(output)
        array_files.check_place(output)
    array_files.check_place(plot, (".svg",))
    if given is None:
        raise InputError("--input: a file of poses expected, got none")
    pages.check(draw)
    array_files.check_apart([output, plot, draw], model=file, poses=given)
    untimed = duration is None and not fastest
    if untimed and (speed is not None or acceleration is not None):
        raise InputError(
            "--speed and --acceleration: expected together with --duration or --fastest, got none"
        )
    units = SaidUnits(mm, deg)
    T = poses.read(None, given, format, quaternion, units)
    robot, chain = model_and_chain(file, base, tip)
    limit_v = poses.for_each(speed, chain, "--speed", units)
    limit_a = poses.for_each(acceleration, chain, "--acceleration", units)
    timed = not fastest
    with ProgressLine("following") as progress:
        path = follow(
            chain,
            T,
            q0=poses.coordinates(q0, chain, "--q0", units),
            times=_times(duration, len(T)),
            speed=limit_v if timed else None,
            max_step=max_step,
            task=cast(TaskName, task),
            limits=not no_limits,
            acceleration=limit_a if timed else None,
            seed=seed,
            progress=progress,
        )
    drawn = None if draw is None else view(path, robot=robot)
    teller = pages.teller(json, output is None)
    if fastest:
        report = heading(robot.name, chain) | _report(path)
        code = fastest_files.give(path, limit_a, limit_v, output, plot, json, report)
        pages.save(drawn, draw, teller)
        raise Exit(code)
    svg = ""
    if plot is not None:
        svg = path.plot()
    _give(robot.name, chain, path, output, json, units)
    if plot is not None:
        write_whole(plot, svg.encode())
        if not json:
            say(f"joints drawn in {path_text(plot)}")
    pages.save(drawn, draw, teller)
    raise Exit(0 if path.ok else poses.UNSOLVED)


def _times(duration: float | None, count: int) -> np.ndarray | None:
    if duration is None:
        return None
    return np.linspace(0, positive(duration, "--duration"), count)


def _give(
    robot: str,
    chain: Chain,
    path: PathResult,
    output: Path | None,
    json: bool,
    units: SaidUnits,
) -> None:
    q = units.from_si(path.q, chain)

    def document() -> str:
        return as_json(heading(robot, chain) | _report(path))

    def sheet() -> str:
        if path.times is None:
            return csv_rows.text(units.header(chain), q)
        return csv_rows.text(
            [array_files.TIME, *units.header(chain)],
            np.column_stack([path.times, q]),
        )

    if output is not None:
        array_files.write_result(output, sheet, q, document)
        if json:
            report = _report(path)
            del report["q"]
            print(as_json({"written": str(output)} | report))
        else:
            say(f"{len(path.q)} × q written to {path_text(output)}")
            say(path)
    elif json:
        print(document())
    else:
        print(sheet(), end="")
        for sentence in path.summary().splitlines():
            complain(sentence)


def _report(path: PathResult) -> dict[str, object]:
    counts = {"poses": len(path.q), "solved": int(path.success.sum())}
    return path.to_dict() | counts | {"words": path.summary().splitlines()}
