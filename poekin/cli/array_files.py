"""Configurations out of CSV or .npy files, results into CSV, .npy or JSON, whole or not at all."""

from __future__ import annotations

import io
import os
import stat
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from ..errors import FileError
from ..formats.text import csv_rows
from ..formats.text.atomic_write import reason, write_whole
from ..solve.motion.csv_io import TIME, velocity_columns
from . import npy
from .model import STANDARD_INPUT, STDIN, stdin_taken, take_stdin
from .output import path_text

TABLES = (".csv", ".npy", ".json")
ERRORS = ("success", "position_error", "rotation_error")
"""Columns that `ik` and `follow` write beside the coordinates."""
Rows = tuple[np.ndarray, np.ndarray | None]


def called(given: str) -> str:
    """The place that configurations come from, as messages call it."""
    if given in STDIN:
        return STANDARD_INPUT
    return path_text(given)


def to_open(given: str, what: str = "--input") -> str | int:
    """File as `open` takes it: its path, or the number of standard input, which is then taken for
    this argument. Raises: as `take_stdin`.
    """
    if given not in STDIN:
        return given
    take_stdin(what)
    return sys.stdin.fileno()


def read_configurations(
    given: str,
    columns: csv_rows.Columns,
    progress: csv_rows.Progress | None = None,
) -> np.ndarray:
    """Configurations (N, m) out of a .npy file or, whatever else its name ends in, a CSV file; "-"
    is CSV on stdin.

    A CSV file has one configuration a line, the m coordinates in the order of the columns, or in
    the order of a first line that names them all, and maybe what `ik` and `follow` write beside
    them. Empty lines are passed over.

    Raises: FileError for a file that cannot be read; InputError with file and line for a line of
    the wrong length or a cell that is no number; UnknownName for a header with a name that is no
    coordinate.
    """
    besides = (TIME, *ERRORS, *velocity_columns(columns.names))
    return read_rows(given, columns._replace(besides=besides), progress)[0]


def read_path(given: str, columns: csv_rows.Columns) -> Rows:
    """Configurations (N, m) as `read_configurations` reads them, and times (N,), s, where the header
    of a CSV file names a column `time`, else None.
    """
    if TIME not in columns.names:
        columns = columns._replace(first=(TIME,))
    rows = read_configurations(given, columns)
    more = rows.shape[1] - len(columns.names)
    return rows[:, more:], rows[:, 0] if more else None


def read_rows(
    given: str,
    columns: csv_rows.Columns,
    progress: csv_rows.Progress | None,
    *,
    tail: tuple[int, ...] = (),
) -> Rows:
    """Rows (N, k) of named columns, and the line of each in a CSV file, None for a .npy file.

    Parameters: given and errors as in `read_configurations`; columns; tail, last axes that an array
    may have instead of (k,).
    """
    try:
        if Path(given).suffix.lower() == ".npy":
            count = len(columns.names)
            return npy.configurations(_content(given), count, called(given), tail), None
        return _from_csv(given, columns, progress)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot read {called(given)}: {reason(error)}") from error


def _content(given: str) -> bytes:
    """The bytes of a file; out of a pipe or a device, which need not have an end, no more than
    `csv_rows.MOST`.
    """
    with open(given, "rb") as stream:
        if stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
            return stream.read()
        content = stream.read(csv_rows.MOST + 1)
    if len(content) > csv_rows.MOST:
        raise FileError(
            f"{called(given)}: at most {csv_rows.MOST} bytes expected from a pipe; a file may be larger"
        )
    return content


def _from_csv(
    given: str,
    columns: csv_rows.Columns,
    progress: csv_rows.Progress | None,
) -> Rows:
    with csv_rows.opened(to_open(given), called(given)) as (stream, where, size):
        return csv_rows.read(stream, columns, where, progress, size)


def npy_bytes(array: np.ndarray) -> bytes:
    """The content of a .npy file."""
    out = io.BytesIO()
    np.save(out, array, allow_pickle=False)
    return out.getvalue()


def write_result(
    path: Path,
    csv: Callable[[], str],
    array: np.ndarray,
    json: Callable[[], str],
) -> None:
    """Write a result as CSV, .npy or JSON, whichever the path ends in. Raises: FileError."""
    suffix = path.suffix.lower()
    if suffix == ".csv":
        content = csv().encode()
    elif suffix == ".npy":
        content = npy_bytes(array)
    else:
        content = (json() + "\n").encode()
    write_whole(path, content)


def check_place(path: Path | None, endings: Sequence[str] = TABLES) -> None:
    """Refuse a place that cannot be written to, or that has none of these endings, before any work is
    done. Raises: FileError.
    """
    if path is None:
        return
    fault = ""
    if path.suffix.lower() not in endings:
        fault = f"a name that ends in {' or '.join(endings)} expected"
    elif path.is_dir():
        fault = "it is a directory"
    elif not path.parent.is_dir():
        fault = f"there is no directory {path_text(path.parent)}"
    if fault:
        raise FileError(f"cannot write {path_text(path)}: {fault}")


def check_apart(results: Iterable[Path | None], **read: str | Sequence[str] | None) -> None:
    """Refuse to write over a file that is read, two results into one file, or to read standard
    input twice.

    Parameters: results, the places to write to; read, the files that are read, by what they hold.
    Raises: FileError, InputError.
    """
    taken: dict[object, str] = {}
    stdin = ""
    for what, given in read.items():
        names = given or ()
        if isinstance(names, str):
            names = [names]
        for name in names:
            if name in STDIN and stdin:
                raise stdin_taken(what, stdin)
            if name in STDIN:
                stdin = what
            taken[_file_identity(name)] = f"it is the file of the {what}"
    taken.pop(None, None)
    for path in filter(None, results):
        place = _file_identity(path) or os.path.realpath(path)
        if place in taken:
            raise FileError(f"cannot write {path_text(path)}: {taken[place]}")
        taken[place] = "it is named twice"


def _file_identity(name: str | Path) -> tuple[int, int] | None:
    """Device and inode, common to all names of one regular file; None for anything else."""
    try:
        if name in STDIN:
            status = os.fstat(sys.stdin.fileno())
        else:
            status = os.stat(name)
    except (OSError, ValueError, AttributeError):  # among others a stdin that is closed or no file
        return None
    if not stat.S_ISREG(status.st_mode):
        return None
    return status.st_dev, status.st_ino
