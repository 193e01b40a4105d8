"""Text of an XML file with all that it takes to make the same bytes of it again."""

from __future__ import annotations

import re
from typing import NamedTuple

from ...errors import ModelError, escape_unprintable, quote

# Marks by which a file says its encoding; the longer ones first, which begin as others do.
_MARKS = (
    (b"\xef\xbb\xbf", "utf-8"),
    (b"\xff\xfe\0\0", "utf-32-le"),
    (b"\0\0\xfe\xff", "utf-32-be"),
    (b"\xff\xfe", "utf-16-le"),
    (b"\xfe\xff", "utf-16-be"),
)
_UNMARKED = ((b"<\0", "utf-16-le"), (b"\0<", "utf-16-be"))
_DECLARED = re.compile(rb"\s*<\?xml\s[^>]*?encoding\s*=\s*[\"']([\w.:-]+)")


class DecodedText(NamedTuple):
    """Text of a file in UTF-8; the mark before it and the encoding that it has there."""

    content: bytes
    mark: bytes
    encoding: str

    def encoded(self, content: bytes) -> bytes:
        """The file with another content, in its own encoding."""
        return self.mark + content.decode().encode(self.encoding)


def decode(data: str | bytes, place: str) -> DecodedText:
    """Text of a file, or what is to be one. Raises: ModelError where the encoding is not known, or
    does not give the same bytes back.
    """
    try:
        if isinstance(data, str):
            content = data.encode()
            text = DecodedText(content, b"", _declared(content))
            text.encoded(content)
            return text
        mark, encoding = _marked(data)
        content = data[len(mark) :].decode(encoding).encode()
        text = DecodedText(content, mark, encoding)
        if text.encoded(content) == data:
            return text
        reason = f"{quote(encoding)} does not give the same bytes again"
    except (LookupError, ValueError) as fault:
        reason = escape_unprintable(fault, 200)
    raise ModelError(f"{place}: cannot be edited in place: {reason}; make it UTF-8")


def _marked(data: bytes) -> tuple[bytes, str]:
    """Mark at the beginning of a file, and its encoding."""
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return mark, encoding
    for beginning, encoding in _UNMARKED:
        if data.startswith(beginning):
            return b"", encoding
    return b"", _declared(data)


def _declared(content: bytes) -> str:
    found = _DECLARED.match(content)
    if found is None:
        return "utf-8"
    return found[1].decode()
