"""`poekin ik`: joints for poses, and why where there are none."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from ...formats.text import csv_rows
from ...formats.text.atomic_write import write_whole
from ...model.chain import Chain
from ...solve.ik.ik import ik
from ...solve.ik.solution import Solution
from .. import array_files
from ..model import model
from ..output import Progress, as_json, complain, name, number, path_text, say
from . import poses
from .arm import Base, File, Json, Tip

MOST_TOLD = 20
Start = Annotated[
    str | None,
    typer.Option(
        "--q0", metavar="Q,...", help="Where the search begins (commas between); default: random."
    ),
]
Nearest = Annotated[
    str | None,
    typer.Option(
        "--nearest-to", metavar="Q,...", help="Of several solutions, the one nearest to this."
    ),
]


def command(
    file: File, words: poses.Poses = None, tip: Tip = None, base: Base = None, given: poses.Input = None,
    format: poses.Format = None, quaternion: poses.Quaternion = None, q0: Start = None, nearest_to: Nearest = None,
    task: poses.Task = "pose", no_limits: poses.NoLimits = False, seed: poses.Seed = 0, output: poses.Output = None,
    json: Json = False,
) -> None:  # fmt: skip
    """Joints with which the link --tip has a pose in the link --base. Exit code 0 all solved, 1
    some not, 2 error.
    """
    if output is not None:
        array_files.check_writable(output)
    array_files.check_apart([output], model=file, poses=given)
    T = poses.read(words, given, format, quaternion)
    robot = model(file)
    chain = robot.chain(base=base, tip=tip)
    start, near = (
        poses.coordinates(q, chain, o) for q, o in ((q0, "--q0"), (nearest_to, "--nearest-to"))
    )
    with Progress("solving") as progress:
        found = ik(
            chain, T, q0=start, nearest_to=near, task=task, limits=not no_limits, seed=seed, progress=progress
        )  # fmt: skip
    _give(robot.name, chain, found, given is None, output, json)
    raise typer.Exit(0 if found.success.all() else poses.UNSOLVED)


def _give(
    robot: str, chain: Chain, found: Solution, single: bool, output: Path | None, json: bool
) -> None:
    count, solved = len(found.q), int(found.success.sum())
    why = [
        found.why(int(k))
        for k in np.flatnonzero(~found.success)[: count if json or output else MOST_TOLD]
    ]

    def document() -> str:
        words = iter(why)
        parts = {
            "q": found.q.tolist(), "success": found.success.tolist(), "reason": found.reason.tolist(),
            "position_error": found.position_error.tolist(), "rotation_error": found.rotation_error.tolist(),
            "iterations": found.iterations.tolist(), "restarts": found.restarts.tolist(),
            "why": [None if success else next(words) for success in found.success],
        }  # fmt: skip
        head = {
            "robot": robot,
            "base": chain.base,
            "tip": chain.tip,
            "q_names": list(chain.q_names),
        }
        return as_json(
            head | {k: v[0] if single and output is None else v for k, v in parts.items()}
        )

    def sheet() -> str:
        rows = np.column_stack([found.q, found.success, found.position_error, found.rotation_error])
        return csv_rows.text([*chain.q_names, *array_files.ERRORS], rows)

    if output is not None:
        content = {".csv": lambda: sheet().encode(), ".npy": lambda: array_files.npy_bytes(found.q)}
        write_whole(
            output, content.get(output.suffix.lower(), lambda: (document() + "\n").encode())()
        )
        if json:
            print(as_json({"written": str(output), "poses": count, "solved": solved}))
        else:
            say(f"{count} × q written to {path_text(output)}, {solved} of {count} solved")
    elif json:
        print(document())
    elif single:
        off = f"{1e3 * found.position_error[0]:.2g} mm and {1e3 * found.rotation_error[0]:.2g} mrad off"
        say(
            f"{name(chain.tip)} in {name(chain.base)}: {'solved, ' + off if solved else 'not solved'}"
        )
        for coordinate, value in zip(chain.q_names, found.q[0], strict=True):
            say(f"  {name(coordinate)} = {number(value, 9)}")
    else:
        print(sheet(), end="")
    if solved < count and not json:
        _complain(found, why, single)


def _complain(found: Solution, why: list[str], single: bool) -> None:
    """The reasons, on stderr: what is on stdout stays a table."""
    bad = np.flatnonzero(~found.success)
    for k, words in list(zip(bad, why, strict=False))[:MOST_TOLD]:
        complain(f"{'the pose' if single else f'pose {k}'}: {words}")
    if len(bad) > MOST_TOLD:
        complain(f"and {len(bad) - MOST_TOLD} more poses; --json tells of each")
