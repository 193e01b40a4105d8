"""Poses as controllers write them: p[...], {X 1, Y 2, ...}, X = 1 mm, ..., [[...], [...]], (...).

One pose a line, and the blocks P[n]{...} of Fanuc's LS files. What stands around a pose is passed
over, what stands in it and is not known is refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...errors import InputError, quote
from ...groups.arrays import Array
from ..text.numbers import real
from .layout import PoseLayout
from .places import places

_DIGIT = r"[-+]?\.?\d"
_NUMBER = rf"\s*{_DIGIT}"
# six numbers or more: Mitsubishi's flags stand in brackets too
_LIST = re.compile(rf"\(({_NUMBER}[^(),]*(?:,[^(),]*){{5,}})\)")
_PATTERNS: dict[str, tuple[re.Pattern[str], str]] = {
    "ur": (re.compile(rf"\bp\s*\[({_NUMBER}[^\[\]]*)\]"), "p[x, y, z, rx, ry, rz]"),
    "kuka": (
        re.compile(rf"\{{(\s*[A-Za-z]\w*\s{_NUMBER}[^{{}}]*)\}}"),
        "{X 1, Y 2, Z 3, A 4, B 5, C 6}",
    ),
    "abb": (
        re.compile(rf"\[\s*\[({_NUMBER}[^\[\]]*\]\s*,\s*\[[^\[\]]*)\]"),
        "[[x, y, z], [q1, q2, q3, q4]]",
    ),
    "staubli": (re.compile(rf"\{{\s*(?:\{{\s*)?({_DIGIT}[^{{}}]*)\}}"), "{x, y, z, rx, ry, rz}"),
    "yaskawa": (re.compile(rf"\b[CP]\d+\s*=({_NUMBER}.*)"), "C00000=x,y,z,rx,ry,rz"),
    "mitsubishi": (_LIST, "(x, y, z, a, b, c)"),
    "kawasaki": (_LIST, "TRANS(x, y, z, o, a, t)"),
    "doosan": (_LIST, "posx(x, y, z, a, b, c)"),
    "fanuc": (
        re.compile(rf"\b([XYZWPR]\s*={_NUMBER}.*)", re.DOTALL),
        "X = 1 mm, Y = 2 mm, Z = 3 mm, W = 4 deg, P = 5 deg, R = 6 deg",
    ),
}
_SAME = {"rotvec": "ur", "abc": "kuka", "wpr": "fanuc", "zyz": "doosan"}
_COMMENT = re.compile(r"\s*(?:;|!|#|//|$)")
_FANUC_BLOCK = re.compile(r"\bP\[\s{0,9}\d{1,9}[^\[\]\n]{0,99}\]\s*\{([^{}]*)\}")
_NOT_READ = {"kuka": re.compile("[ST]|E[1-6]"), "fanuc": re.compile("E[1-9]")}


class Pieces(NamedTuple):
    """Text of each pose, and where it stands."""

    texts: list[str]
    places: list[str]


def rows(text: str, layout: PoseLayout, where: str) -> tuple[Array, list[str]] | None:
    """Rows (N, k) of the poses in a text, and where each stands; None where the text has no pose as
    the controller of this format writes it.

    Raises: InputError, with the line.
    """
    vendor = _SAME.get(layout.format, layout.format)
    found = None
    if vendor == "fanuc":
        found = _fanuc_blocks(text, where)
    if found is None:
        if vendor not in _PATTERNS or not _PATTERNS[vendor][0].search(text):
            return None
        found = _lines(text, vendor, where)
    values = [
        _numbers(piece, layout, vendor, place)
        for piece, place in zip(found.texts, found.places, strict=True)
    ]
    return np.array(values, float).reshape(len(values), len(layout.columns)), found.places


def _fanuc_blocks(text: str, where: str) -> Pieces | None:
    blocks = list(_FANUC_BLOCK.finditer(text))
    if not blocks:
        return None
    starts = [block.start() for block in blocks]
    return Pieces([block[1] for block in blocks], places(text, starts, where))


def _lines(text: str, vendor: str, where: str) -> Pieces:
    """The part of each line that is a pose."""
    pattern, example = _PATTERNS[vendor]
    pieces = Pieces([], [])
    for number, line in enumerate(text.splitlines(), 1):
        if _COMMENT.match(line):
            continue
        matches = pattern.findall(line)
        if len(matches) != 1:
            count = f"{len(matches)} of them" if matches else quote(line.strip())
            raise InputError(f"{where}:{number}: expected one pose a line, {example}; got {count}")
        pieces.texts.append(matches[0])
        pieces.places.append(f"{where}:{number}")
    return pieces


def _numbers(piece: str, layout: PoseLayout, vendor: str, place: str) -> list[float]:
    """The numbers of one pose in the order of the columns."""
    if vendor in _NOT_READ:
        if vendor == "kuka":
            items = _kuka_items(piece, place)
        else:
            items = _fanuc_items(piece, layout, place)
        return _in_order(items, layout, vendor, place)
    words = piece.replace("[", " ").replace("]", " ").split(",")
    values = [_number(word, place) for word in words]
    if len(values) != len(layout.columns):
        names = " ".join(layout.columns)
        raise InputError(
            f"{place}: {len(layout.columns)} numbers expected ({names}), got {len(values)}"
        )
    return values


def _number(word: str, place: str) -> float:
    value = real(word)
    if value is None:
        raise InputError(f"{place}: a number expected, got {quote(word.strip())}")
    return value


def _kuka_items(piece: str, place: str) -> Iterator[tuple[str, float]]:
    """Keys and values of `X 1.0, Y 2.0`."""
    for item in piece.split(","):
        key, _, value = item.strip().partition(" ")
        yield key.upper(), _number(value, place)


def _fanuc_items(piece: str, layout: PoseLayout, place: str) -> Iterator[tuple[str, float]]:
    """Keys and values of `X = 1.0 mm, W = 2.0 deg`; units are held against those of the layout."""
    units: Mapping[str, str] = dict(zip(layout.columns, layout.units, strict=True))
    without_texts = re.sub("'[^']*'", "", piece)
    for item in re.split(r"[,\n]", without_texts):
        key, equals, rest = item.partition("=")
        key = key.strip().upper()
        if not equals:
            continue
        if re.fullmatch("J[1-9]", key):
            raise InputError(f"{place}: a pose expected, got joints ({key})")
        value, _, unit = rest.strip().partition(" ")
        unit = unit.strip(" \t;}")
        if unit and unit != units.get(key, unit):
            raise InputError(f"{place}: {key} is in {quote(unit)}, expected {units[key]}")
        yield key, _number(value.strip(";"), place)


def _in_order(
    items: Iterator[tuple[str, float]],
    layout: PoseLayout,
    vendor: str,
    place: str,
) -> list[float]:
    names = layout.columns
    given: dict[str, float] = {}
    for key, value in items:
        if _NOT_READ[vendor].fullmatch(key):
            continue
        if key not in names:
            raise InputError(f"{place}: {quote(key)} is none of {', '.join(names)}")
        if key in given:
            raise InputError(f"{place}: {key} is there twice")
        given[key] = value
    missing = [name for name in names if name not in given]
    if missing:
        raise InputError(f"{place}: expected {', '.join(names)}; {missing[0]} is missing")
    return [given[name] for name in names]
