"""`poekin choose-poses`: where to measure, so that the calibrated arm errs least."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple, cast

import numpy as np
from typer import Argument, Option

from ...checks import choice
from ...errors import InputError, UnknownName
from ...formats.text import csv_rows
from ...groups.arrays import Array
from ...model.chain import Chain
from ...progress_line import ProgressLine
from ...solve.calibration.design.choice import Choice
from ...solve.calibration.design.choose import choose_poses
from ...solve.calibration.design.exchange import CRITERIA, Criterion
from ...solve.calibration.measurements.data import KINDS
from ...solve.calibration.measurements.measurement import Measurement
from .. import array_files
from ..formats.units import SaidUnits
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model_and_chain
from ..output import as_json, complain, heading, path_text, say
from . import measured as measured_files
from .calibrate import (
    Centre,
    Joints,
    Parameters,
    Point,
    SigmaAngle,
    SigmaLength,
    as_options,
)
from .measured import MeasurementOptions
from .options import places
from .options.columns import Deg, Format, Ignore, Mm, Rename, Unit, convention_of, listed

TABLES = (".csv", ".npy")
EXAMPLES: dict[str, Any] = {"poses": np.eye(4)[None], "points": 0.0, "distances": [1.0]}
"""Kinds of measurements without a camera, and a value of each."""
Number = Annotated[int, Argument(metavar="N", help="How many configurations.", min=1)]
Candidates = Annotated[
    str,
    Option(
        "--candidates",
        metavar="FILE|K",
        help="Configurations to choose from: a .csv or .npy file, or how many to draw.",
    ),
]
MeasuredFile = Annotated[
    str | None,
    Option(
        "--measured",
        metavar="DATA.csv",
        help="What was measured before, as calibrate takes it: the N that help most beside it.",
    ),
]
Kind = Annotated[
    str | None,
    Option("--kind", help="What will be measured: poses, points or distances."),
]
By = Annotated[str, Option("--criterion", help=f"What is to be best: {', '.join(CRITERIA)}.")]
Seed = Annotated[int, Option("--seed", help="Of what is drawn.", min=0)]
Output = Annotated[
    Path | None,
    Option("-o", "--output", help="Where the configurations go: a .csv or .npy file."),
]


def command(
    file: File,
    n: Number,
    tip: Tip = None,
    base: Base = None,
    candidates: Candidates = "2000",
    measured: MeasuredFile = None,
    kind: Kind = None,
    point: Point = None,
    centre: Centre = None,
    box: places.BoxNumbers = None,
    cone: places.ConeNumbers = None,
    workspace: places.WorkspaceNumbers = None,
    criterion: By = "prediction",
    parameters: Parameters = None,
    joints: Joints = None,
    sigma_angle: SigmaAngle = None,
    sigma_length: SigmaLength = None,
    ignore: Ignore = None,
    rename: Rename = None,
    format: Format = None,
    mm: Mm = None,
    deg: Deg = None,
    unit: Unit = None,
    seed: Seed = 0,
    output: Output = None,
    json: Json = False,
) -> None:
    """The N configurations at which measuring tells most, and by how much they beat random ones."""
    array_files.check_place(output, TABLES)
    given = None if candidates.isdecimal() else candidates
    array_files.check_apart([output], model=file, candidates=given, measurements=measured)
    convention = convention_of(format, mm, deg, unit, rename)
    units = SaidUnits(convention.mm, convention.deg)
    robot, chain = model_and_chain(file, base, tip)
    said = MeasurementOptions(
        [kind] if kind else (),
        point or (),
        centre,
        None,
        sigma_angle,
        sigma_length,
        ignore or (),
        convention,
    )
    of_tool = places.tool_point(said)
    allowed = [places.box(box, "--box", units, of_tool), places.cone(cone, units, of_tool)]
    try:
        before, sets = _measurements(chain, measured, said)
        with ProgressLine("choosing") as progress:
            found = choose_poses(
                chain,
                n,
                _candidates(candidates, chain, units),
                measurements=sets,
                parameters=cast(Any, listed(parameters) or ("screws", "home")),
                joints=listed(joints),
                criterion=cast(Criterion, criterion),
                measured=before,
                allowed=[place for place in allowed if place is not None],
                workspace=places.box(workspace, "--workspace", units, of_tool),
                seed=seed,
                progress=lambda done, total: progress(done, total, "steps done"),
            )
    except (InputError, UnknownName) as fault:
        raise type(fault)(_as_options(str(fault))) from fault
    _give(robot.name, chain, found, output, json, units)


def _candidates(text: str, chain: Chain, units: SaidUnits) -> Array | int:
    """Number of candidates to draw, or the candidates (K, m) in a file."""
    if text.isdecimal():
        return int(text)
    with ProgressLine(f"reading {array_files.called(text)}") as progress:
        rows = array_files.read_configurations(text, units.columns(chain), progress)
    return units.to_si(rows, chain)


class _Before(NamedTuple):
    """Readings (M, m) that were measured before, if any, and examples of what is measured."""

    q: Array | None
    sets: list[Measurement]


def _measurements(chain: Chain, file: str | None, said: MeasurementOptions) -> _Before:
    """Measurements as in a file, else as the options say. Raises: InputError."""
    if file is not None:
        given = measured_files.read([file], chain, said)
        for s in given.sets:
            if s.what.lower() not in EXAMPLES:
                raise InputError(f"--measured: {_no_camera(s.what)}")
        return _Before(given.q, given.sets)
    kind = next(iter(said.kind), "points" if said.point else "poses")
    if kind in KINDS and kind not in EXAMPLES:
        raise InputError(f"--kind: {_no_camera(kind)}")
    choice(kind, EXAMPLES, "--kind")
    measured_files.check_fit(said, [kind])
    count = max(len(said.point), 1)
    value = np.zeros((1, count, 3)) if kind == "points" else EXAMPLES[kind]
    known = measured_files.known_arguments(said, kind, count)
    made: Any = KINDS[kind]
    return _Before(None, [made(value, **known)])


def _no_camera(kind: str) -> str:
    return (
        f"expected poses, points or distances, got {kind}: where its camera and board are roughly is told"
        " in Python, poekin.choose_poses(measurements=...)"
    )


_OPTIONS = {
    "n: ": "N: ",
    "candidates[": "--candidates, row [",
    "allowed: ": "--box, --cone: ",
    "measurements: Distances: expected centre=": "--centre: expected with distances",
}
_PREDICATES = "predicates that allow more, or candidates (K, m) that they allow"


def _as_options(message: str) -> str:
    """A message of `choose_poses` as one about the options."""
    for word, option in _OPTIONS.items():
        if message.startswith(word):
            message = option + message.removeprefix(word)
    return as_options(message.replace(_PREDICATES, "a larger one, or --candidates that it allows"))


def _give(
    robot: str,
    chain: Chain,
    found: Choice,
    output: Path | None,
    json: bool,
    units: SaidUnits,
) -> None:
    q = units.from_si(found.q, chain)
    sheet = csv_rows.text(units.header(chain), q)
    written: Sequence[str] = ()
    if output is not None:
        array_files.write_result(output, lambda: sheet, q, lambda: "")
        written = [str(output)]
    if json:
        document = heading(robot, chain) | found.to_dict()
        print(as_json(document | {"written": written}))
    elif output is not None:
        say(found)
        say(f"written: {path_text(output)}")
    else:  # what is on stdout stays a table
        complain(str(found))
        print(sheet, end="")
