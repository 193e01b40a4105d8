"""Poses of text and files: rows of numbers, and what controllers and ROS print."""

from __future__ import annotations

import io
import os
import re
from typing import TextIO

from ...errors import FileError, InputError, quote, safe_repr
from ...groups.arrays import Array
from ...results import Progress
from ..text import csv_rows
from ..text.csv_header import Columns
from ..text.numbers import real
from . import controller_text, pose_rows, ros_text
from .layout import PoseFormat, PoseLayout, QuaternionOrder, layout

LARGEST = 2**28
"""Characters of a text of poses."""
_PIECE = 2**20
_SHOWN = 60


def read(
    source: str | os.PathLike[str],
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
    mm: bool | None = None,
    deg: bool | None = None,
) -> Array:
    r"""Poses read from a file or a text, as a controller, ROS or a spreadsheet writes them.

    Rows of numbers, one pose a line, with commas, semicolons, tabs or blanks between, decimal
    points or, with semicolons and tabs, decimal commas; a first line may name the columns and so
    order them, and may say units (`X [mm]`, `A (rad)`). Or one pose a line in the controller's own
    notation: UR `p[...]`, KUKA `{X 1, Y 2, ...}`, Fanuc `X = 1 mm, ...` and the positions of an LS
    file, ABB `[[...], [...]]`, Stäubli `{...}`, Yaskawa `C00000=...`, Kawasaki, Doosan and
    Mitsubishi `(...)`. With "ros", also what `ros2 topic echo` prints of messages with a pose, and
    the last block of `tf2_echo`.

    Parameters
    ----------
    source : str or path_like
        File, or the text itself: a str is a file where there is one of this name.
    format, quaternion, mm, deg : optional
        Convention and units of the numbers, as in `from_numbers`; never guessed.

    Returns
    -------
    T : (N, 4, 4) or (4, 4) ndarray
        Poses in the frame that the numbers are in, m; of a text with one pose, that pose. A row
        with nan gives a pose of NaN.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError, PoseError
        With file or "text" and the line: if it is no pose, if a header says another unit than `mm`
        or `deg`, or if there is more than one way to read it.
    UnknownName
        If the header has another name.

    Warns
    -----
    PoekinWarning
        For `tf2_echo`, how far its decimals leave the pose open; for decimal commas that could all
        be commas of thousands.

    Notes
    -----
    Accuracy: as `from_numbers`. Source: the controllers' manuals, named in
    tests/formats/poses/vendors.py.

    Examples
    --------
    >>> import poekin as pk
    >>> T = pk.poses.read("p[0.5, 0, 0.3, 0, 3.141592653589793, 0]", "ur")
    >>> print(T[:3, 3], T[2, 2])
    [0.5 0.  0.3] -1.0
    >>> pk.poses.read("X;Y;Z;A;B;C\n500,5;0;300;0;180;0\n600;0;300;0;180;0", "kuka").shape
    (2, 4, 4)
    """
    chosen = layout(format, quaternion, mm=mm, deg=deg)
    said = said_units(mm, deg)
    if isinstance(source, str) and ("\n" in source or not os.path.exists(source)):
        found = read_text(source, chosen, said, "text")
        return found[0] if len(found) == 1 else found
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(f"source: expected a path or a text, got {safe_repr(source)}")
    return read_file(source, chosen, said)


def said_units(mm: bool | None, deg: bool | None) -> tuple[str, ...]:
    """Units that a user said, which a header may not contradict."""
    length = {True: ("mm",), False: ("m",), None: ()}[mm]
    angle: dict[bool | None, tuple[str, ...]] = {True: ("deg",), False: ("rad",), None: ()}
    return length + angle[deg]


def read_file(
    path: str | os.PathLike[str] | int,
    chosen: PoseLayout,
    said: tuple[str, ...],
    where: str = "",
    progress: Progress | None = None,
) -> Array:
    """Poses (N, 4, 4) of a file, or of an open one by its number. Parameters and errors: those of
    `read`; where, what messages call it; progress(characters read, size).
    """
    with csv_rows.opened(path, where) as (stream, place, _):
        return read_text(_whole(stream, place), chosen, said, place, progress)


def _whole(stream: TextIO, where: str) -> str:
    """The text of a stream, by pieces: read(n) may make room for n characters at once."""
    pieces: list[str] = []
    length = 0
    while piece := stream.read(_PIECE):
        length += len(piece)
        if length > LARGEST:
            raise FileError(f"{where}: at most {LARGEST} characters expected")
        pieces.append(piece)
    return "".join(pieces)


def read_text(
    text: str,
    chosen: PoseLayout,
    said: tuple[str, ...],
    where: str,
    progress: Progress | None = None,
) -> Array:
    """Poses (N, 4, 4) of a text. Parameters and errors: those of `read_file`."""
    if chosen.format == "ros":
        message = ros_text.read(text, where)
        if message is not None:
            return pose_rows.to_poses(message.rows, message.layout, message.places.__getitem__)
    printed = controller_text.rows(text, chosen, where)
    if printed is not None:
        rows, places = printed
        return pose_rows.to_poses(rows, chosen, places.__getitem__)
    if "\n" not in text and text.strip() and not _has_number(text):
        raise InputError(
            f"{where}: expected poses or the name of a file that is there, got {quote(text[:_SHOWN])}"
        )
    columns = pose_columns(chosen, said)
    stream = io.StringIO(text, newline="")
    rows, lines = csv_rows.read(stream, columns, where, progress, len(text))
    return pose_rows.to_poses(rows, chosen, lambda i: f"{where}:{lines[i]}")


def _has_number(text: str) -> bool:
    return any(real(word) is not None for word in re.split(r"[\s,;]+", text))


def pose_columns(chosen: PoseLayout, said: tuple[str, ...] = ()) -> Columns:
    """Columns of a layout in a CSV file; of "matrix", the fourth row may be left out."""
    last = chosen.columns[12:] * (chosen.format == "matrix")
    return Columns(chosen.columns, "column", chosen.units, said, last=last)
