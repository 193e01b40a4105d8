"""A scene as the JSON that a page carries: all but the geometry, which k3d's objects have."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from typing import Any

from ..errors import escape_unprintable
from ..results import plain
from .k3d_objects import DrawnObject
from .nodes import Attachment, Cloud, Label, Polyline, Triangles
from .palette import PALETTE, color
from .scene import Scene, SceneArm

_KINDS = {Triangles: "triangles", Polyline: "line", Cloud: "cloud"}


def scene_json(scene: Scene, objects: Sequence[DrawnObject]) -> str:
    """The JSON, safe inside an element <script>: `<`, `>` and `&` are escaped, and so is every
    character that cannot be printed; a number that is not finite is null.
    """
    contents = {
        "title": scene.title,
        "words": scene.words,
        "size": scene.size,
        "q": scene.q,
        "shown": sorted(scene.shown),
        "exaggerated": scene.exaggerated,
        "palette": {role: _css(value) for role, value in PALETTE.items()},
        "arms": [_arm(arm) for arm in scene.arms],
        "objects": [_object(drawn) for drawn in objects],
        "labels": [_label(node) for node in scene.nodes if isinstance(node, Label)],
        "motion": scene.motion,
        "choices": scene.choices,
        "tables": scene.tables,
    }
    text = json.dumps(_escaped(plain(contents)), allow_nan=False, separators=(",", ":"))
    for sign in "<>&":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


def _arm(arm: SceneArm) -> dict[str, Any]:
    """An arm without its program, which the page runs."""
    fields = _fields(arm)
    del fields["program"]
    return fields | {"base": arm.base.ravel()}


def _object(drawn: DrawnObject) -> dict[str, Any]:
    names = [n.attachment.name for n in drawn.nodes]
    kind = _KINDS[type(drawn.nodes[0])]
    return {"id": drawn.number, "kind": kind, "names": names} | _attachment(drawn.attachment)


def _label(node: Label) -> dict[str, Any]:
    return {"text": node.text, "point": node.point} | _attachment(node.attachment)


def _attachment(attachment: Attachment) -> dict[str, Any]:
    return _fields(attachment) | {"color": _css(color(attachment))}


def _fields(held: Any) -> dict[str, Any]:
    """Fields of a data class."""
    return {field.name: getattr(held, field.name) for field in dataclasses.fields(held)}


def _css(value: int) -> str:
    """A colour as CSS writes it."""
    return f"#{value:06x}"


def _escaped(value: object) -> object:
    """Plain data with every text escaped."""
    if isinstance(value, dict):
        return {key: _escaped(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_escaped(item) for item in value]
    if isinstance(value, str):
        return escape_unprintable(value)
    return value
