"""`poekin dh`: any arm as a table of Denavit-Hartenberg parameters."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, cast

import numpy as np
from typer import Option

from ...errors import escape_unprintable, quote
from ...formats import dh
from ...formats.dh.table import PRODUCTS
from ...model.chain import Chain
from .. import array_files
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model_and_chain
from ..output import as_json, matrix, name, number, path_text, say, table

Convention = Annotated[
    str,
    Option("--convention", help="standard (Paul, distal) or modified (Craig, proximal)."),
]
Output = Annotated[
    Path | None,
    Option("-o", "--output", help="Where the table goes: a .toml or .csv file."),
]


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    convention: Convention = "standard",
    output: Output = None,
    json: Json = False,
) -> None:
    """DH parameters of one chain, with base and tool, what was free to choose, and how exact the
    table is.
    """
    array_files.check_apart([output], model=file)
    robot, chain = model_and_chain(file, base, tip)
    result = dh.from_chain(chain, convention=cast(dh.Convention, convention))
    if output is not None:
        dh.write(result.table, output)
    if json:
        print(as_json(_document(chain, result, output)))
    else:
        _show(chain, result)
        if output is not None:
            say(f"Table of {quote(robot.name)} written to {path_text(output)}")


def _document(chain: Chain, result: dh.FromChain, output: Path | None) -> dict[str, object]:
    written = output and str(output)
    return {"base": chain.base, "tip": chain.tip} | result.to_dict() | {"written": written}


def _row(index: int, row: dh.Row, nothing: float) -> tuple[object, ...]:
    cells = []
    for value in (row.theta, row.d, row.a, row.alpha):
        if abs(value) < nothing:
            value = 0.0
        cells.append(number(value, 9))
    cells[row.kind == "prismatic"] += " + x"
    limits = [number(bound) * math.isfinite(bound) for bound in row.limits]
    return index, row.name, row.kind, *cells, *limits


def _show(chain: Chain, result: dh.FromChain) -> None:
    found = result.table
    say(
        f"{found.convention} DH parameters of {name(chain.base)} → {name(chain.tip)}: {PRODUCTS[found.convention]}\n"
    )
    nothing = result.bound * chain.reach  # the table in a file has every digit
    rows = [_row(i, row, nothing) for i, row in enumerate(found.rows, 1)]
    heads = ("", "joint", "kind", "theta (rad)", "d (m)", "a (m)", "alpha (rad)", "lower", "upper")
    table(heads, rows, left=3)
    for what, T in (("Base", found.base), ("Tool", found.tool)):
        if (np.eye(4) != T).any():
            say(f"\n{what}:")
            matrix(np.where(np.abs(T) < nothing, 0.0, T))
    say()
    if chain.nontrivial_coupling is not None or chain.offset.any():
        say(
            "x are the joints' own values: what follows another joint does so by its ratio and offset"
        )
    for statement in found.coupling:
        say(f"Coupling: {escape_unprintable(statement)}")
    say(result.summary())
