"""Pipes, which can be read once: `<(xacro arm.urdf.xacro)`, named pipes, standard input."""

from __future__ import annotations

import os
import stat
from typing import BinaryIO

from ...errors import FileError
from ...model.provenance import Source
from ..text import xml
from ..text.atomic_write import FilePath, reason


def is_pipe(path: FilePath) -> bool:
    """Whether a path is that of a pipe; what cannot be looked at is none."""
    try:
        return stat.S_ISFIFO(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False


def read(path: FilePath) -> bytes:
    """The bytes out of a pipe, which are gone from it then. Raises: as `read_stream`."""
    try:
        with open(path, "rb") as stream:
            return read_stream(stream, os.fsdecode(path))
    except OSError as fault:
        if isinstance(fault, FileError):
            raise
        place = Source(os.fsdecode(path)).place()
        raise FileError(f"{place}: cannot be read: {reason(fault)}") from fault


def read_stream(stream: BinaryIO, name: str) -> bytes:
    """The bytes of a stream to its end; `name` stands for it in messages.

    Raises: FileError where it is empty, cannot be read, or has more than 64 MiB, of which the rest
    is not read.
    """
    place = Source(name).place()
    try:
        content = stream.read(xml.MAX_BYTES + 1) or b""  # None where it does not wait
    except OSError as fault:
        raise FileError(f"{place}: cannot be read: {reason(fault)}") from fault
    if len(content) > xml.MAX_BYTES:
        raise FileError(f"{place}: expected at most 64 MiB, got more")
    if not content.strip():
        raise FileError(f"{place}: the text is empty (did the command before the pipe fail?)")
    return content
