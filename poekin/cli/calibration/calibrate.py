"""`poekin calibrate`: an arm's true screws from measurements."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

from ...errors import InputError, UnknownName, quote
from ...formats import dh
from ...formats.dh.table import CONVENTIONS
from ...formats.text.atomic_write import write_whole
from ...model.robot import Robot
from ...solve.calibration.calibrate import calibrate
from ...solve.calibration.calibration import Calibration
from ...solve.calibration.report import changes, html_report
from ...solve.calibration.report.summary import MOST_OUTLIERS
from ..array_files import check_apart, check_place
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model
from ..output import Progress, as_json, complain, name, path_text, say, table
from . import measured
from .measured import Measured, MeasurementOptions

Texts = list[str] | None
Number = float | None
NOT_CONVERGED = 1
KIND = (
    "What poses are: poses, eye-in-hand or eye-to-hand; else points or distances. "
    "Once for all files, or once a file."
)
PARAMETERS = "What may change: some of screws,home,offsets,gains,pitch."
Data = Annotated[
    list[str],
    Argument(metavar="DATA.csv...", help="Readings and measurements, one set a file."),
]
Kind = Annotated[Texts, Option("--kind", help=KIND)]
Point = Annotated[
    Texts,
    Option(
        "--point",
        metavar="X,Y,Z",
        help="A measured point of the tool, in the tip frame, m; may be repeated, of distances the first.",
    ),
]
Centre = Annotated[
    str | None,
    Option(
        "--centre",
        metavar="X,Y,Z",
        help="The point that distances are from (default: unknown).",
    ),
]
Frame = Annotated[
    str | None,
    Option("--frame", help="base, or unknown: points stand in a device's own frame."),
]
Parameters = Annotated[Texts, Option("--parameters", help=f"{PARAMETERS} Default: screws,home.")]
Joints = Annotated[
    Texts,
    Option("--joints", metavar="NAME,...", help="Joints that may change (default: all)."),
]
Loss = Annotated[str, Option("--loss", help="linear, or robust: huber, cauchy, tukey.")]
PriorAngle = Annotated[
    Number,
    Option("--prior-angle", help="How far angles may be off nominal, rad."),
]
PriorLength = Annotated[
    Number,
    Option("--prior-length", help="How far lengths may be off nominal, m."),
]
SigmaAngle = Annotated[
    Number,
    Option("--sigma-angle", help="Standard deviation of measured angles, rad."),
]
SigmaLength = Annotated[
    Number,
    Option("--sigma-length", help="Standard deviation of measured lengths, m."),
]
OnRankDeficiency = Annotated[
    str,
    Option(
        "--on-rank-deficiency",
        help="raise, or fix: unobserved directions stay at nominal values.",
    ),
]
Folds = Annotated[int, Option("--folds", help="Parts that are held out in turn; 0: none.", min=0)]
Seed = Annotated[int, Option("--seed", help="Of the drawing of these parts.", min=0)]
Ignore = Annotated[
    Texts,
    Option("--ignore", metavar="COLUMN", help="A column to pass over; may be repeated."),
]
Output = Annotated[
    list[Path] | None,
    Option(
        "-o",
        "--output",
        help="Everything (.toml), the calibrated robot (.urdf) or a DH table (.csv); may be repeated.",
    ),
]
Convention = Annotated[str, Option("--dh", help="The convention of a .csv: standard or modified.")]
Report = Annotated[Path | None, Option("--report", help="A page with pictures: an .html file.")]


def command(
    file: File,
    files: Data,
    tip: Tip = None,
    base: Base = None,
    kind: Kind = None,
    point: Point = None,
    centre: Centre = None,
    frame: Frame = None,
    parameters: Parameters = None,
    joints: Joints = None,
    loss: Loss = "linear",
    prior_angle: PriorAngle = None,
    prior_length: PriorLength = None,
    sigma_angle: SigmaAngle = None,
    sigma_length: SigmaLength = None,
    on_rank_deficiency: OnRankDeficiency = "raise",
    folds: Folds = 5,
    seed: Seed = 0,
    ignore: Ignore = None,
    output: Output = None,
    convention: Convention = "standard",
    report: Report = None,
    json: Json = False,
) -> None:
    """The axes and home pose of an arm as measurements say they are. Exit code 0 done, 1 not
    converged, 2 error.
    """
    outputs = list(output or ())
    for place in outputs:
        check_place(place, _ENDINGS)
    if report:
        check_place(report, (".html", ".htm"))
    check_apart([*outputs, report], model=file, measurements=files)
    if convention not in CONVENTIONS:
        raise InputError(f"--dh: expected standard or modified, got {quote(convention)}")
    robot = model(file)
    chain = robot.chain(base=base, tip=tip)
    said = MeasurementOptions(
        kind or (),
        point or (),
        centre,
        frame,
        sigma_angle,
        sigma_length,
        ignore or (),
    )
    options: dict[str, Any] = {
        "parameters": _listed(parameters) or ("screws", "home"),
        "loss": loss,
        "joints": _listed(joints),
        "prior": _prior(prior_angle, prior_length),
        "on_rank_deficiency": on_rank_deficiency,
        "folds": folds,
        "seed": seed,
    }
    try:
        given = measured.read(files, chain, said)
        with Progress("calibrating") as progress:
            found = calibrate(
                chain,
                given.q,
                given.sets,
                progress=lambda done, total: progress(done, total, "folds done"),
                **options,
            )
    except (InputError, UnknownName) as fault:
        raise type(fault)(_as_options(str(fault))) from fault
    _write(found, robot, outputs, convention, report, given)
    written = [str(path) for path in (*outputs, report) if path]
    if json:
        print(as_json(_document(found, robot, given, written)))
    else:
        _show(found, robot, given, written)
    if not found.success:
        complain("the search did not converge: this is the best that was found")
    raise typer.Exit(0 if found.success else NOT_CONVERGED)


def _prior(angle: float | None, length: float | None) -> dict[str, float] | None:
    """Standard deviations by unit, None without any."""
    given = {unit: value for unit, value in (("rad", angle), ("m", length)) if value is not None}
    return given or None


_ENDINGS: tuple[str, ...] = (".toml", ".urdf", ".csv")
_OPTIONS = {
    "on_rank_deficiency='fix'": "--on-rank-deficiency fix",
    "covariance=": "--sigma-angle and --sigma-length",
    "folds=0": "--folds 0",
    "parameters=": "--parameters",
    "joints=": "--joints",
    "prior['rad']": "--prior-angle",
    "prior['m']": "--prior-length",
}
_IGNORED = re.compile(r"ignore=\[('([\w.:/+-]+)'|'.*')\] passes it over")
_NAMES = {"points": "--point"} | {
    word: f"--{word.replace('_', '-')}"
    for word in ("kind", "parameters", "joints", "loss", "folds", "seed", "on_rank_deficiency")
}


def _as_options(message: str) -> str:
    """A message of the library about its parameters, as one about the options."""
    for word, option in _OPTIONS.items():
        message = message.replace(word, option)
    if column := _IGNORED.search(message):
        # a plain name as it is to be typed; any other in quotes, which a shell takes off
        message = message.replace(column[0], f"--ignore {column[2] or column[1]} passes it over")
    what, colon, rest = message.partition(":")
    return _NAMES.get(what, what) + colon + rest


def _listed(words: Sequence[str] | None) -> list[str] | None:
    """The names in a repeated option, each of which may hold several with commas between."""
    return None if words is None else [part.strip() for word in words for part in word.split(",")]


def _write(
    found: Calibration,
    robot: Robot,
    outputs: Sequence[Path],
    convention: str,
    report: Path | None,
    given: Measured,
) -> None:
    """Each file, whole; first the one that keeps everything, should another one fail for what is in
    it.
    """
    for path in outputs:
        if path.suffix.lower() == ".toml":
            found.save(path)
    texts: list[tuple[Path, str]] = []
    for path in outputs:
        if path.suffix.lower() == ".urdf":
            texts.append((path, found.to_urdf(robot)))
        elif path.suffix.lower() == ".csv":
            made = found.to_dh(convention)  # type: ignore[arg-type]  # refused there with the choices
            texts.append((path, dh.table_io.make_text(made.table, ".csv")))
            for words in made.warnings:
                complain(f"warning: {words}")
    if report is not None:
        title = f"Calibration of {robot.name}: {found.chain.base} to {found.chain.tip}"
        texts.append((report, html_report.html(found, title, given.sources)))
    for path, text in texts:
        write_whole(path, text.encode())


def _document(
    found: Calibration,
    robot: Robot,
    given: Measured,
    written: list[str],
) -> dict[str, object]:
    outliers = [o._asdict() | {"source": given.sources[o.row]} for o in found.outliers]
    named = {"robot": robot.name} | found.to_dict()
    return named | {"outliers": outliers, "written": written}


def _show(found: Calibration, robot: Robot, given: Measured, written: Sequence[str]) -> None:
    say(f"{name(robot.name)}, {name(found.chain.base)} → {name(found.chain.tip)}")
    say(changes.sentence(found))
    say(found.summary())
    moved = changes.joints(found)
    if moved:
        say()
        table(changes.HEADS, [changes.row(j) for j in moved])
    if found.outliers:
        say(f"\nOutliers: {_locations([given.sources[o.row] for o in found.outliers])}")
    for path in written:
        say(f"written: {path_text(path)}")


def _locations(sources: Sequence[str]) -> str:
    """Files and lines, each file named once."""
    lines: dict[str, list[str]] = {}
    for source in sources[:MOST_OUTLIERS]:
        file, _, line = source.rpartition(":")
        lines.setdefault(file, []).append(line)
    words = "; ".join(f"{file}:{', '.join(numbers)}" for file, numbers in lines.items())
    more = len(sources) - MOST_OUTLIERS
    return f"{words} and {more} more" if more > 0 else words
