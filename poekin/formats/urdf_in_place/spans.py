"""Places in the text of a URDF: of each joint, and of the attributes of its origin and axis."""

from __future__ import annotations

import re
from typing import NamedTuple
from xml.parsers import expat

from ...errors import ModelError

_ATTRIBUTE = re.compile(rb"\s+([^\s=<>/\"']+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
_EDITED = ("origin", "axis", "parent")


class Attribute(NamedTuple):
    """Place of an attribute's value, between its quotes, and the value as XML means it."""

    start: int
    end: int
    value: str


class Tag(NamedTuple):
    """Place of a start tag: of `<`, and of the end of its name; its attributes in order."""

    start: int
    name_end: int
    attributes: dict[str, Attribute]


class JointSpan(NamedTuple):
    """Place of a joint's start tag, and the first of each of these tags in it, where there is one."""

    name: str
    start: int
    tags: dict[str, Tag]


class Spans(NamedTuple):
    """Joints of a URDF in order; place of the root's end tag, its `version`, and the prefix of tags
    ("" or "u:").
    """

    joints: list[JointSpan]
    end: int
    version: str | None
    prefix: str


def indent_before(content: bytes, at: int) -> bytes:
    """Line break and indent that end at a place; whatever blanks there are in their place."""
    last = content[content.rfind(b">", 0, at) : at]
    blanks = last[len(last.rstrip()) :]
    lines = blanks.rstrip(b" \t")
    line_end = lines[-1:]
    if lines.endswith(b"\r\n"):
        line_end = b"\r\n"
    return line_end + blanks[len(lines) :]


def find(content: bytes, place: str) -> Spans:
    """Places of the joints of a URDF, a text in UTF-8.

    Only a joint that is a child of the root counts, and in it only a child: an <origin> of a
    <visual> or a joint of a <transmission> is none. Raises: ModelError for what expat cannot read.
    """
    scanner = _Scanner(content)
    try:
        scanner.scan()
    except expat.ExpatError as fault:
        words = expat.errors.messages[fault.code]
        raise ModelError(
            f"{place}: line {fault.lineno}: cannot be edited in place: {words}"
        ) from fault
    return Spans(scanner.joints, scanner.end, scanner.version, scanner.prefix)


class _Scanner:
    """Handlers of expat that note where joints are."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.joints: list[JointSpan] = []
        self.end = 0
        self.version: str | None = None
        self.prefix = ""
        self._path: list[str] = []
        self._joint: JointSpan | None = None
        # a declaration must be the first thing in a text
        self._before = len(content) - len(content.lstrip())
        self._parser = expat.ParserCreate("utf-8")
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end

    def scan(self) -> None:
        self._parser.Parse(self.content[self._before :], True)

    def _at(self) -> int:
        return self._before + self._parser.CurrentByteIndex

    def _start(self, tag: str, values: dict[str, str]) -> None:
        depth = len(self._path)
        self._path.append(tag)
        if depth == 0:
            self.prefix = tag.removesuffix("robot")
            self.version = values.get("version")
        elif depth == 1 and tag == f"{self.prefix}joint":
            self._joint = JointSpan(values.get("name", ""), self._at(), {})
        elif depth == 2 and self._joint is not None and tag.startswith(self.prefix):
            name = tag.removeprefix(self.prefix)
            if name in _EDITED:
                self._joint.tags.setdefault(name, self._tag(tag, values))

    def _end(self, tag: str) -> None:
        self._path.pop()
        self.end = self._at()
        if self._joint is not None and len(self._path) == 1:
            self.joints.append(self._joint)
            self._joint = None

    def _tag(self, name: str, values: dict[str, str]) -> Tag:
        start = self._at()
        name_end = start + 1 + len(name.encode())
        attributes = {}
        at = name_end
        while found := _ATTRIBUTE.match(self.content, at):
            at = found.end()
            quoted = 2 if found[2] is not None else 3
            key = found[1].decode()
            attributes[key] = Attribute(*found.span(quoted), values[key])
        return Tag(start, name_end, attributes)
