"""CSV of numbers: rows of named columns, in any order that a header gives, in and out."""

from __future__ import annotations

import contextlib
import csv
import io
import itertools
import math
import os
import re
import stat
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TextIO

import numpy as np

from ...errors import FileError, InputError, escape_unprintable
from ...results import Progress
from . import csv_dialect, csv_header
from .atomic_write import FilePath, reason
from .csv_dialect import Line
from .csv_header import Columns
from .numbers import expected, real

AT_ONCE = 10_000
"""Lines after which progress is said, and that are written together."""
LONGEST = 2**20
"""Characters in a line: what has no line breaks is no CSV, and might have no end."""
AS_HEADER = ", as the header has"
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_WHOLE = re.compile(r"\s*[+-]?\d+\s*")
MOST = 2**28
"""Characters out of a pipe or a device, which need not have an end."""


@contextlib.contextmanager
def opened(
    path: FilePath | int,
    where: str = "",
) -> Iterator[tuple[TextIO, str, int]]:
    """File opened for reading as UTF-8 text, its name as messages call it, and its size in bytes.

    Parameters: path, or the number of an open file, which stays open; where, what messages call it
    (default: its path). Raises: FileError for what cannot be read, also while the file is being
    read.
    """
    is_open = isinstance(path, int)
    if not is_open and not where:
        where = escape_unprintable(os.fsdecode(path), 400)
    try:
        with open(path, newline="", encoding="utf-8-sig", closefd=not is_open) as stream:
            yield stream, where, os.fstat(stream.fileno()).st_size
    except UnicodeDecodeError as error:
        wide = "" if error.object[:2] not in _UTF16 else "; it is UTF-16, save it as CSV UTF-8"
        raise FileError(
            f"{where} is no text file: byte {error.start} is not UTF-8{wide}"
        ) from error
    except (OSError, ValueError) as error:
        if isinstance(error, (FileError, InputError)):
            raise
        raise FileError(f"cannot read {where}: {reason(error)}") from error


def read(
    stream: TextIO,
    columns: Columns,
    where: str,
    progress: Progress | None = None,
    size: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) in the order of the names, and the number of each row's line in the file (N,).

    One row a line, in the order of the names or of a first line that names them all and may say
    units; empty lines are passed over. Parameters: stream, a text opened with newline=""; columns;
    where, the file as messages call it; progress(characters read, size). Raises: FileError for what
    is no CSV; InputError with file and line for a line of the wrong length or a cell that is no
    number; UnknownName for a header with a name that is none.
    """
    lines = csv_dialect.split(_bounded(stream, where), where, columns.names)
    top = next(lines, None)
    if top is None:
        raise InputError(f"{where}: rows of numbers expected, the file is empty")
    line, cells = top
    chosen = _chosen(cells, columns, f"{where}:{line}")
    if not chosen.is_header:
        lines = itertools.chain([top], lines)
    rows, numbers = _rows(lines, chosen, where, progress, size)
    for k, function in chosen.conversions.items():
        rows[:, k] = function(rows[:, k])
    return rows, numbers


def read_chosen(
    stream: TextIO,
    choose: Callable[[list[str], str], Sequence[int]],
    where: str,
    progress: Progress | None = None,
    size: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) of chosen columns, and the number of each row's line in the file (N,); other
    columns may hold text.

    The first line that is not empty, nor a comment, names the columns. choose(names, where): the indices of the
    columns that are read, in the order in which they are returned; the other parameters and errors
    are those of `read`.
    Raises also: InputError for a file without a line.
    """
    lines = csv_dialect.split(csv_dialect.with_header(_bounded(stream, where)), where)
    line, cells = next(lines, (0, []))
    if not cells:
        raise InputError(
            f"{where}: a first line that names the columns expected, the file is empty"
        )
    chosen = choose([cell.strip() for cell in cells], f"{where}:{line}")
    return _rows(lines, _Chosen(chosen, len(cells), AS_HEADER), where, progress, size)


