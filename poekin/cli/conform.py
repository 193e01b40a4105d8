"""`poekin conform`: hold somebody's exp, log, Jacobian, kinematics or URDF reader to the laws, and grade it."""

from __future__ import annotations

import contextlib
import sys
from typing import Annotated

import typer

from .arm import Json
from .output import Progress, as_json, say

FINDINGS = 1

Subject = Annotated[
    str,
    typer.Argument(
        metavar="MODULE:CLASS", help="The class with the functions, in a module that Python finds from this directory."
    ),
]
Laws = Annotated[
    list[str] | None, typer.Option("--law", help="Hold it to this law only; may be repeated (default: all that apply).")
]
Examples = Annotated[int, typer.Option("--examples", help="Cases of each law at most.", min=1)]
Seconds = Annotated[
    float, typer.Option("--seconds", help="Time for all laws together; shrinking a finding comes on top.", min=0.1)
]


def command(
    subject: Subject, law: Laws = None, examples: Examples = 1000, seconds: Seconds = 50.0, json: Json = False
) -> None:
    """Law by law a grade: exact, good, poor or broken, and a counterexample to paste. This imports and runs MODULE.

    What the class may have and must declare is in the documentation of poekin.testing.conform.subject. Exit code 0
    nothing is poor or broken, 1 something is, 2 error.
    """
    # It needs the extra `testing`, which the other commands do without.
    from ..testing.conform import conform

    if "" not in sys.path:
        sys.path.insert(0, "")
    # What the module prints is not the report.
    with Progress("laws") as progress, contextlib.redirect_stdout(sys.stderr):
        report = conform(subject, law or (), examples, seconds, progress)
    if json:
        print(as_json(report.as_dict()))
    else:
        say(report)
    raise typer.Exit(0 if report.conforms else FINDINGS)
