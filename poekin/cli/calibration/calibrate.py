"""`poekin calibrate`: an arm's true screws from measurements."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

from ...checks import choice
from ...errors import InputError, UnknownName, join_names, quote
from ...formats.dh.table import CONVENTIONS
from ...model.chain import Chain
from ...model.robot import Robot
from ...progress_line import ProgressLine
from ...solve.calibration.calibrate import calibrate
from ...solve.calibration.calibration import Calibration
from ...solve.calibration.exact.from_fk_result import FromFk
from ...solve.calibration.model.parameters import KINDS
from ...solve.calibration.report import changes
from ...solve.calibration.report.summary import MOST_OUTLIERS
from ...solve.calibration.terms.named import BUILDERS
from ...view.view import view
from ..array_files import check_apart, check_place
from ..formats import draw as pages
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model_and_chain
from ..output import as_json, complain, name, say
from . import exact as exact_pairs
from . import measured
from .measured import Measured, MeasurementOptions
from .options.columns import (
    Deg,
    Format,
    Ignore,
    Mm,
    Rename,
    Repeats,
    Unit,
    convention_of,
    listed,
)
from .outputs import ENDINGS, Outputs, say_written

Texts = list[str] | None
Number = float | None
BAD = 1
KNOWN = (*KINDS, *BUILDERS)
"""Kinds of parameters."""
KIND = (
    "What poses are: poses, eye-in-hand or eye-to-hand; else points or distances. "
    "Once for all files, or once a file."
)
PARAMETERS = (
    f"What may change: some of {','.join(KINDS)}, and of the non-geometric terms {','.join(BUILDERS)}; or "
    "auto: screws,home and the terms that pay on held-out data."
)
Data = Annotated[
    list[str],
    Argument(
        metavar="DATA.csv...",
        help="Readings and measurements, one set a file; - is standard input.",
    ),
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
PointOrUnknown = Annotated[
    Texts,
    Option(
        "--point",
        metavar="X,Y,Z|unknown",
        help="A measured point of the tool, in the tip frame, m; may be repeated, of distances the first. "
        "unknown: all points are to be found.",
    ),
]
SeparationsFile = Annotated[
    str | None,
    Option(
        "--separations",
        metavar="FILE.csv",
        help="With --point unknown: known distances of points, columns from, to, distance, sigma.",
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
Gravity = Annotated[
    str | None,
    Option(
        "--gravity",
        metavar="X,Y,Z",
        help="Where gravity pulls in the base frame, for compliance (default: 0,0,-1).",
    ),
]
Frame = Annotated[
    str | None,
    Option("--frame", help="base, or unknown: points or poses stand in a device's own frame."),
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
Output = Annotated[
    list[Path] | None,
    Option(
        "-o",
        "--output",
        help="Everything (.toml), the calibrated robot (.urdf) or a DH table (.csv); may be repeated.",
    ),
]
DhConvention = Annotated[
    str, Option("--dh", help="The convention of a .csv: standard or modified.")
]
Exact = Annotated[
    bool,
    Option("--exact", help="The poses are a controller's own forward kinematics, without noise."),
]
Report = Annotated[Path | None, Option("--report", help="A page with pictures: an .html file.")]


def command(
    file: File,
    files: Data,
    tip: Tip = None,
    base: Base = None,
    kind: Kind = None,
    point: PointOrUnknown = None,
    separations: SeparationsFile = None,
    centre: Centre = None,
    frame: Frame = None,
    gravity: Gravity = None,
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
    rename: Rename = None,
    format: Format = None,
    mm: Mm = None,
    deg: Deg = None,
    unit: Unit = None,
    repeats: Repeats = "keep",
    output: Output = None,
    convention: DhConvention = "standard",
    report: Report = None,
    draw: pages.Draw = None,
    exact: Exact = False,
    json: Json = False,
) -> None:
    """The axes and home pose of an arm as measurements say they are. Exit code 0 done, 1 not
    converged or not to be used, as its first line says, 2 error.
    """
    outputs = Outputs(list(output or ()), convention, report)
    for place in outputs.paths:
        check_place(place, ENDINGS)
    check_place(report, (".html", ".htm"))
    pages.check(draw)
    check_apart(
        [*outputs.paths, report, draw], model=file, measurements=files, separations=separations
    )
    choice(convention, CONVENTIONS, "convention")
    robot, chain = model_and_chain(file, base, tip)
    said = MeasurementOptions(
        kind or (),
        point or (),
        centre,
        frame,
        sigma_angle,
        sigma_length,
        ignore or (),
        convention_of(format, mm, deg, unit, rename),
        repeats,
        separations,
    )
    options: dict[str, Any] = {
        "parameters": _kinds(parameters),
        "loss": loss,
        "joints": listed(joints),
        "prior": _prior(prior_angle, prior_length),
        "on_rank_deficiency": on_rank_deficiency,
        "folds": folds,
        "seed": seed,
    }
    if exact:
        exact_pairs.check(said, options | {"gravity": gravity, "repeats": repeats})
    of_fk: FromFk | None = None
    try:
        given = measured.read(files, chain, said)
        options["conditions"] = _conditions(given, gravity)
        if exact:
            of_fk = exact_pairs.fit(chain, given)
            found = of_fk.calibration
        else:
            found = _calibrated(chain, given, options)
            _complain_of_unread(found, options)
    except (InputError, UnknownName) as fault:
        raise type(fault)(as_options(str(fault))) from fault
    # the controller's own poses are judged by their digits
    verdict = () if exact else found.verdict
    drawn = None if draw is None else view(found)
    try:
        outputs.write(found, robot, given.sources)
        if drawn is not None and draw is not None:
            drawn.save(draw)
            outputs.written.append(str(draw))
    finally:  # no file that cannot be written costs the result
        if json:
            more = {} if of_fk is None else {"exact": of_fk.to_dict()}
            print(as_json(_document(found, robot, given, outputs.written) | more))
        else:
            if verdict:
                say(f"Do NOT use this calibration: {as_options(verdict[0])}.")
            _show(found, robot, given, outputs)
            if of_fk is not None:
                say(f"\n{of_fk}")
    if not found.success:
        complain("the search did not converge: this is the best that was found")
    raise typer.Exit(BAD if verdict or not found.success else 0)


def _kinds(words: Sequence[str] | None) -> str | Sequence[str]:
    """The kinds of parameters that are asked for. Raises: InputError."""
    kinds = tuple(listed(words) or ("screws", "home"))
    if kinds == ("auto",):
        return "auto"
    for kind in kinds:
        if kind not in KNOWN:
            raise InputError(
                f"--parameters: expected some of {join_names(KNOWN, len(KNOWN))}, or auto alone, got"
                f" {quote(kind)}"
            )
    return kinds


def _conditions(given: Measured, gravity: str | None) -> dict[str, Any] | None:
    """Conditions that the files and --gravity say."""
    conditions: dict[str, Any] = dict(given.conditions)
    if gravity is not None:
        conditions["gravity"] = measured.vector(gravity, "--gravity")
    return conditions or None


def _complain_of_unread(found: Calibration, options: dict[str, Any]) -> None:
    """Says which conditions no parameter depends on."""
    given = options["conditions"] or {}
    if given and not found.error_model.terms and options["parameters"] != "auto":
        complain(
            f"nothing depends on {', '.join(given)}: --parameters auto, or the name of a term, takes it"
        )


def _calibrated(chain: Chain, given: Measured, options: dict[str, Any]) -> Calibration:
    """The calibration from measurements, with progress."""
    with ProgressLine("calibrating") as progress:
        return calibrate(
            chain,
            given.q,
            given.sets,
            progress=lambda done, total: progress(done, total, "folds done"),
            **options,
        )


def _prior(angle: float | None, length: float | None) -> dict[str, float] | None:
    """Standard deviations by unit, None without any."""
    given = {unit: value for unit, value in (("rad", angle), ("m", length)) if value is not None}
    return given or None


_OPTIONS = {
    "on_rank_deficiency='fix'": "--on-rank-deficiency fix",
    "with the readings coupled, '": "with --coupling '",
    "covariance=": "--sigma-angle and --sigma-length",
    "folds=0": "--folds 0",
    "give radians (numpy.deg2rad)": "--deg says so",
    "(divide by 1000)": "(divide by 1000, or --mm, which is of sliding joints too)",
    "points: ": "--point: ",
    "points=None": "--point unknown",
    "points=(": "--point (",
    "frame='unknown'": "--frame unknown",
    "centre=None": "no --centre",
    "loss='huber'": "--loss huber",
    "prior={'rad'": "--prior-angle and --prior-length {'rad'",
    "rename=": "--rename",
    "rename: ": "--rename: ",
    "units: ": "--unit: ",
    "parameters=": "--parameters",
    "conditions['gravity']": "--gravity",
    "joints=": "--joints",
    "prior['rad']": "--prior-angle",
    "prior['m']": "--prior-length",
}
_IGNORED = re.compile(r"ignore=\[('([\w.:/+-]+)'|'.*')\] passes it over")


def as_options(message: str) -> str:
    """A message of the library about its parameters, as one about the options."""
    for word, option in _OPTIONS.items():
        message = message.replace(word, option)
    if column := _IGNORED.search(message):
        # a plain name as it is to be typed; any other in quotes, which a shell takes off
        message = message.replace(column[0], f"--ignore {column[2] or column[1]} passes it over")
    return message


def _document(
    found: Calibration,
    robot: Robot,
    given: Measured,
    written: list[str],
) -> dict[str, object]:
    outliers = [o._asdict() | {"source": given.sources[o.row]} for o in found.outliers]
    named = {"robot": robot.name} | found.to_dict()
    return named | {"outliers": outliers, "written": written}


def _show(found: Calibration, robot: Robot, given: Measured, outputs: Outputs) -> None:
    say(f"{name(robot.name)}, {name(found.chain.base)} → {name(found.chain.tip)}")
    say(changes.sentence(found))
    say(found.summary())
    if found.outliers:
        say(f"\nOutliers: {_locations([given.sources[o.row] for o in found.outliers])}")
    say_written(outputs.written, robot)


def _locations(sources: Sequence[str]) -> str:
    """Files and lines, each file named once."""
    lines: dict[str, list[str]] = {}
    for source in sources[:MOST_OUTLIERS]:
        file, _, line = source.rpartition(":")
        lines.setdefault(file, []).append(line)
    words = "; ".join(f"{file}:{', '.join(numbers)}" for file, numbers in lines.items())
    more = len(sources) - MOST_OUTLIERS
    return f"{words} and {more} more" if more > 0 else words
