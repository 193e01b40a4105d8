"""Poses as ROS prints them: `tf2_echo`, and messages with a pose by `ros2 topic echo`."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.provenance import warn
from ..text.numbers import expected
from .layout import PoseLayout, layout
from .places import places

_WORD = r"\s*([^\s,{}]+)(?:\s*,)?\s*"
_XYZ = rf"\s*(?:\{{\s*)?x:{_WORD}y:{_WORD}z:{_WORD}"
_MESSAGE = re.compile(
    rf"\b(?:position|translation):{_XYZ}(?:\}}(?:\s*,)?\s*)?"
    rf"(?:orientation|rotation):{_XYZ}w:{_WORD}"
)
_BEGINNING = re.compile(r"\b(?:position|translation):")
_TRANSLATION = re.compile(r"\bTranslation:\s*\[([^\[\]]*)\]")
_DEGREES = re.compile(r"\bRPY \(degree\)\s*\[([^\[\]]*)\]")
_QUATERNION = re.compile(r"\bin Quaternion[^\[\]\n]{0,40}\[([^\[\]]*)\]")


class Read(NamedTuple):
    """Rows of numbers, their layout, and where each stands."""

    rows: Array
    layout: PoseLayout
    places: list[str]


def read(text: str, where: str) -> Read | None:
    """The poses that a text of ROS holds, None for any other text. Raises: InputError."""
    if _TRANSLATION.search(text) or "- Translation:" in text:
        return _tf2_echo(text, where)
    if _BEGINNING.search(text):
        return _messages(text, where)
    return None


def _messages(text: str, where: str) -> Read:
    """Each message's position and orientation, in the order of the text."""
    found = {match.start(): match for match in _MESSAGE.finditer(text)}
    for beginning in _BEGINNING.finditer(text):
        if beginning.start() not in found:
            raise InputError(
                f"{_place(text, beginning.start(), where)}: expected position: x, y, z and then"
                " orientation: x, y, z, w, as ros2 topic echo prints a pose; the text is cut or"
                " another message"
            )
    stands = places(text, found, where)
    rows = [
        [expected(word, place) for word in match.groups()]
        for match, place in zip(found.values(), stands, strict=True)
    ]
    return Read(np.array(rows, float), layout("ros"), stands)


def _tf2_echo(text: str, where: str) -> Read:
    """The last whole block of `tf2_echo`, which repeats one pose; by its line of degrees, which
    loses a hundredth of what the quaternion's three decimals lose.
    """
    starts = [match.start() for match in re.finditer("Translation:", text)]
    blocks = [text[a:b] for a, b in zip(starts, [*starts[1:], None], strict=True)]
    for pattern, chosen in ((_DEGREES, layout("rpy", deg=True)), (_QUATERNION, layout("ros"))):
        for start, block in zip(reversed(starts), reversed(blocks), strict=True):
            p = _TRANSLATION.search(block)
            turn = pattern.search(block)
            if p and turn:
                place = _place(text, start, where)
                words = f"{p[1]},{turn[1]}".split(",")
                row = [expected(word.strip(), place) for word in words]
                if len(row) != len(chosen.columns):
                    raise InputError(f"{place}: the block of tf2_echo is cut")
                _warn_of_digits(words, chosen, place)
                return Read(np.array([row]), chosen, [place])
    raise InputError(
        f"{where}: expected a block of tf2_echo, Translation and then Rotation; the text is cut"
    )


def _warn_of_digits(words: list[str], chosen: PoseLayout, place: str) -> None:
    """Say what the decimals of the text leave open: half a unit of the last one in each number."""
    decimals = max(len(word.strip().partition(".")[2]) for word in words)
    half = 0.5 * 10.0**-decimals
    if chosen.format == "ros":
        angle = np.degrees(4 * half)  # four components, each off by half: 2 |dq| = 4 half
    else:
        angle = 3 * half
    warn(
        f"{place}: tf2_echo prints {decimals} decimals: each coordinate is known to {1e3 * half:.2g}"
        f" mm, the rotation to {angle:.2g}°"
    )


def _place(text: str, at: int, where: str) -> str:
    return places(text, [at], where)[0]
