"""Keys and numbers in the mappings of a calibration's file, refused with file and line."""

from __future__ import annotations

import math

import numpy as np

from ...errors import ModelError, quote, suggest
from ...groups import se3
from ...groups.arrays import Array
from ...groups.vectors import norm, rotation_part
from .. import rpy as angles
from ..text.numbers import real
from ..text.yaml_text import MappingNode, TextNode

KEYS = ("x", "y", "z", "roll", "pitch", "yaw")
AXIS = "axis"
"""Key of a joint's axis in files of Flexiv."""


def check(
    mapping: MappingNode,
    needed: tuple[str, ...],
    others: tuple[str, ...],
    place: str,
    what: str,
) -> None:
    """Check that a mapping has all these keys and no other. Raises: ModelError."""
    known = (*needed, *others)
    every = ", ".join(known)
    for key, line in mapping.key_lines.items():
        if key not in known:
            raise ModelError(
                f"{place}:{line}: {what}: {quote(key)} is not expected, only {every}; {suggest(key, known)}"
            )
    missing = [key for key in needed if key not in mapping.items]
    if missing:
        raise ModelError(
            f"{place}:{mapping.line}: {what}: {', '.join(missing)} missing; expected are {every}"
        )


def text(
    mapping: MappingNode,
    key: str,
    place: str,
) -> str:
    """Text of a key, empty where there is none. Raises: ModelError where it is a mapping."""
    value = mapping.items.get(key, TextNode("", 0))
    if not isinstance(value, TextNode):
        raise ModelError(f"{place}:{value.line}: {key}: expected a text")
    return value.text


def pose(
    mapping: MappingNode,
    name: str,
    place: str,
    rpy: str,
    others: tuple[str, ...] = (),
) -> Array:
    """Pose (4, 4) of six numbers under a name; rpy says which axes the angles turn about.

    Raises: ModelError.
    """
    node = mapping.items[name]
    if not isinstance(node, MappingNode):
        raise ModelError(
            f"{place}:{node.line}: {name}: expected {', '.join(KEYS)} below it, got {quote(node.text)}"
        )
    check(node, KEYS, others, place, name)
    x, y, z, *turns = (_number(node.items[key], f"{name}: {key}", place) for key in KEYS)
    if rpy == "fixed":
        return angles.pose((x, y, z), turns)
    R = rotation_part(angles.pose((0.0, 0.0, 0.0), [-a for a in turns])).T
    return se3.pose(R, (x, y, z))


def axis(
    mapping: MappingNode,
    name: str,
    place: str,
) -> Array | None:
    """Unit vector of three numbers in the axis of a joint, None where it has none.

    Raises: ModelError.
    """
    node = mapping.items[name]
    if not isinstance(node, MappingNode) or AXIS not in node.items:
        return None
    said = text(node, AXIS, place)
    values = [real(word) for word in said.split()]
    numbers = np.array([value for value in values if value is not None])
    length = 0.0
    if len(values) == len(numbers) == 3:
        length = norm(numbers)
    if not 0.0 < length < math.inf:
        raise ModelError(
            f"{place}:{node.items[AXIS].line}: {name}: axis: expected three numbers, as 0 1 0, got {quote(said)}"
        )
    return numbers / length


def _number(
    value: MappingNode | TextNode,
    what: str,
    place: str,
) -> float:
    words = "more keys"
    if isinstance(value, TextNode):
        words = value.text
    number = real(words)
    if number is None or not math.isfinite(number):
        raise ModelError(
            f"{place}:{value.line}: {what}: expected a finite number, got {quote(words)}"
        )
    return number
