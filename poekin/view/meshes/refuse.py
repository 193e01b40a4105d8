"""Mesh files that are refused before a library reads them: those that would never end.

A DAE or GLB is a tree, and may name one part of it many times, each of these many parts of others
many times, and so on.
"""

from __future__ import annotations

import json
import struct

from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]  (as in formats.text.xml)

from ...errors import FileError, ModelError
from ...formats.text import xml

MOST_NODES = 10_000
"""Elements of a DAE that name others."""
DEEPEST = 64
"""Nodes of a DAE between a scene and what is drawn."""
MOST = 128 * 2**20
"""Vertices, or characters of a DAE's numbers of vertices, in all places that name them."""


def checked(data: bytes, ending: str) -> bytes:
    """Content for a library to read, of a file with this ending.

    Of a DAE it is without textures: pycollada leaves out what has a texture whose image is not
    there. Raises: FileError that says why it is refused.
    """
    if ending == ".glb":
        _check_glb(data)
    if ending != ".dae":
        return data
    try:
        root = xml.parse(data, "mesh", tell=False, huge=True)
    except ModelError as fault:
        raise FileError(str(fault)) from fault
    _check_dae(root)
    textures = [texture.getparent() for texture in root.iter("{*}texture")]
    for element in (*textures, *root.iter("{*}newparam", "{*}library_images")):
        if element.getparent() is not None:
            element.getparent().remove(element)
    return etree.tostring(root)


def _check_dae(root: xml.Element) -> None:
    """Refuse nodes and geometries that are named too often."""
    sizes = {
        f"#{geometry.get('id')}": sum(len(p.text or "") for p in geometry.iter("{*}p"))
        for geometry in root.iter("{*}geometry")
    }
    inside: dict[str, list[str]] = {}
    named = list(root.iter("{*}instance_node", "{*}instance_geometry"))
    for element in named[:MOST_NODES]:
        for above in element.iterancestors("{*}node", "{*}visual_scene"):
            inside.setdefault(f"#{above.get('id')}", []).append(element.get("url") or "")
    for _ in range(DEEPEST):
        before = dict(sizes)
        for name, urls in inside.items():
            sizes[name] = 1 + sum(sizes.get(url, 0) for url in urls)
        if max(sizes.values(), default=0) > MOST or len(named) > MOST_NODES:
            raise FileError("its parts are named too many times")
        if sizes == before:
            return
    raise FileError("its nodes name each other, or too many times")


def _check_glb(data: bytes) -> None:
    """Refuse nodes with two parents, and arrays that hold more than the file."""
    try:
        length = struct.unpack_from("<I", data, 12)[0]
        tree = json.loads(data[20 : 20 + length])
        nodes = [node for scene in tree.get("scenes", []) for node in scene.get("nodes", [])]
        nodes += [child for node in tree.get("nodes", []) for child in node.get("children", [])]
        counts = [int(accessor["count"]) for accessor in tree.get("accessors", [])]
        sizes = [
            sum(1 + counts[part["attributes"]["POSITION"]] for part in mesh["primitives"])
            for mesh in tree.get("meshes", [])
        ]
        drawn = sum(sizes[node["mesh"]] for node in tree.get("nodes", []) if "mesh" in node)
    except (ValueError, LookupError, TypeError, AttributeError, struct.error, RecursionError) as f:
        raise FileError("it is no GLB of version 2") from f
    if len(set(nodes)) < len(nodes):
        raise FileError("a node is named twice")
    if max(counts, default=0) > len(data) or max(sum(sizes), drawn) > MOST:
        raise FileError("its arrays are larger than the file, or are named too many times")
