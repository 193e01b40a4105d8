"""An MJCF file and all that it names, looked through before MuJoCo opens them: what MuJoCo does not
survive is refused.

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
    """A file and those that lead to it; folder, in which it is, and top, that of the model which it
    belongs to.
    """

    source: Source
    folder: str
    top: str
    above: tuple[str, ...]


def look_through(root: xml.Element, source: Source, folder: str, path: str = "") -> None:
    """Refuse what MuJoCo must not be given.

    Parameters: root <mujoco> of a document; source, what to call it; folder, in which files are
    that it names, "" for the working directory; path, of the document where it is a file.
    Raises: ModelError with file and line; FileError for a file named in it that cannot be read. One
    that does not exist is for MuJoCo to refuse.
    """
    count, copies = 0, 0.0
    ahead = [(root, _Opened(source, folder, folder, (os.path.realpath(path),) if path else ()))]
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
                raise ModelError(f"{where}: {inner.source.place()} leads back to itself")
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
    for folder in (opened.folder,) if whole else (opened.top, opened.folder):
        path = os.path.realpath(os.path.join(folder, name))
        if os.path.isfile(path):
            inside = os.path.dirname(path)
            return _Opened(
                Source(path), inside, inside if whole else opened.top, (*opened.above, path)
            )
    return None


def _copies(root: xml.Element) -> float:
    """How many elements there are below <replicate>, in all their copies."""
    total, times = 0.0, {root: 1.0}
    for element in root.iterdescendants():
        above = times[element.getparent()]
        total += above if above > 1 else 0.0
        more = real(element.get("count") or "") if element.tag == "replicate" else None
        times[element] = above * more if more is not None and more > 1 else above
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
