"""CSV of numbers: rows of so many named columns, with a header that may order them, in and out."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from ..errors import FileError, InputError, UnknownName, closest, harmless, shown
from .numbers import real

Progress = Callable[[int, int], None]


def read(
    stream: Iterable[str], names: Sequence[str], where: str, what: str, progress: Progress | None = None, size: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (N, k) in the order of the names, and the number of each row's line in the file (N,).

    One row a line, in the order of `names` or of a first line that names them all; empty lines are passed over.
    Parameters: stream, a text opened with newline=""; where, the file as messages call it; what, a column's kind
    ("coordinate"); progress(characters read, size). Raises: FileError for what is no CSV; InputError with file and line
    for a line of the wrong length or a cell that is no number; UnknownName for a header with a name that is none.
    """
    rows: list[list[float]] = []
    lines: list[int] = []
    order: list[int] | None = None
    reader, done = csv.reader(stream), 0
    try:
        for cells in reader:
            done += sum(map(len, cells)) + len(cells)
            here = f"{where}:{reader.line_num}"
            if not any(cell.strip() for cell in cells):
                continue
            if not rows and order is None and _is_header(cells, names):
                order = _order([cell.strip() for cell in cells], names, here, what)
                continue
            if len(cells) != len(names):
                raise InputError(f"{here}: {len(names)} values expected{_listed(names)}, got {len(cells)}")
            rows.append([_real(cell, f"{here}, column {i + 1}") for i, cell in enumerate(cells)])
            lines.append(reader.line_num)
            if progress is not None and len(rows) % 10_000 == 0:
                progress(done, size)
    except csv.Error as error:
        raise FileError(f"{where}:{reader.line_num}: not CSV: {error}") from error
    array = np.array(rows, float).reshape(len(rows), len(names))
    return array if order is None else array[:, order], np.array(lines, int)


def text(header: Sequence[str], rows: np.ndarray, progress: Progress | None = None) -> str:
    """CSV of a header and rows (N, k); every number in the shortest form that reads back as the same float."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([harmless(h) for h in header])
    for start in range(0, len(rows), 10_000):
        if progress is not None:
            progress(start, len(rows))
        writer.writerows(rows[start : start + 10_000].tolist())
    return out.getvalue()


def _is_header(cells: Sequence[str], names: Sequence[str]) -> bool:
    # A robot may call its joints 1, 2, 3: a line that is exactly the names is a header even so.
    words = [cell.strip() for cell in cells]
    return sorted(words) == sorted(names) or all(real(word) is None for word in words)


def _order(words: Sequence[str], names: Sequence[str], where: str, what: str) -> list[int]:
    for word in words:
        if word not in names:
            raise UnknownName(f"{where}: {shown(word)} is neither a number nor a {what}; {closest(word, names)}")
    missing = [n for n in names if n not in words]
    if missing or len(words) != len(names):
        fault = f"{shown(missing[0])} is missing" if missing else "a name stands twice"
        raise InputError(f"{where}: the header has to name each of the {len(names)} {what}s once; {fault}")
    return [words.index(n) for n in names]


def _real(cell: str, where: str) -> float:
    value = real(cell)
    if value is None:
        raise InputError(f"{where}: a number expected, got {shown(cell)}")
    return value


def _listed(names: Sequence[str]) -> str:
    return f" ({', '.join(map(harmless, names))})" if names else ""
