"""Checks of an MJCF file and all that it names, before MuJoCo opens what it would not survive.

These are a model that attaches itself (MuJoCo's stack ends), copies without measure (it goes on for
hours), and NaN (which it takes for a number).
"""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from ...errors import ModelError, escape_unprintable, quote
from ...model.provenance import Source
from ..text import xml
from ..text.numbers import real

MOST_COPIES = 5000
"""Elements that all <replicate> together may make: MuJoCo takes a second for so many, and four for
twice as many.
"""
MOST_FILES = 1000
"""Files that are opened, each as often as it is named: two may name the next one twice, that the
next one twice, ...
"""

_NOT_A_NUMBER = re.compile(r"(?:^|\s)[+-]?nan(?:$|\s)", re.IGNORECASE)
_NUMBERS = (
    "pos",
    "quat",
    "axis",
    "axisangle",
    "xyaxes",
    "zaxis",
    "euler",
    "fromto",
    "range",
    "ref",
    "polycoef",
)


class _Opened(NamedTuple):
    """File, the files that lead to it, its folder, and the folder `top` of its model."""

    source: Source
    folder: str
    top: str
    above: tuple[str, ...]


def look_through(
    root: xml.Element,
    source: Source,
    folder: str,
    path: str = "",
) -> None:
    """Refuse what MuJoCo must not be given.

    Parameters: root <mujoco> of a document; source, what to call it; folder, in which files are
    that it names, "" for the working directory; path, of the document where it is a file.
    Raises: ModelError with file and line; FileError for a file named in it that cannot be read. One
    that does not exist is for MuJoCo to refuse.
    """
    count = 0
    copies = 0.0
    above: tuple[str, ...] = ()
    if path:
        above = (os.path.realpath(path),)
    ahead = [(root, _Opened(source, folder, folder, above))]
    while ahead:
        root, opened = ahead.pop()
        _refuse_nan(root, opened.source)
        copies += _copies(root)
        if copies > MOST_COPIES:
            raise ModelError(
                f"{opened.source.place()}: <replicate>: expected at most {MOST_COPIES} elements in copies"
            )
        for element in root.iter("include", "model"):
            inner = _named(element, opened)
            if inner is None:
                continue
            count += 1
            where = f"{opened.source.place(element.sourceline)}: <{element.tag}>"
            if inner.above[-1] in opened.above:
                raise ModelError(f"{where}: {inner.source.place()} includes itself")
            if count > MOST_FILES:
                raise ModelError(
                    f"{where}: expected at most {MOST_FILES} files, one for each time that one is named"
                )
            ahead.append((xml.parse(xml.read_bytes(inner.above[-1]), inner.source.name), inner))


def _named(element: xml.Element, opened: _Opened) -> _Opened | None:
    """The MJCF that an <include> or <model> names, as MuJoCo looks for it; None where there is
    none.
    """
    name = element.get("file") or ""
    whole = element.tag == "model"  # by itself, so that its includes are relative to its own folder
    if "\0" in name or not name.lower().endswith(".xml"):
        return None
    try:
        os.fsencode(name)
    except UnicodeEncodeError:  # no file can have this name here
        return None
    folders = [opened.folder]
    if not whole:
        folders.insert(0, opened.top)
    for folder in folders:
        path = os.path.realpath(os.path.join(folder, name))
        if os.path.isfile(path):
            inside = os.path.dirname(path)
            top = inside if whole else opened.top
            return _Opened(Source(path), inside, top, (*opened.above, path))
    return None


def _copies(root: xml.Element) -> float:
    """Number of elements below <replicate>, in all their copies."""
    total = 0.0
    times = {root: 1.0}
    for element in root.iterdescendants():
        copies = times[element.getparent()]
        if copies > 1:
            total += copies
        if element.tag == "replicate":
            more = real(element.get("count") or "")
            if more is not None and more > 1:
                copies *= more
        times[element] = copies
    return total


def _refuse_nan(root: xml.Element, source: Source) -> None:
    for element in root.iter():
        for attribute in _NUMBERS:
            text = element.get(attribute)
            if text and _NOT_A_NUMBER.search(text):
                where = source.place(element.sourceline)
                tag = escape_unprintable(element.tag, 80)
                raise ModelError(
                    f"{where}: <{tag}>: {attribute} must be finite numbers, got {quote(text)}"
                )
