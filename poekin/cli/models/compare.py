"""`poekin compare`: where two models of one arm differ."""

from __future__ import annotations

import math
from typing import Annotated

from typer import Argument, Exit, Option

from ...analysis.compare.compare import compare
from ...analysis.compare.comparison import Comparison, Outcome
from ...analysis.compare.differences.conventions import (
    BUT_NAMES,
    CONVENTIONS,
    Convention,
    checked,
)
from ...analysis.compare.differences.ends import Chosen, Remedy, remedies
from ...analysis.compare.joint_table import HEADS, joint_row
from ...checks import positive
from ...errors import InputError, join_names
from ...model.robot import Robot
from ...view.page import page
from ...view.scenes.comparison import comparison_scene
from .. import array_files
from ..formats import draw as pages
from ..formats.frame_numbers import frame_layout, frame_lines, frame_numbers
from ..formats.units import Deg, Mm
from ..kinematics.arm import FILE_HELP, Base, Json, Seed, Tip
from ..kinematics.poses import Quaternion
from ..model import models
from ..output import as_json, name, path_text, say, table

DEFAULT = ",".join(BUT_NAMES)
EXIT: dict[Outcome, int] = {"same": 0, "differ": 1, "conventions": 3}

A = Annotated[str, Argument(metavar="A", help=FILE_HELP)]
B = Annotated[str, Argument(metavar="B", help="The model that it is compared with.")]
TipB = Annotated[
    str | None,
    Option("--tip-b", help="The link in B (default: as --tip where B has that link)."),
]
BaseB = Annotated[
    str | None,
    Option("--base-b", help="B's base (default: as --base where B has that link)."),
]
TolMm = Annotated[float, Option("--tol-mm", help="Lengths up to this are the same, mm.")]
TolDeg = Annotated[
    float,
    Option("--tol-deg", help="Angles up to this are the same, degrees."),
]
Strict = Annotated[
    bool,
    Option("--strict", help="Show the joints as they stand, aligning nothing."),
]
Same = Annotated[
    str,
    Option(
        "--same",
        metavar="WORDS",
        help=f"What may not differ, out of {','.join(CONVENTIONS)}; '' for the axes alone.",
    ),
]
Format = Annotated[
    str | None,
    Option(
        "--format",
        metavar="FORMAT",
        help="Print base and tool of the alignment as a controller takes them: kuka, ur, ..., as in ik.",
    ),
]
Samples = Annotated[
    int,
    Option("--samples", help="Random configurations for the pose errors.", min=1),
]


def command(
    a: A,
    b: B,
    tip: Tip = None,
    tip_b: TipB = None,
    base: Base = None,
    base_b: BaseB = None,
    tol_mm: TolMm = 0.01,
    tol_deg: TolDeg = 0.001,
    same: Same = DEFAULT,
    strict: Strict = False,
    format: Format = None,
    quaternion: Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    samples: Samples = 200,
    seed: Seed = 0,
    draw: pages.Draw = None,
    json: Json = False,
) -> None:
    """Two models of one arm, joint by joint: axes, zero positions, directions. Exit code 0 the same,
    1 differ, 2 error, 3 the same arm in other conventions.
    """
    pages.check(draw)
    if draw is not None:
        array_files.check_apart([draw], a=a, b=b)
    counted = _conventions(same)
    chosen = frame_layout(format, quaternion, mm, deg)
    robot_a, robot_b = models(a, b)
    one = chosen_chain(robot_a, a, "--tip", base, tip)
    other = chosen_chain(robot_b, b, "--tip-b", base_b, tip_b, base, tip)
    positive(tol_mm, "--tol-mm")
    positive(tol_deg, "--tol-deg")
    result = compare(
        one.chain,
        other.chain,
        same=counted,
        strict=strict,
        tol_position=tol_mm / 1e3,
        tol_rotation=math.radians(tol_deg),
        samples=samples,
        seed=seed,
    )
    drawn = None
    if draw is not None:
        title = f"{robot_a.name} and {robot_b.name}"
        drawn = page(comparison_scene(result, title=title))
    if json:
        frames = {} if chosen is None else frame_numbers(result, chosen)
        files = {"a": _where(a, one), "b": _where(b, other)}
        print(as_json(files | result.to_dict() | frames))
    else:
        _show(result, one, other, [] if chosen is None else frame_lines(result, chosen))
    pages.save(drawn, draw, pages.teller(json, table=False))
    raise Exit(EXIT[result.outcome])


def _conventions(same: str) -> tuple[Convention, ...]:
    words = [word.strip() for word in same.split(",")]
    if words == [""]:
        words = []
    return checked(words)


def chosen_chain(
    robot: Robot,
    file: str,
    option: str,
    base: str | None,
    tip: str | None,
    base_like: str | None = None,
    tip_like: str | None = None,
) -> Chosen:
    """Chain of a robot; without base or tip those of the other model, where it has such links.

    Raises: InputError where there are several tips.
    """
    if base is None and base_like in robot.links:
        base = base_like
    if tip is None and tip_like in robot.links:
        tip = tip_like
    if tip is None and len(robot.leaves) > 1:
        raise InputError(
            f"{path_text(file)} is a tree: say which tip with {option}; tips: {join_names(robot.leaves)}"
        )
    return Chosen(robot, robot.chain(base=base, tip=tip))


def _where(file: str, arm: Chosen) -> dict[str, str]:
    return {"file": file, "base": arm.chain.base, "tip": arm.chain.tip}


def _show(
    result: Comparison,
    a: Chosen,
    b: Chosen,
    frames: list[str],
) -> None:
    ends = [name(end) for arm in (a, b) for end in (arm.chain.base, arm.chain.tip)]
    say("A: {} → {}; B: {} → {}\n".format(*ends))
    rows = [joint_row(joint, result) for joint in result.joints]
    if rows:
        table(HEADS, rows, left=4)
    for remedy in remedies(result, a, b):
        say(f"Remedy: {_remedy_words(remedy)}")
    # The outcome comes last.
    say("\n".join([*frames, result.summary()]))


def _remedy_words(remedy: Remedy) -> str:
    """As in "model b: it has a longer base: --base-b base_link"."""
    option = f"--{remedy.end}"
    if remedy.model == "b":
        option += "-b"
    return f"model {remedy.model}: {remedy.reason}: {option} {name(remedy.link)}"
