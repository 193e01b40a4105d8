"""`poekin singularity`: how near an arm is to a singularity, and which motion is lost there."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from typer import Exit, Option

from ...analysis.dexterity.jacobian_part import TOLERANCE
from ...analysis.dexterity.manipulability import manipulability
from ...analysis.dexterity.singularity import singularity
from ...errors import InputError
from ...view.view import view
from .. import array_files
from ..formats import draw as pages
from ..formats.units import Deg, Mm, SaidUnits
from ..output import as_json, heading, name, number, say, table
from .arm import Base, File, Json, Numbers, Tip, take
from .poses import words_of

SINGULAR = 1


class Part(StrEnum):
    """Part of the tool's motion that is judged."""

    pose = "pose"
    translation = "translation"
    rotation = "rotation"


At = Annotated[
    str | None,
    Option(
        "--at",
        metavar="Q...",
        help="The coordinates, in rad or m (as Q...; commas may stand between them).",
    ),
]
PartOption = Annotated[
    Part | None,
    Option(
        "--part",
        help="What the tool is asked for (default: translation where that takes all coordinates, else pose).",
    ),
]
Tolerance = Annotated[
    float,
    Option(
        "--tolerance",
        help="Singular at or below this smallest ÷ largest singular value.",
    ),
]


def command(
    file: File,
    q: Numbers = None,
    at: At = None,
    tip: Tip = None,
    base: Base = None,
    part: PartOption = None,
    tolerance: Tolerance = TOLERANCE,
    mm: Mm = None,
    deg: Deg = None,
    draw: pages.Draw = None,
    json: Json = False,
) -> None:
    """Distance of Q from a singularity, and the motion that is lost there. Exit code 0 regular, 1
    singular, 2 error.
    """
    pages.check(draw)
    array_files.check_apart([draw], model=file)
    words = words_of(at)
    if at is not None and not words:
        raise InputError("--at: coordinates expected, got nothing")
    arm = take(file, tip, base, [*words, *(q or ())], None, many=False, units=SaidUnits(mm, deg))
    chain = arm.chain
    (here,) = arm.q
    result = singularity(chain, here, part=part.value if part else None, tolerance=tolerance)
    measures = manipulability(chain, here)
    drawn = None
    if draw is not None:
        drawn = view(result, robot=arm.model)
    if json:
        head = heading(arm.robot, chain) | {"q": here}
        end = {"summary": result.summary(), "manipulability": measures.to_dict()}
        print(as_json(head | result.to_dict() | end))
    else:
        say(f"{name(chain.tip)} in {name(chain.base)}: {result.summary()}\n")
        rows = [
            (p, *(number(float(x), 4) for x in vars(m).values())) for p, m in vars(measures).items()
        ]
        table(("Jacobian (rad, m)", "Yoshikawa", "condition", "smallest singular value"), rows)
    pages.save(drawn, draw, pages.teller(json, table=False))
    raise Exit(SINGULAR if result.singular else 0)
