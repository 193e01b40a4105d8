"""Content of gzip files and of files in zip archives, bounded while it is decompressed."""

from __future__ import annotations

import gzip
import io
import lzma
import os
import re
import zipfile
import zlib
from collections.abc import Callable

from ...errors import FileError, join_names, quote, suggest
from ...model.provenance import Source
from ..text import xml
from ..text.atomic_write import FilePath

_GZIP = b"\x1f\x8b"
_ZIP = b"PK\x03\x04"
_EMPTY_ZIP = b"PK\x05\x06"
_ENTRY = b"PK\x01\x02"
"""Bytes with which an archive's directory lists each of its files."""
MOST_ENTRIES = 10_000
_DAMAGED = (
    OSError,
    EOFError,
    ValueError,
    RuntimeError,  # a password, or a method of compression that zipfile lacks
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
)


def is_compressed(content: bytes) -> bool:
    """Whether bytes begin as a gzip file or a zip archive does."""
    return content.startswith((_GZIP, _ZIP, _EMPTY_ZIP))


def split(name: FilePath) -> tuple[str, str]:
    """Path of an archive and name of a file in it, of `models.zip/arm.urdf`.

    The second is empty where no part of the name is an archive that exists.
    """
    whole = os.fsdecode(name)
    for ending in re.finditer(r"\.zip[/\\]", whole, re.IGNORECASE):
        archive = whole[: ending.end() - 1]
        if os.path.isfile(archive):
            return archive, whole[ending.end() :]
    return whole, ""


def read(path: FilePath) -> bytes:
    """Bytes of a file, out of a gzip file or zip archive where it is one, or is in one by its name.
    Raises: FileError.
    """
    archive, member = split(path)
    return decompress(xml.read_bytes(archive), Source(archive).place(), member)


def decompress(
    content: bytes,
    place: str,
    member: str = "",
) -> bytes:
    """Bytes of a gzip file, or of one file in a zip archive: of `member`, else of its only URDF; those
    of anything else as they are.

    Raises: FileError for damaged content, more than 64 MiB, an archive in an archive, no URDF or
    several, or no file of the name, with those that there are. Place: what messages call it.
    """
    if not is_compressed(content):
        return content
    try:
        if content.startswith(_GZIP):
            with gzip.GzipFile(fileobj=io.BytesIO(content)) as stream:
                found = _bounded(stream.read, place)
        else:
            found = _from_archive(content, place, member)
    except _DAMAGED as fault:
        if isinstance(fault, FileError):
            raise
        raise FileError(f"{place}: cannot be decompressed: {quote(fault, 200)}") from fault
    if is_compressed(found):
        raise FileError(f"{place}: expected a model in it, got compressed content once more")
    return found


def _from_archive(
    content: bytes,
    place: str,
    member: str,
) -> bytes:
    if content.count(_ENTRY) > MOST_ENTRIES:
        raise FileError(f"{place}: expected an archive of at most {MOST_ENTRIES} files, got more")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = [entry.filename for entry in archive.infolist() if not entry.is_dir()]
        chosen = _chosen(names, place, member)
        with archive.open(chosen) as stream:
            return _bounded(stream.read, f"{place}/{quote(chosen)[1:-1]}")


def _chosen(
    names: list[str],
    place: str,
    member: str,
) -> str:
    if member:
        if member not in names:
            raise FileError(f"{place} has no file {quote(member)}; {suggest(member, names)}")
        return member
    # what macOS puts beside each file is no model
    own = [name for name in names if not name.startswith("__MACOSX/")]
    models = [name for name in own if name.lower().endswith(".urdf")]
    if len(models) == 1:
        return models[0]
    expected = f"{place}: expected one .urdf in the archive, or its name behind the archive's"
    if models:
        raise FileError(
            f"{expected} ('{place}/{quote(models[0])[1:-1]}'), got {len(models)}: {join_names(models)}"
        )
    raise FileError(f"{expected}, got none; its files: {join_names(own) or 'none'}")


def _bounded(read: Callable[[int], bytes], place: str) -> bytes:
    content = read(xml.MAX_BYTES + 1)
    if len(content) > xml.MAX_BYTES:
        raise FileError(f"{place}: expected at most 64 MiB of decompressed text, got more")
    return content
