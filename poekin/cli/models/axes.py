"""`poekin axes`: how the axes of an arm lie to each other."""

from __future__ import annotations

from typing import Annotated

import typer

from ...analysis.axes import axes
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model
from ..output import as_json, name, number, say, table

TolMm = Annotated[
    float, typer.Option("--tol-mm", help="Axes that pass each other by up to this intersect, mm.")
]
TolDeg = Annotated[
    float,
    typer.Option("--tol-deg", help="Angles up to this off are parallel or perpendicular, deg."),
]


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    tol_mm: TolMm = 0.01,
    tol_deg: TolDeg = 0.001,
    json: Json = False,
) -> None:
    """Pairs of axes: parallel, perpendicular, intersecting, or by how much they miss it; spherical
    wrist, Pieper, …
    """
    chain = model(file).chain(base=base, tip=tip)
    report = axes(chain, tol_mm=tol_mm, tol_deg=tol_deg)
    if json:
        print(as_json({"base": chain.base, "tip": chain.tip} | report.as_dict()))
        return
    say(f"Axes of {name(chain.base)} → {name(chain.tip)} at q = 0\n")
    rows = [
        (f"{p.first} {p.name_first}", f"{p.second} {p.name_second}", p.words + ("" if p.fixed else " (at q = 0)"),
         number(p.angle), "" if p.distance is None else number(p.distance))
        for p in report.pairs
    ]  # fmt: skip
    table(("axis", "and axis", "are", "angle (deg)", "distance (mm)"), rows, left=3)
    for shape in report.shapes:
        say(shape.words)
    if not report.shapes:
        say("no spherical joint and no three parallel axes")
