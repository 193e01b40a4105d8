"""`poekin from-circles`: an arm out of sweeps of one joint at a time, without a model of it."""

from __future__ import annotations

import dataclasses
import warnings
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from ....errors import InputError, PoekinWarning
from ....formats import chain_toml
from ....formats.text.atomic_write import write_whole
from ....formats.urdf_text import to_urdf
from ....solve.calibration.circles.from_circles import from_circles
from ...array_files import check_apart, check_place
from ...kinematics.arm import Json
from ...output import as_json, path_text, say
from ..options.columns import Deg, Format, Ignore, Mm, Rename, Unit, convention_of, parts
from .sweep_files import SWEEP, read

BAD = 1
Sweeps = Annotated[
    list[str],
    Argument(
        metavar="SWEEP.csv...",
        help="Readings of all joints, q1, q2, ..., and one measured point, or poses, while one joint "
        "moved: one file a joint, in any order.",
    ),
]
Names = Annotated[
    str | None,
    Option("--joints", metavar="NAME,...", help="Joints from base to tip (default: q1, q2, ...)."),
]
Prismatic = Annotated[
    str | None,
    Option("--prismatic", metavar="NAME,...", help="Joints that slide (default: none)."),
]
Output = Annotated[
    Path | None,
    Option(
        "-o", "--output", help="Where the arm goes: a .urdf file, which is a FILE of all commands."
    ),
]


def command(
    files: Sweeps,
    joints: Names = None,
    prismatic: Prismatic = None,
    ignore: Ignore = None,
    rename: Rename = None,
    format: Format = None,
    mm: Mm = None,
    deg: Deg = None,
    unit: Unit = None,
    output: Output = None,
    json: Json = False,
) -> None:
    """The axes of an arm from sweeps of one joint at a time, without a model. Exit code 0 done, 1 where
    the sweeps do not agree, 2 error.
    """
    check_place(output, (".urdf",))
    check_apart([output], sweeps=files)
    convention = convention_of(format, mm, deg, unit, rename)
    named = parts(joints) if joints else ()
    slides = parts(prismatic) if prismatic else ()
    arm, sweeps = read(files, named, slides, ignore or (), convention)

    def in_files(text: str) -> str:
        """Text with sweeps called after their files, and options in the place of words about them."""
        called = {s.sweep.joint: f"{s.file}, {arm.joint_names[s.sweep.joint]}" for s in sweeps}
        text = text.replace("it is said to be", "it is said to be (--prismatic)")
        return SWEEP.sub(lambda found: called[int(found[1])], text)

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PoekinWarning)  # told with the result
            found = from_circles([s.sweep for s in sweeps], joint_names=arm.joint_names)
    except InputError as fault:
        raise InputError(in_files(str(fault))) from fault
    doubts = [in_files(words) for words in found.warnings]
    if output is not None:
        write_whole(output, to_urdf(found.chain, name="arm").encode())
    if json:
        document = {"chain": chain_toml.to_data(found.chain)} | found.to_dict()
        written = [] if output is None else [str(output)]
        print(as_json(document | {"warnings": doubts, "written": written}))
    else:
        for words in doubts:
            say(f"Do NOT use this arm: {words}.")
        say(dataclasses.replace(found, warnings=()).summary())
        if output is not None:
            say(f"written: {path_text(output)}")
    raise typer.Exit(BAD if doubts else 0)
