"""`poekin axes`: angles and distances between the axes of an arm."""

from __future__ import annotations

import math
from typing import Annotated

from typer import Option

from ...analysis.axes import axes
from ...checks import positive
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model
from ..output import as_json, name, number, say, table

TolMm = Annotated[
    float,
    Option("--tol-mm", help="Axes that pass each other by up to this intersect, mm."),
]
TolDeg = Annotated[
    float,
    Option("--tol-deg", help="Angles up to this off are parallel or perpendicular, deg."),
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
    positive(tol_mm, "--tol-mm")
    positive(tol_deg, "--tol-deg")
    report = axes(chain, tol_position=tol_mm / 1e3, tol_rotation=math.radians(tol_deg))
    if json:
        print(as_json({"base": chain.base, "tip": chain.tip} | report.to_dict()))
        return
    say(f"Axes of {name(chain.base)} → {name(chain.tip)} at q = 0\n")
    rows = []
    for p in report.pairs:
        words = p.relation
        if not p.fixed:
            words += " (at q = 0)"
        distance = ""
        if p.distance is not None:
            distance = number(1e3 * p.distance)
        first = f"{p.first} {p.name_first}"
        second = f"{p.second} {p.name_second}"
        rows.append((first, second, words, number(math.degrees(p.angle)), distance))
    table(("axis", "and axis", "are", "angle (deg)", "distance (mm)"), rows, left=3)
    for shape in report.shapes:
        say(shape.summary())
    if not report.shapes:
        say("no spherical joint and no three parallel axes")
