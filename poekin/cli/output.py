"""What the commands print: plain text, tables, numbers, JSON, progress. Names out of files are
shown harmlessly.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..errors import quote

LONGEST_PATH = 400
PAUSE = 10.0
"""Seconds of silence between two lines of progress where stderr is no terminal."""


def plain(text: object) -> str:
    """Text without anything a terminal would obey: control and bidirectional characters escaped,
    line breaks kept.
    """
    return "".join(
        c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode()
        for c in str(text)
    )


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
    clear = "\r\x1b[K" if sys.stderr.isatty() else ""
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
        grid.add_column(Text(column), justify="left" if i < left else "right", overflow="fold")
    for row in rows:
        # Text, not str: rich would read [b] in a joint's name as markup.
        grid.add_row(*(Text(name(cell)) for cell in row))
    # Its own console each time: stdout may be another one by now, as in tests.
    width = None if sys.stdout.isatty() else 100_000
    Console(width=width).print(grid)


def matrix(values: np.ndarray, labels: Sequence[str] = (), columns: Sequence[str] = ()) -> None:
    """A matrix on stdout to nine digits, with names of rows and columns where given."""
    cells = [[number(v, 9) for v in row] for row in values]
    heads = ([list(map(name, columns))] if columns else []) + cells
    widths = [max(len(row[j]) for row in heads) for j in range(values.shape[1])]
    side = max(map(len, labels), default=0)
    tags = ([""] if columns else []) + (list(labels) or [""] * len(cells))
    for tag, row in zip(tags, heads, strict=True):
        print(" ", tag.ljust(side), *(cell.rjust(w) for cell, w in zip(row, widths, strict=True)))


def as_json(value: Any) -> str:
    """JSON text of dicts, lists, arrays and numbers; what is no finite number is null."""

    def clean(item: Any) -> Any:
        if isinstance(item, np.ndarray):
            return clean(item.tolist())
        if isinstance(item, dict):
            return {str(k): clean(v) for k, v in item.items()}
        if isinstance(item, (list, tuple)):
            return [clean(v) for v in item]
        if isinstance(item, float):
            return item if math.isfinite(item) else None
        return item

    return json.dumps(clean(value), allow_nan=False)


class Progress:
    """How far long work has come, on stderr: one line that is rewritten on a terminal, else a line
    now and then.

    Parameters: what (the work's name). Short work shows nothing. Use it as a context manager; call
    it with
    (done, total, what is being done), total 0 where nobody knows it.
    """

    def __init__(self, what: str):
        self.what = what
        self.terminal = sys.stderr.isatty()
        self.shown, self.last = False, time.monotonic()

    def __call__(self, done: int, total: int, text: str = "") -> None:
        """Say how far the work is, if it is time to say something."""
        now = time.monotonic()
        if now - self.last < (
            0.1 if self.shown and self.terminal else 0.5 if self.terminal else PAUSE
        ):
            return
        self.last, self.shown = now, True
        line = name(
            f"{self.what}: {done}"
            + (f" of {total}" if total else "")
            + (f", {text}" if text else "")
        )
        if self.terminal:
            print(f"\r\x1b[K{line[:100]}", end="", file=sys.stderr, flush=True)
        else:
            print(line, file=sys.stderr)

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self.terminal and self.shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
