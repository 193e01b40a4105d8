"""Arrays in and out of files: configurations from CSV or .npy, results to CSV, .npy or JSON, whole or not at all."""

from __future__ import annotations

import csv
import io
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ..errors import FileError, InputError, UnknownName, closest, shown
from ..formats.numbers import real
from . import npy
from .output import name

STDIN = "-"


def called(given: str) -> str:
    """The place that configurations come from, as messages call it."""
    return "standard input" if given == STDIN else shown(given, 400)


def read_configurations(given: str, q_names: Sequence[str], progress: Callable[[int, int], None]) -> np.ndarray:
    """Configurations (N, m) out of a .npy file or, whatever else its name ends in, a CSV file; "-" is CSV on stdin.

    A CSV file has one configuration a line, the m coordinates in the order of q_names, or in the order of a first line
    that names them all. Empty lines are passed over.

    Raises: FileError for a file that cannot be read; InputError with file and line for a line of the wrong length or
    a cell that is no number; UnknownName for a header with a name that is no coordinate.
    """
    if given == STDIN and sys.stdin is None:
        raise FileError("cannot read standard input: it is closed")
    try:
        if Path(given).suffix.lower() == ".npy":
            return npy.configurations(Path(given).read_bytes(), len(q_names), called(given))
        return _from_csv(given, q_names, progress)
    except UnicodeDecodeError as error:
        raise FileError(f"{called(given)} is no text file: byte {error.start} is not UTF-8") from error
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot read {called(given)}: {error.strerror or error}") from error


def _from_csv(given: str, q_names: Sequence[str], progress: Callable[[int, int], None]) -> np.ndarray:
    rows: list[list[float]] = []
    order: list[int] | None = None
    file = sys.stdin.fileno() if given == STDIN else given
    with open(file, newline="", encoding="utf-8-sig", closefd=given != STDIN) as stream:
        size = os.fstat(stream.fileno()).st_size
        reader = csv.reader(stream)
        read = 0
        try:
            for cells in reader:
                read += sum(map(len, cells)) + len(cells)
                where = f"{called(given)}:{reader.line_num}"
                if not any(cell.strip() for cell in cells):
                    continue
                if not rows and order is None and _is_header(cells, q_names):
                    order = _order([cell.strip() for cell in cells], q_names, where)
                    continue
                if len(cells) != len(q_names):
                    raise InputError(f"{where}: {len(q_names)} values expected{_listed(q_names)}, got {len(cells)}")
                rows.append([_real(cell, f"{where}, column {i + 1}") for i, cell in enumerate(cells)])
                if len(rows) % 10_000 == 0:
                    progress(read, size)
        except csv.Error as error:
            raise FileError(f"{called(given)}:{reader.line_num}: not CSV: {error}") from error
    array = np.array(rows, float).reshape(len(rows), len(q_names))
    return array if order is None else array[:, order]


def _is_header(cells: Sequence[str], q_names: Sequence[str]) -> bool:
    # A robot may call its joints 1, 2, 3: a line that is exactly the names is a header even so.
    words = [cell.strip() for cell in cells]
    return sorted(words) == sorted(q_names) or all(real(word) is None for word in words)


def _order(words: Sequence[str], q_names: Sequence[str], where: str) -> list[int]:
    for word in words:
        if word not in q_names:
            raise UnknownName(f"{where}: {shown(word)} is neither a number nor a coordinate; {closest(word, q_names)}")
    missing = [n for n in q_names if n not in words]
    if missing or len(words) != len(q_names):
        what = f"{shown(missing[0])} is missing" if missing else "a name stands twice"
        raise InputError(f"{where}: the header has to name each of the {len(q_names)} coordinates once; {what}")
    return [words.index(n) for n in q_names]


def _real(text: str, where: str) -> float:
    value = real(text)
    if value is None:
        raise InputError(f"{where}: a number expected, got {shown(text)}")
    return value


def _listed(q_names: Sequence[str]) -> str:
    return f" ({', '.join(name(n) for n in q_names)})" if q_names else ""


def csv_text(header: Sequence[str], rows: np.ndarray, progress: Callable[[int, int], None]) -> str:
    """CSV of a header and rows (N, k); every number in the shortest form that reads back as the same float."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([name(h) for h in header])
    for start in range(0, len(rows), 10_000):
        progress(start, len(rows))
        writer.writerows(rows[start : start + 10_000].tolist())
    return out.getvalue()


def npy_bytes(array: np.ndarray) -> bytes:
    """The content of a .npy file."""
    out = io.BytesIO()
    np.save(out, array, allow_pickle=False)
    return out.getvalue()


def check_writable(path: Path) -> None:
    """Refuse a place that cannot be written to before any work is done. Raises: FileError."""
    if path.suffix.lower() not in (".csv", ".npy", ".json"):
        raise FileError(f"cannot write {shown(path, 400)}: a name that ends in .csv, .npy or .json expected")
    if path.is_dir():
        raise FileError(f"cannot write {shown(path, 400)}: it is a directory")
    if not path.parent.is_dir():
        raise FileError(f"cannot write {shown(path, 400)}: there is no directory {shown(path.parent, 400)}")
