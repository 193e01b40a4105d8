"""Parts of a scene, asserted to be what a test takes them for."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from poekin.view.nodes import Node
from poekin.view.scene import Scene, SceneMotion

Kind = TypeVar("Kind")


def all_of(kind: type[Kind], nodes: Iterable[Node]) -> list[Kind]:
    """The nodes, all of one kind."""
    found: list[Kind] = []
    for node in nodes:
        assert isinstance(node, kind)
        found.append(node)
    return found


def motion_of(scene: Scene) -> SceneMotion:
    """The motion of a scene that has one."""
    assert scene.motion is not None
    return scene.motion
