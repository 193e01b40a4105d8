"""`poekin ik`: joints for poses, and why where there are none."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, cast

import numpy as np
from typer import Exit, Option

from ...formats.text import csv_rows
from ...model.chain import Chain
from ...progress_line import ProgressLine
from ...solve.ik.ik import ik
from ...solve.ik.solution import Solution
from ...solve.ik.task import TaskName
from ...view.view import view
from .. import array_files
from ..formats import draw as pages
from ..formats.units import Deg, Mm, SaidUnits
from ..model import model_and_chain
from ..output import as_json, complain, heading, name, path_text, say
from . import poses
from .arm import Base, File, Json, Tip, show_coordinates

MOST_TOLD = 20
Start = Annotated[
    str | None,
    Option(
        "--q0",
        metavar="Q,...",
        help="Where the search begins (commas between); default: near the middle of the limits.",
    ),
]
Nearest = Annotated[
    str | None,
    Option(
        "--nearest-to",
        metavar="Q,...",
        help="Of several solutions, the one nearest to this.",
    ),
]


def command(
    file: File,
    words: poses.Poses = None,
    tip: Tip = None,
    base: Base = None,
    given: poses.Input = None,
    format: poses.Format = None,
    quaternion: poses.Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    q0: Start = None,
    nearest_to: Nearest = None,
    task: poses.Task = "pose",
    no_limits: poses.NoLimits = False,
    seed: poses.Seed = 0,
    output: poses.Output = None,
    draw: pages.Draw = None,
    json: Json = False,
) -> None:
    """Joints with which the link --tip has a pose in the link --base. Exit code 0 all solved, 1
    some not, 2 error.
    """
    array_files.check_place(output)
    pages.check(draw)
    array_files.check_apart([output, draw], model=file, poses=given)
    units = SaidUnits(mm, deg)
    T = poses.read(words, given, format, quaternion, units)
    robot, chain = model_and_chain(file, base, tip)
    start = poses.coordinates(q0, chain, "--q0", units)
    near = poses.coordinates(nearest_to, chain, "--nearest-to", units)
    with ProgressLine("solving") as progress:
        found = ik(
            chain,
            T,
            q0=start,
            nearest_to=near,
            task=cast(TaskName, task),
            limits=not no_limits,
            seed=seed,
            progress=progress,
        )
    drawn = None if draw is None else view(found, robot=robot)
    _give(robot.name, chain, found, given is None, output, json, units)
    table = given is not None and output is None
    pages.save(drawn, draw, pages.teller(json, table))
    raise Exit(0 if found.success.all() else poses.UNSOLVED)


def _give(
    robot: str,
    chain: Chain,
    found: Solution,
    single: bool,
    output: Path | None,
    json: bool,
    units: SaidUnits,
) -> None:
    count = len(found.q)
    q = units.from_si(found.q, chain)
    unsolved = np.flatnonzero(~found.success).tolist()
    solved = count - len(unsolved)
    named = unsolved
    if not (json or output):
        named = unsolved[:MOST_TOLD]
    reasons = {k: found.summary(k) for k in named}

    def document() -> str:
        return as_json(heading(robot, chain) | _report(found, reasons, single and output is None))

    def sheet() -> str:
        rows = np.column_stack([q, found.success, found.position_error, found.rotation_error])
        return csv_rows.text([*units.header(chain), *array_files.ERRORS], rows)

    if output is not None:
        array_files.write_result(output, sheet, q, document)
        if json:
            print(as_json({"written": str(output), "poses": count, "solved": solved}))
        else:
            say(f"{count} × q written to {path_text(output)}, {solved} of {count} solved")
    elif json:
        print(document())
    elif single:
        _show(chain, found, units)
    else:
        print(sheet(), end="")
    if unsolved and not json:
        _complain(reasons, len(unsolved), single)


def _report(found: Solution, reasons: dict[int, str], single: bool) -> dict[str, object]:
    parts: dict[str, Any] = found.to_dict()
    parts["why"] = [reasons.get(k) for k in range(len(found.q))]
    if single:
        return {key: next(iter(values), ()) for key, values in parts.items()}
    return parts


def _show(chain: Chain, found: Solution, units: SaidUnits) -> None:
    (q,), (success,) = found.q, found.success
    (position,), (rotation,) = found.position_error, found.rotation_error
    words = "not solved"
    if success:
        words = f"solved, {1e3 * position:.2g} mm and {np.degrees(rotation):.2g}° off"
    say(f"{name(chain.tip)} in {name(chain.base)}: {words}")
    show_coordinates(chain, q, units)


def _complain(reasons: dict[int, str], count: int, single: bool) -> None:
    """Print the reasons on stderr: what is on stdout stays a table."""
    for k, words in list(reasons.items())[:MOST_TOLD]:
        which = f"pose {k}"
        if single:
            which = "the pose"
        complain(f"{which}: {words}")
    if count > MOST_TOLD:
        complain(f"and {count - MOST_TOLD} more poses; --json tells of each")
