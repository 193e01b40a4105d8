"""Output of the commands: plain text, tables, numbers, JSON; names of files escaped."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence
from typing import Literal

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..errors import escape_unprintable, quote
from ..model.chain import Chain
from ..progress_line import CLEAR_LINE
from ..results import plain as plain_data

LONGEST_PATH = 400


def plain(text: object) -> str:
    """Text with unprintable characters escaped and line breaks kept."""
    return escape_unprintable(text, keep="\n")


def name(text: object) -> str:
    """A name out of a file, on one line."""
    return plain(text).replace("\n", "\\n")


def path_text(path: object) -> str:
    """A path in quotes, cut where it is very long."""
    return quote(path, LONGEST_PATH)


def number(value: float, digits: int = 6) -> str:
    """A number for reading, to so many significant digits; -0 is 0."""
    return f"{float(value) + 0.0:.{digits}g}"


def complain(message: str) -> None:
    """A warning or an error on stderr; on a terminal it takes the line that progress may stand on."""
    clear = CLEAR_LINE * sys.stderr.isatty()
    print(clear + plain(f"poekin: {message}"), file=sys.stderr)


def say(text: object = "") -> None:
    """One paragraph on stdout."""
    print(plain(text))


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], *, left: int = 1) -> None:
    """A table on stdout; the first `left` columns are words, the others numbers, right-aligned.

    Where stdout is no terminal, lines are as long as they need to be.
    """
    grid = Table(box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for i, column in enumerate(columns):
        justify: Literal["left", "right"] = "right"
        if i < left:
            justify = "left"
        grid.add_column(Text(column), justify=justify, overflow="fold")
    for row in rows:
        # Text, not str: rich would read [b] in a joint's name as markup.
        grid.add_row(*(Text(name(cell)) for cell in row))
    # Its own console each time: stdout may be another one by now, as in tests.
    if sys.stdout.isatty():
        Console().print(grid)
    else:
        Console(width=100_000).print(grid)


def matrix(values: np.ndarray, labels: Sequence[str] = (), columns: Sequence[str] = ()) -> None:
    """A matrix on stdout to nine digits, with names of rows and columns where given."""
    cells = [[number(v, 9) for v in row] for row in values]
    tags = list(labels) or [""] * len(cells)
    if columns:
        cells.insert(0, list(map(name, columns)))
        tags.insert(0, "")
    widths = [max(len(row[j]) for row in cells) for j in range(values.shape[1])]
    side = max(map(len, labels), default=0)
    for tag, row in zip(tags, cells, strict=True):
        print(" ", tag.ljust(side), *(cell.rjust(w) for cell, w in zip(row, widths, strict=True)))


def heading(robot: str, chain: Chain, **extra: object) -> dict[str, object]:
    """Names of robot, base, tip and coordinates, with which the JSON of a chain begins."""
    names = {"robot": robot, "base": chain.base, "tip": chain.tip}
    return names | extra | {"q_names": list(chain.q_names)}


def as_json(value: object) -> str:
    """JSON text of dicts, lists, arrays and numbers; what is no finite number is null."""
    return json.dumps(plain_data(value), allow_nan=False)
