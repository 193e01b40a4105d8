"""CSV of numbers: rows of named columns, in any order that a header gives, in and out."""

from __future__ import annotations

import contextlib
import csv
import io
import itertools
import math
import os
import stat
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple, TextIO

import numpy as np

from ...errors import FileError, InputError, UnknownName, escape_unprintable, quote, suggest
from ...results import Progress
from .atomic_write import FilePath, reason
from .numbers import real

Line = tuple[int, list[str]]
AT_ONCE = 10_000
"""Lines after which progress is said, and that are written together."""
LONGEST = 2**20
"""Characters in a line: what has no line breaks is no CSV, and might have no end."""
AS_HEADER = ", as the header has"
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
        raise FileError(f"{where} is no text file: byte {error.start} is not UTF-8") from error
    except (OSError, ValueError) as error:
        if isinstance(error, (FileError, InputError)):
            raise
        raise FileError(f"cannot read {where}: {reason(error)}") from error


def read(
    stream: TextIO,
    names: Sequence[str],
    where: str,
    what: str,
    progress: Progress | None = None,
    size: int = 0,
    *,
    besides: Sequence[str] = (),
    first: Sequence[str] = (),
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) in the order of the names, and the number of each row's line in the file (N,).

    One row a line, in the order of `names` or of a first line that names them all; empty lines are
    passed over. Parameters: stream, a text opened with newline=""; where, the file as messages call
    it; what, a column's kind ("coordinate"); progress(characters read, size); besides, columns that
    such a first line may name, too: they are passed over; first, columns that it may name together,
    too: where it does, rows (N, len(first) + k) begin with
    them. Raises: FileError for what is no CSV; InputError with file and line for a line of the
    wrong length or a
    cell that is no number; UnknownName for a header with a name that is none.
    """
    lines = _lines(stream, where)
    top = next(lines, None)
    columns = _Columns(range(len(names)), len(names), _name_list(names))
    if top is not None:
        line, cells = top
        words = [cell.strip() for cell in cells]
        if first and set(first) <= set(words):
            names = (*first, *names)
            columns = columns._replace(names=_name_list(names))
        if _is_header(words, names):
            chosen = _order(words, names, besides, f"{where}:{line}", what)
            columns = columns._replace(chosen=chosen, width=len(words))
            if len(words) != len(names):
                columns = columns._replace(names=AS_HEADER)
        else:
            lines = itertools.chain([top], lines)
    return _rows(lines, columns, where, progress, size)


def read_chosen(
    stream: TextIO,
    choose: Callable[[list[str], str], Sequence[int]],
    where: str,
    progress: Progress | None = None,
    size: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) of chosen columns, and the number of each row's line in the file (N,); other
    columns may hold text.

    The first line that is not empty names the columns. choose(names, where): the indices of the
    columns that are read, in the order in which they are returned; the other parameters and errors
    are those of `read`.
    Raises also: InputError for a file without a line.
    """
    lines = _lines(stream, where)
    line, cells = next(lines, (0, []))
    if not cells:
        raise InputError(
            f"{where}: a first line that names the columns expected, the file is empty"
        )
    chosen = choose([cell.strip() for cell in cells], f"{where}:{line}")
    return _rows(lines, _Columns(chosen, len(cells), AS_HEADER), where, progress, size)


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


def _lines(stream: TextIO, where: str) -> Iterator[Line]:
    """Number and cells of each line that is not empty."""
    reader = csv.reader(_bounded(stream, where))
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield reader.line_num, cells
    except csv.Error as error:
        raise FileError(f"{where}:{reader.line_num}: not CSV: {error}") from error


class _Columns(NamedTuple):
    """Columns that are read: their indices, the number of all, and their names for messages."""

    chosen: Sequence[int]
    width: int
    names: str


def _rows(
    lines: Iterable[Line],
    columns: _Columns,
    where: str,
    progress: Progress | None,
    size: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) of the chosen columns, and the lines' numbers."""
    chosen = columns.chosen
    # Packed: Python's own numbers would take several times as much memory.
    values = array("d")
    numbers = array("q")
    done = 0
    for line, cells in lines:
        done += sum(map(len, cells)) + len(cells)
        if len(cells) != columns.width:
            raise InputError(
                f"{where}:{line}: {columns.width} values expected{columns.names}, got {len(cells)}"
            )
        values.extend(_real(cells[i], f"{where}:{line}, column {i + 1}") for i in chosen)
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
    writer.writerow([escape_unprintable(h) for h in header])
    for start in range(0, len(rows), AT_ONCE):
        if progress is not None:
            progress(start, len(rows))
        writer.writerows(rows[start : start + AT_ONCE].tolist())
    return out.getvalue()


def _is_header(words: Sequence[str], names: Sequence[str]) -> bool:
    # A robot may call its joints 1, 2, 3: a line that is exactly the names is a header even so.
    return sorted(words) == sorted(names) or all(real(word) is None for word in words)


def _order(
    words: Sequence[str],
    names: Sequence[str],
    besides: Sequence[str],
    where: str,
    what: str,
) -> Sequence[int]:
    for word in words:
        if word not in names and word not in besides:
            raise UnknownName(
                f"{where}: {quote(word)} is neither a number nor a {what}; {suggest(word, names)}"
            )
    missing = [n for n in names if n not in words]
    if missing or len(set(words)) != len(words):
        fault = "a name appears twice"
        if missing:
            fault = f"{quote(missing[0])} is missing"
        raise InputError(
            f"{where}: the header has to name each of the {len(names)} {what}s once; {fault}"
        )
    return [words.index(n) for n in names]


def _real(cell: str, where: str) -> float:
    value = real(cell)
    if value is None:
        raise InputError(f"{where}: a number expected, got {quote(cell)}")
    return value


def _name_list(names: Sequence[str]) -> str:
    if not names:
        return ""
    return f" ({', '.join(map(escape_unprintable, names))})"
