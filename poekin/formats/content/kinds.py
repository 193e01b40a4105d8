"""Kinds of content by how it begins, for text that has no file name to go by."""

from __future__ import annotations

import codecs
import re
from typing import Literal

from ...errors import ModelError

Kind = Literal["xml", "parameter", "yaml", "toml", "csv"]
"""Kinds of text: "parameter" is what `ros2 param get` prints of a text."""

_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_LOOKED_AT = 2**16
"""Characters that the first line of a model begins in."""
_COMMENT = re.compile(r"(?:\s*#[^\n]*\n)*\s*")
_BEGINNINGS: tuple[tuple[Kind, re.Pattern[str]], ...] = (
    ("xml", re.compile(r"<")),
    ("parameter", re.compile(r"String value is:")),
    # a document mark, a text alone, a key with its value, or the key of a mapping
    ("yaml", re.compile(r"---\s|[\"']|[|>][-+]?\s|(?:data|robot_description):|[/\w*~.-]+:\s*\n")),
    # of calibrations, before the mapping that all of them have
    ("yaml", re.compile(r"[\w-]+:[ \t](?s:.*?)^kinematics\w*:", re.MULTILINE)),
    ("toml", re.compile(r"\[+[\w.-]+\]+[ \t]*(?:[#\r\n]|$)|[\w-]+[ \t]*=")),
    ("csv", re.compile(r"(?=[^\n]*\balpha\b)[\w \t]+,")),
)


def decode(content: str | bytes, place: str) -> str:
    """The text, of bytes in UTF-8, or UTF-16 with its mark. Raises: ModelError with the byte."""
    if isinstance(content, str):
        return content
    encoding = "utf-8-sig"
    if content.startswith(_UTF_16):
        encoding = "utf-16"
    try:
        return content.decode(encoding)
    except UnicodeDecodeError as fault:
        name = encoding.removesuffix("-sig").upper()
        raise ModelError(f"{place}: not {name} at byte {fault.start}") from fault


def kind_of(content: str | bytes) -> Kind | None:
    """Kind of a text, None for a text that begins as no model does; comments are passed over."""
    head = content[:_LOOKED_AT]
    if isinstance(head, bytes):
        # without its zero bytes, text in UTF-16 shows its ASCII too
        head = head.replace(b"\0", b"").decode("latin-1").lstrip("\xef\xbb\xbf\xff\xfe")
    head = head.lstrip("\ufeff")
    comments = _COMMENT.match(head)
    begin = comments.end() if comments else 0
    for kind, beginning in _BEGINNINGS:
        if beginning.match(head, begin):
            return kind
    return None
