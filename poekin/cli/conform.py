"""`poekin conform`: test and grade other exp, log, Jacobian, kinematics and URDF code by the laws."""

from __future__ import annotations

import enum
import sys
from typing import Annotated

from typer import Argument, Exit, Option

from ..progress_line import ProgressLine
from .kinematics.arm import Json
from .output import as_json, say

FINDINGS = 1

Subject = Annotated[
    str,
    Argument(
        metavar="MODULE:CLASS",
        help="The class with the functions, in a module that Python finds from this directory.",
    ),
]
Laws = Annotated[
    list[str] | None,
    Option(
        "--law",
        help="Hold it to this law only; may be repeated (default: all that apply).",
    ),
]
Without = Annotated[
    list[str] | None,
    Option("--except", help="Leave out this law; may be repeated."),
]
Examples = Annotated[
    int | None,
    Option(
        "--examples",
        help="Cases of each law (default: 100 to 400, each law its own).",
        min=1,
    ),
]
Seconds = Annotated[
    float,
    Option(
        "--seconds",
        help="Time for all laws together; shrinking a finding comes on top. Said where it runs out.",
        min=0.1,
    ),
]
Limit = Annotated[
    float,
    Option("--limit", help="Seconds that one call may take, with what it compiles.", min=0.1),
]


class Bar(enum.StrEnum):
    """Grades, as the command line has them."""

    EXACT = "exact"
    GOOD = "good"
    POOR = "poor"


AtMost = Annotated[
    Bar,
    Option("--at-most", help="The worst grade that is let pass with exit code 0."),
]


def command(
    subject: Subject,
    law: Laws = None,
    without: Without = None,
    at_most: AtMost = Bar.GOOD,
    examples: Examples = None,
    seconds: Seconds = 600.0,
    limit: Limit = 60.0,
    json: Json = False,
) -> None:
    """Law by law a grade: exact, good, poor or broken, and a counterexample to paste. This imports
    and runs MODULE.

    It runs in a process of its own, so that a crash or a hang is a finding like others. What the
    class may have and must declare is in the documentation of
    poekin.testing.conform.subjects.subject. Exit code 0 nothing is worse than --at-most, 1
    something is, 2 error.
    """
    # It needs the extra `testing`, which the other commands do without.
    from ..testing.conform import Grade, Limits, conform

    if "" not in sys.path:
        sys.path.insert(0, "")
    with ProgressLine("laws") as progress:
        report = conform(
            subject,
            law or (),
            examples,
            seconds,
            progress,
            leave_out=without or (),
            at_most=Grade[at_most.name],
            limits=Limits(limit),
        )
    if json:
        print(as_json(report.to_dict()))
    else:
        say(report)
    raise Exit(0 if report.conforms else FINDINGS)
