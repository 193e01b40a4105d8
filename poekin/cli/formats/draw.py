"""--draw: the page of a result, beside what the command prints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from typer import Option

from ...view.page import Page
from .. import array_files
from ..output import complain, path_text, say

ENDINGS = (".html", ".htm")
Draw = Annotated[
    Path | None,
    Option(
        "--draw",
        metavar="PAGE.html",
        help="Draw it too: one offline page in which the arm moves (.html).",
    ),
]


def check(draw: Path | None) -> None:
    """Refuse a page that cannot be written, before any work is done. Raises: FileError."""
    array_files.check_place(draw, ENDINGS)


def save(page: Page | None, draw: Path | None, tell: Callable[[str], None] | None) -> None:
    """Write a page and tell where it is. Raises: FileError."""
    if page is None or draw is None:
        return
    page.save(draw)
    if tell is not None:
        tell(f"drawn in {path_text(draw)}")


def teller(json: bool, table: bool) -> Callable[[str], None] | None:
    """Way to tell of a page: none beside JSON, on stderr beside a table that is printed."""
    if json:
        return None
    return complain if table else say
