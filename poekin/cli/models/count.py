"""`poekin count`: operations of an arm's Jacobian."""

from __future__ import annotations

from typing import Annotated

import typer

from ...analysis.counting.count_table import MEANING, CountTable, count_table
from ...engine.count import Count
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model_and_chain
from ..output import as_json, name, number, say, table

Idealise = Annotated[
    float | None,
    typer.Option(
        "--idealise",
        metavar="TOL",
        help="Count the arm made exact within TOL (rad and m) too.",
    ),
]

HEADS = ("", "frame", "×", "+", "sin/cos", "with pose: ×", "+", "sin/cos")


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    idealise: Idealise = None,
    json: Json = False,
) -> None:
    """Multiplications, additions and sine/cosine pairs of one Jacobian, in every way there is to
    compute it.
    """
    robot, chain = model_and_chain(file, base, tip)
    counts = count_table(chain, idealise=idealise)
    if json:
        print(as_json({"robot": robot.name} | counts.to_dict()))
    else:
        _show(counts)


def _title(group: str) -> str:
    return group[0].upper() + group[1:]


def _show(counts: CountTable) -> None:
    say(
        f"Operations of one Jacobian of {name(counts.base)} → {name(counts.tip)}: {counts.joints} joints, "
        f"{counts.coordinates} coordinates\n"
    )
    rows: list[tuple[object, ...]] = []
    for group in counts.groups:
        rows.append((_title(group),))
        for r in counts.of(group):
            cells = (*_cells(r.jacobian), *_cells(r.with_pose))
            rows.append(("  " + r.what, r.frame, *cells))
    table(HEADS, rows, left=2)
    say(
        "×: multiplications; +: additions and subtractions; sin/cos: angles of which both are needed; no divisions\n"
    )
    for group in counts.groups:
        say(f"{_title(group)}: {MEANING[group]}")
    say()
    ideal = counts.idealised
    if ideal is not None:
        say(
            f"The idealised arm's pose is within {number(ideal.position_bound, 2)} m and "
            f"{number(ideal.rotation_bound, 2)} rad of the arm's"
        )
        for words in ideal.changes:
            say(f"  {name(words)}")
    for words in counts.verdict:
        say(words)


def _cells(cost: Count | None) -> tuple[object, ...]:
    if cost is None:
        return "", "", ""
    return cost.multiplications, cost.additions, cost.sine_cosine_pairs
