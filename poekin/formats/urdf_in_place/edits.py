"""Changes to the text of one joint, word by word: the numbers that changed, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...groups.vectors import rotation_part, translation_part
from ...model.joint import MOVING, Joint
from .. import rpy
from ..poses import pose_rows
from ..poses.layout import layout
from ..text.numbers import shortest
from .spans import JointSpan, Tag, indent_before

_WORD = re.compile(rb"\S+")
_ZERO = (0.0, 0.0, 0.0)


class Edit(NamedTuple):
    """Bytes from start to end of a text, and those that come in their place."""

    start: int
    end: int
    new: bytes


class Numbers(NamedTuple):
    """Numbers of an attribute: new ones, those that it has, and the change that is rounding."""

    attribute: str
    new: Sequence[float]
    old: Sequence[float]
    still: float


class Still(NamedTuple):
    """Changes of a joint that are rounding: of an angle [rad] and of a length [m]."""

    angle: float
    length: float


class JointText(NamedTuple):
    """A joint as it is written: where, and as it was read; prefix of the tags, and whether
    quat_xyzw counts.
    """

    content: bytes
    span: JointSpan
    joint: Joint
    prefix: str
    quaternions: bool


def edits_of(text: JointText, wanted: Joint, still: Still) -> Iterator[Edit]:
    """Changes that make a joint's origin and axis the wanted ones; none where it did not move."""
    changed = list(_origin(text, wanted.origin, still))
    if changed:
        yield from _element(text, "origin", changed)
    if wanted.kind in (*MOVING, "planar"):
        new = Numbers("xyz", wanted.axis, text.joint.axis, still.angle)
        if _apart(new.new, new.old) > new.still:
            yield from _element(text, "axis", [new])


def apply_edits(content: bytes, edits: Sequence[Edit]) -> bytes:
    """Text with changes, which do not overlap; those at one place in their order."""
    parts = []
    at = 0
    for edit in sorted(edits, key=lambda edit: edit.start):
        parts += [content[at : edit.start], edit.new]
        at = edit.end
    return b"".join([*parts, content[at:]])


def _origin(text: JointText, new: Array, still: Still) -> Iterator[Numbers]:
    """Attributes of a joint's <origin> that change, with their numbers."""
    old = text.joint.origin
    xyz = translation_part(new)
    old_xyz = translation_part(old)
    if _apart(xyz, old_xyz) > still.length:
        yield Numbers("xyz", xyz.tolist(), old_xyz.tolist(), still.length)
    if _apart(rotation_part(new), rotation_part(old)) <= still.angle:
        return
    tag = text.span.tags.get("origin")
    written = {} if tag is None else tag.attributes
    if text.quaternions and "quat_xyzw" in written:
        words = written["quat_xyzw"].value.split()
        was = [float(word) for word in words]
        (row,) = pose_rows.to_rows(new[None], layout("ros"))
        quaternion = row[3:]
        if quaternion @ was < 0:
            quaternion = -quaternion
        yield Numbers("quat_xyzw", quaternion.tolist(), was, still.angle)
        return
    turns: Sequence[float] = _ZERO
    if "rpy" in written:
        turns = [float(x) for x in written["rpy"].value.split()]
    yield Numbers("rpy", rpy.nearest_angles(rotation_part(new), turns), turns, still.angle)


def _apart(a: Sequence[float] | Array, b: Sequence[float] | Array) -> float:
    return float(np.abs(np.subtract(a, b)).max())


def _element(
    text: JointText,
    name: str,
    changed: Sequence[Numbers],
) -> Iterator[Edit]:
    """Changes to a child of a joint; where there is none, a new one before its <parent>."""
    tag = text.span.tags.get(name)
    if tag is not None:
        for numbers in changed:
            yield from _attribute(text.content, tag, numbers)
        return
    parent = text.span.tags["parent"]
    quotes = quote_mark(text.content, parent)
    inside = "".join(_assignment(numbers, quotes) for numbers in changed)
    new = f"<{text.prefix}{name}{inside}/>".encode()
    yield Edit(parent.start, parent.start, new + indent_before(text.content, parent.start))


def _attribute(
    content: bytes,
    tag: Tag,
    numbers: Numbers,
) -> Iterator[Edit]:
    """Changes to the words of an attribute; where there is none, a new one behind the others."""
    attribute = tag.attributes.get(numbers.attribute)
    if attribute is None:
        ends = (other.end + 1 for other in tag.attributes.values())
        at = max(ends, default=tag.name_end)
        new = _assignment(numbers, quote_mark(content, tag))
        yield Edit(at, at, new.encode())
        return
    found = list(_WORD.finditer(content, attribute.start, attribute.end))
    raw = [word[0].decode() for word in found]
    if (
        raw != attribute.value.split()
    ):  # a character by its number, or a blank that is none of ASCII's
        yield Edit(attribute.start, attribute.end, shortest(_rounded(numbers)).encode())
        return
    for word, new, old in zip(found, numbers.new, raw, strict=True):
        if abs(new - float(old)) > numbers.still:
            yield Edit(*word.span(), shortest([new]).encode())


def _rounded(numbers: Numbers) -> list[float]:
    """New numbers, and the old one for each that changed by rounding alone."""
    pairs = zip(numbers.new, numbers.old, strict=True)
    return [old if abs(new - old) <= numbers.still else new for new, old in pairs]


def _assignment(numbers: Numbers, quotes: str) -> str:
    return f" {numbers.attribute}={quotes}{shortest(_rounded(numbers))}{quotes}"


def quote_mark(content: bytes, tag: Tag) -> str:
    """Quote that the first attribute of a tag stands in; a double one where it has none."""
    for attribute in tag.attributes.values():
        return chr(content[attribute.end])
    return '"'