def _bounded(stream: TextIO, where: str) -> Iterator[str]:
    """Lines of a text: each of bounded length, and so are all together unless it is a file."""
    left = float(MOST)
    if _is_file(stream):
        left = math.inf
    for number in itertools.count(1):
        line = stream.readline(LONGEST + 1)
        left -= len(line)
        if not line:
            return
        if len(line) > LONGEST:
            raise FileError(
                f"{where}:{number}: not CSV: a line of at most {LONGEST} characters expected, this is longer"
            )
        if left < 0:
            raise FileError(
                f"{where}:{number}: at most {MOST} characters expected from a pipe; a file may be larger"
            )
        yield line


def _is_file(stream: TextIO) -> bool:
    """Whether a text is in memory or a regular file, the size of which is known."""
    try:
        return stat.S_ISREG(os.fstat(stream.fileno()).st_mode)
    except (OSError, AttributeError):
        return True


class _Chosen(NamedTuple):
    """Columns that are read: their indices, the number of all, their names for messages, whether
    the first line names them, and what converts their units, by their place in a row.
    """

    indices: Sequence[int]
    width: int
    names: str
    is_header: bool = False
    conversions: Mapping[int, Callable[[np.ndarray], np.ndarray]] = {}


def _chosen(cells: Sequence[str], columns: Columns, here: str) -> _Chosen:
    """The columns that a file is read by, of its first line."""
    words = [cell.strip() for cell in cells]
    columns = columns.as_named(words)
    known = (*columns.first, *columns.names, *columns.besides)
    headings = csv_header.headings(words, known)
    given = {heading.name for heading in headings}
    if given.issuperset(columns.first):
        columns = columns.with_first()
    if _is_header(words, columns.names):
        if given.isdisjoint(columns.last):
            columns = columns.without_last()
        names = AS_HEADER if len(words) != len(columns.names) else _name_list(columns.names)
        return _Chosen(
            csv_header.order(headings, columns, here),
            len(words),
            names,
            True,
            csv_header.conversions(headings, columns, here),
        )
    if len(words) == len(columns.without_last().names):
        columns = columns.without_last()
    names = columns.names
    return _Chosen(range(len(names)), len(names), _name_list(names))


def _rows(
    lines: Iterable[Line],
    columns: _Chosen,
    where: str,
    progress: Progress | None,
    size: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) of the chosen columns, and the lines' numbers."""
    chosen = columns.indices
    # Packed: Python's own numbers would take several times as much memory.
    values = array("d")
    numbers = array("q")
    done = 0
    for line, cells in lines:
        done += sum(map(len, cells)) + len(cells)
        if len(cells) != columns.width:
            raise InputError(
                f"{where}:{line}: {columns.width} values expected{columns.names},"
                f" got {len(cells)}{_cure(cells, columns.width)}"
            )
        values.extend(expected(cells[i], f"{where}:{line}, column {i + 1}") for i in chosen)
        numbers.append(line)
        if progress is not None and len(numbers) % AT_ONCE == 0:
            progress(done, size)
    return np.array(values).reshape(len(numbers), len(chosen)), np.array(numbers, int)


def text(
    header: Sequence[str],
    rows: np.ndarray,
    progress: Progress | None = None,
) -> str:
    """CSV of a header and rows (N, k); every number in the shortest form that reads back as the
    same float.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    words = [escape_unprintable(h) for h in header]
    if any(";" in word for word in words):  # which would be taken for the separator
        csv.writer(out, lineterminator="\n", quoting=csv.QUOTE_ALL).writerow(words)
    else:
        writer.writerow(words)
    for start in range(0, len(rows), AT_ONCE):
        if progress is not None:
            progress(start, len(rows))
        writer.writerows(rows[start : start + AT_ONCE].tolist())
    return out.getvalue()


def _is_header(words: Sequence[str], names: Sequence[str]) -> bool:
    # A robot may call its joints 1, 2, 3: a line that is exactly the names is a header even so.
    return sorted(words) == sorted(names) or all(real(word) is None for word in words)


def _cure(cells: Sequence[str], width: int) -> str:
    """End of a message: what to do where commas seem to be decimal marks and separators."""
    if len(cells) != 2 * width or not all(_WHOLE.fullmatch(cell) for cell in cells):
        return ""
    return "; with decimal commas, write ; between the columns"


def _name_list(names: Sequence[str]) -> str:
    if not names:
        return ""
    return f" ({', '.join(map(escape_unprintable, names))})"
