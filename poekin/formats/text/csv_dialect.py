"""Cells of CSV lines: the separator out of the first line, and the decimal mark that goes with it.

A semicolon or a tab outside quotes separates, and a comma in a cell is then the decimal mark; else
a comma separates, and where there is none, blanks. A comma is never both.
"""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterable, Iterator, Sequence

from ...errors import FileError, InputError, quote
from ...model.provenance import warn
from .numbers import real

Line = tuple[int, list[str]]
_QUOTED = re.compile(r'"[^"]*"')
_SAID = re.compile(r"sep=([;,\t])", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d*(?:[eE][+-]?\d+)?\s*")
# not where it is the name of a column
_COMMENT = re.compile(r"\s*(?:#+|//|%)(?!\s*[,;\t])\s?")
_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2},\d{3}\s*")


def with_header(lines: Iterator[str]) -> Iterator[str]:
    """Lines of which those at the top that begin with #, // or % are empty; where the first other
    one has numbers alone, the last of them is the header, as numpy.savetxt writes it.
    """
    above: list[str] = []
    for line in lines:
        mark = _COMMENT.match(line)
        if line.strip() and not mark:
            words = re.split(r"[\s,;]+", line.strip(" \t\r\n,;"))
            comments = [k for k, other in enumerate(above) if other.strip()]
            if comments and all(real(word) is not None for word in words):
                header = comments.pop()
                above[header] = _COMMENT.sub("", above[header], count=1)
            for k in comments:
                above[k] = "\n"
            return itertools.chain(above, [line], lines)
        above.append(line)
    return iter(above)


def split(lines: Iterator[str], where: str, names: Sequence[str] = ()) -> Iterator[Line]:
    """Number and cells of each line that is not empty, decimal commas as points.

    Parameters: lines; where, the file as messages call it; names, of columns: a line that is one of
    them is one cell. Empty cells past those of the first line are passed over. Raises: FileError
    for what is no CSV, InputError for commas of thousands.
    """
    before, first = _first(lines)
    said = _SAID.fullmatch(first.strip(" \r\n"))
    if said:
        separator = said[1]
        before += 1
    else:
        separator = separator_of(first, names)
        lines = itertools.chain([first], lines)
    if separator == " ":
        lines = map(_one_blank, lines)
    reader = csv.reader(lines, delimiter=separator, strict=True)
    rows = _numbered(reader, before, where)
    if separator in ";\t":
        rows = _with_points(rows, where)
    return _without_empty_ends(rows)


def separator_of(line: str, names: Sequence[str] = ()) -> str:
    """The character that separates the cells of a line."""
    bare = _QUOTED.sub("", line).strip(" \r\n")
    if ";" in bare:
        return ";"
    # a tab beside a comma is a blank
    if "\t" in re.sub(", *\t|\t *,", ",", bare).strip("\t"):
        return "\t"
    if "," in bare or _without_unit(line) in names or len(_one_blank(bare).split()) < 2:
        return ","
    return " "


def _one_blank(line: str) -> str:
    """A line with single blanks, and none before a unit, which belongs to the name there."""
    return " ".join(line.split()).replace(" [", "[").replace(" (", "(")


def _without_unit(line: str) -> str:
    """A name without the unit in brackets behind it."""
    name = line.strip()
    if name.endswith(("]", ")")):
        begin = max(name.rfind("["), name.rfind("("))
        return name[:begin].rstrip()
    return name


def _first(lines: Iterator[str]) -> tuple[int, str]:
    """Number of empty lines before the first that is not, and that line, "" where there is none."""
    for before, line in enumerate(lines):
        if line.strip():
            return before, line
    return 0, ""


def _numbered(reader: Iterator[list[str]], before: int, where: str) -> Iterator[Line]:
    number = reader.line_num  # type: ignore[attr-defined]
    try:
        for cells in reader:
            number = before + reader.line_num  # type: ignore[attr-defined]
            yield number, cells
    except csv.Error as error:
        number = before + reader.line_num  # type: ignore[attr-defined]
        raise FileError(f"{where}:{number}: not CSV: {error}") from error


def _without_empty_ends(rows: Iterable[Line]) -> Iterator[Line]:
    width = 0
    for number, cells in rows:
        while len(cells) > width and not cells[-1].strip():
            cells.pop()
        if any(cell.strip() for cell in cells):
            width = width or len(cells)
            yield number, cells


def _with_points(rows: Iterable[Line], where: str) -> Iterator[Line]:
    """Rows with decimal commas as points; warns where each could be a comma of thousands."""
    as_thousands = False
    as_decimals = False
    for number, cells in rows:
        for i, cell in enumerate(cells):
            if "," not in cell:
                continue
            if _DECIMAL_COMMA.fullmatch(cell):
                cells[i] = cell.replace(",", ".")
                thousands = _THOUSANDS.fullmatch(cell) is not None
                as_thousands |= thousands
                as_decimals |= not thousands
            elif not re.search("[A-Za-z]", cell):
                raise InputError(
                    f"{where}:{number}, column {i + 1}: {quote(cell)} has a comma and is no number"
                    " with a decimal comma; write numbers without separators of thousands"
                )
        yield number, cells
    if as_thousands and not as_decimals:
        warn(
            f"{where}: every comma is before three digits; read as decimal commas (1,234 is 1.234)"
        )
