"""XML read safely: no DTD, no entity, no network, nothing outside of the text itself."""

from __future__ import annotations

import os
import re
import stat
from typing import Any, Never
from xml.parsers import expat

from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]  (it is compiled and has no stubs)

from ...errors import (
    FileError,
    InputError,
    ModelError,
    escape_unprintable,
    quote,
    safe_repr,
)
from ...model.provenance import Source, warn
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

# Slips of real files that other readers of robots pass over, by libxml2's names of them.
SLIPS = {
    "ERR_UNKNOWN_VERSION": "the text is read as XML 1.0",
    "NS_ERR_UNDEFINED_NAMESPACE": "what the prefix marks is passed over",
}
_LATE_PROLOG = re.compile(rb"(\xef\xbb\xbf)?(\s+)(<\?xml\s[^>]*\?>)")


class _DoctypeFound(Exception):
    """Raised out of the parser at the first sign of a DTD, before it is read."""


class _Malformed(Exception):
    """Raised for a complaint of libxml2 that is no slip."""

    def __init__(self, complaint: Any) -> None:
        super().__init__(complaint.message)
        self.lineno = complaint.line


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


def parse(
    data: str | bytes,
    name: str,
    *,
    tell: bool = True,
    huge: bool = False,
) -> Element:
    """Root element of an XML document.

    Parameters: data, the document; name, what to call it in messages; tell, whether to warn; huge,
    whether texts of more than 10 MB and elements deeper than 256 are read, as meshes have them.
    Raises: InputError where data is no text; ModelError, with file and line, for an empty text, one
    of more than 64 MiB, malformed XML, and any document type declaration, which is refused before
    anything in it is read: no entity is ever expanded. Warns: PoekinWarning for blanks before the
    XML declaration and for `SLIPS`.
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
    content = _bounded(bytes(data), source)
    said: list[str] = []
    late = _LATE_PROLOG.match(content)
    if late:
        said.append(f"{source.place(1)}: blanks before the XML declaration are passed over")
        # the blanks go behind it, so that each line keeps its number
        content = (late[1] or b"") + late[3] + late[2] + content[late.end() :]
    try:
        root, slips = _parsed(content, encoding, huge)
    except _DoctypeFound:
        raise ModelError(
            f"{source.place(_doctype_line(content))}: a document type declaration (DOCTYPE) is refused: no DTD, entity"
            " or external reference is read"
        ) from None
    except (etree.XMLSyntaxError, expat.ExpatError, _Malformed) as fault:
        hint = ""
        if b"\0" in content[:1024]:
            hint = " (binary data?)"
        words = quote(str(getattr(fault, "msg", None) or fault), 200)
        raise ModelError(
            f"{source.place(fault.lineno or 1)}: malformed XML{hint}: {words}"
        ) from None
    if tell:
        for words in said + _told(slips, source):
            warn(words)
    return root


def _bounded(content: bytes, source: Source) -> bytes:
    if len(content) > MAX_BYTES:
        raise ModelError(
            f"{source.place()}: expected at most 64 MiB, got {len(content) / 2**20:.1f} MiB"
        )
    if not content.strip():
        raise ModelError(f"{source.place()}: the text is empty")
    return content


def _parsed(
    content: bytes,
    encoding: str | None,
    huge: bool,
) -> tuple[Element, list[Any]]:
    """Root element, and the slips that were passed over. Raises: what libxml2 or expat says of the
    text; `_Malformed`.
    """
    try:
        return _read(content, encoding, huge=huge)[0], []
    except etree.XMLSyntaxError as fault:
        root, slips = _read(content, encoding, recover=True, huge=huge)
        for slip in slips:
            if slip.type_name not in SLIPS:
                raise _Malformed(slip) from None
            # what a prefix marks may be passed over, but xacro's may hold joints
            if "prefix xacro " in slip.message:
                raise _Malformed(slip) from None
        # libxml2 keeps silent of some of what stands behind its first complaint, and of xacro
        # behind its hundredth
        try:
            expat.ParserCreate(encoding).Parse(content, True)
        except (ValueError, LookupError):  # an encoding that expat does not know
            raise fault from None
        if any(
            "xacro:" in name
            for element in root.iter("*")
            for name in (element.tag, *element.attrib)
        ):
            raise fault from None
        return root, slips


def _read(
    content: bytes,
    encoding: str | None,
    *,
    recover: bool = False,
    huge: bool = False,
) -> tuple[Element, list[Any]]:
    """Root element, and what libxml2 complained of; never of a text with a DTD."""
    options = {"encoding": encoding, **SAFE, "recover": recover, "huge_tree": huge}
    etree.fromstring(content, etree.XMLParser(target=_DoctypeTrap(), **options))
    parser = etree.XMLParser(**options)
    root = etree.fromstring(content, parser)
    return root, [slip for slip in parser.error_log if slip.level_name != "WARNING"]


def _told(slips: list[Any], source: Source) -> list[str]:
    """A warning for each kind of slip, by the first of them."""
    first = {slip.type_name: slip for slip in reversed(slips)}
    return [
        f"{source.place(slip.line)}: {escape_unprintable(slip.message, 200)}: {SLIPS[kind]}"
        for kind, slip in sorted(first.items())
    ]


def _doctype_line(content: bytes) -> int:
    # Without its zero bytes, text in UTF-16 or UTF-32 shows its ASCII too.
    plain = content.replace(b"\0", b"")
    return plain.count(b"\n", 0, max(plain.find(b"<!DOCTYPE"), 0)) + 1
