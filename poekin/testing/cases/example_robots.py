"""The robots of the package example-robot-data: the real URDFs on which poekin is validated."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

from ...formats import erd


def example_robots() -> tuple[dict[str, str], dict[str, str]]:
    """All its URDF files in two dicts from name ("erd:NAME" without the prefix) to path: robots,
    and files without one.

    A file without a single `<link>` holds no robot; the standard library's XML reader decides that,
    not poekin's. Raises: MissingExtra when example-robot-data is not installed.
    """
    robots = {}
    empty = {}
    for name, path in erd.available().items():
        has_link = ElementTree.parse(path).getroot().find("link") is not None
        (robots if has_link else empty)[name] = path
    return robots, empty
