"""The smallest input that still fails: piece after piece is left out, as long as the failure stays
what it was.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

_TAG = re.compile(rb"<(/?)([\w:]+)[^<>]*?(/?)>")
_PARTS = re.compile(rb"[ \t\n][\w:]+=(\"[^\"]*\"|'[^']*')|[\"'][^\"']*[\"']|[^\n]*\n")


def smallest(data: bytes, fails: Callable[[bytes], bool], most: int = 1000) -> bytes:
    """What is left of an input that fails after at most so many attempts to leave a piece out."""
    left = most
    shrunk = True
    while shrunk and left > 0:
        shrunk = False
        for start, stop in _pieces(data):
            if left <= 0:
                break
            left -= 1
            if fails(data[:start] + data[stop:]):
                data, shrunk = data[:start] + data[stop:], True
                break
    return data


def _pieces(data: bytes) -> Iterator[tuple[int, int]]:
    """Where pieces begin and end, the largest first: elements of XML, attributes, lines, then
    anything at all.
    """
    named = {*_elements(data), *(match.span() for match in _PARTS.finditer(data))}
    yield from sorted(named, key=lambda span: span[0] - span[1])
    size = len(data) // 2
    while size >= 1:
        yield from ((start, start + size) for start in range(0, len(data), size))
        size //= 2


def _elements(data: bytes) -> Iterator[tuple[int, int]]:
    opened: list[tuple[bytes, int]] = []
    for match in _TAG.finditer(data):
        closing, name, alone = match.groups()
        if alone:
            yield match.span()
        elif not closing:
            opened.append((name, match.start()))
        elif opened and opened[-1][0] == name:
            yield opened.pop()[1], match.end()
