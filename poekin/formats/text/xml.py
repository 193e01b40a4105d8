"""XML read safely: no DTD, no entity, no network, nothing outside of the text itself."""

from __future__ import annotations

import os
import stat
from typing import Any, Never

from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]  (it is compiled and has no stubs)

from ...errors import FileError, InputError, ModelError, quote, safe_repr
from ...model.provenance import Source
from .atomic_write import FilePath, reason

MAX_BYTES = 64 * 2**20

Element = Any
"""An element of lxml."""

# Nothing is resolved, fetched or defaulted from elsewhere. Without huge_tree libxml2 keeps its own
# limits too.
SAFE: dict[str, Any] = {
    "resolve_entities": False,
    "no_network": True,
    "load_dtd": False,
    "dtd_validation": False,
    "attribute_defaults": False,
    "huge_tree": False,
    "remove_comments": True,
    "remove_pis": True,
}


class _DoctypeFound(Exception):
    """Raised out of the parser at the first sign of a DTD, before it is read."""


class _DoctypeTrap:
    """A parser target that lets everything pass but a document type declaration."""

    def doctype(self, *_: str | None) -> Never:
        raise _DoctypeFound

    def close(self) -> None:
        """Nothing to hand back."""


def read_bytes(path: FilePath) -> bytes:
    """The bytes of a file of text.

    Raises: FileError for a file that does not exist or cannot be read, a directory, a device, an
    empty file and one of more than 64 MiB (which is not read); InputError for what is no path.
    """
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise InputError(f"expected the path of a file, got {safe_repr(path)}")
    name = Source(os.fsdecode(path)).place()
    try:
        status = os.stat(path)
        if stat.S_ISDIR(status.st_mode):
            raise FileError(f"{name}: expected a file, this is a directory")
        if not stat.S_ISREG(status.st_mode):
            raise FileError(f"{name}: expected a file, this is a device, pipe or socket")
        if status.st_size > MAX_BYTES:
            raise FileError(
                f"{name}: expected at most 64 MiB, the file has {status.st_size / 2**20:.1f} MiB"
            )
        with open(path, "rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as fault:
        if isinstance(fault, FileError):
            raise
        raise FileError(f"{name}: cannot be read: {reason(fault)}") from fault
    if not data:
        raise FileError(f"{name}: the file is empty")
    return data


def read_text(path: FilePath, most: int = MAX_BYTES) -> tuple[str, str]:
    """Text of a file in UTF-8, and the place as messages call it.

    Raises: as `read_bytes`; FileError where it is larger than `most` bytes or not UTF-8.
    """
    data = read_bytes(path)
    place = Source(os.fsdecode(path)).place()
    if len(data) > most:
        raise FileError(
            f"{place}: expected at most {most / 2**10:.0f} KiB, the file has"
            f" {len(data) / 2**10:.0f} KiB"
        )
    try:
        return data.decode("utf-8-sig"), place
    except UnicodeDecodeError as fault:
        raise FileError(f"{place}: not UTF-8 at byte {fault.start}") from fault


def parse(data: str | bytes, name: str) -> Element:
    """Root element of an XML document.

    Parameters: data, the document; name, what to call it in messages.
    Raises: InputError where data is no text; ModelError, with file and line, for an empty text, one
    of more than 64 MiB, malformed XML, and any document type declaration, which is refused before
    anything in it is read: no entity is ever expanded.
    """
    if not isinstance(name, str):
        raise InputError(
            f"name: expected what to call the text in messages, a str, got {safe_repr(name)}"
        )
    source = Source(name)
    if not isinstance(data, (str, bytes, bytearray)):
        raise InputError(f"{source.place()}: expected a text, str or bytes, got {safe_repr(data)}")
    # A str is text already: whatever encoding its first line declares is no longer true.
    encoding = None
    if isinstance(data, str):
        encoding = "utf-8"
        data = data.encode("utf-8", "surrogatepass")
    content = bytes(data)
    if len(content) > MAX_BYTES:
        raise ModelError(
            f"{source.place()}: expected at most 64 MiB, got {len(content) / 2**20:.1f} MiB"
        )
    if not content.strip():
        raise ModelError(f"{source.place()}: the text is empty")
    try:
        etree.fromstring(content, etree.XMLParser(target=_DoctypeTrap(), encoding=encoding, **SAFE))
        return etree.fromstring(content, etree.XMLParser(encoding=encoding, **SAFE))
    except _DoctypeFound:
        raise ModelError(
            f"{source.place(_doctype_line(content))}: a document type declaration (DOCTYPE) is refused: no DTD, entity"
            " or external reference is read"
        ) from None
    except etree.XMLSyntaxError as fault:
        hint = ""
        if b"\0" in content[:1024]:
            hint = " (binary data?)"
        words = quote(fault.msg or "not XML", 200)
        raise ModelError(
            f"{source.place(fault.lineno or 1)}: malformed XML{hint}: {words}"
        ) from None


def _doctype_line(content: bytes) -> int:
    # Without its zero bytes, text in UTF-16 or UTF-32 shows its ASCII too.
    plain = content.replace(b"\0", b"")
    return plain.count(b"\n", 0, max(plain.find(b"<!DOCTYPE"), 0)) + 1
