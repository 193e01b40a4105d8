"""Mesh files as parts of one colour each, by trimesh (extra `view`): the only file that imports it.

- DAE: its <unit> counts, as in RViz; its <up_axis> does not, as in RViz and Pinocchio: real files
  hang right so, but for those of a few robots, the iCub of example-robot-data among them.
- OBJ: the colours of its .mtl beside it; no texture is opened.
- GLB: only what is in the file itself.
"""

from __future__ import annotations

import io
import os
import re
import struct
from collections import Counter
from collections.abc import Iterable
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from ...errors import FileError, MissingExtra, PoekinError, escape_unprintable
from ...formats.text import xml
from .. import shapes
from . import refuse

ENDINGS = {".stl": "stl", ".obj": "obj", ".dae": "dae", ".glb": "glb", ".ply": "ply"}
FARTHEST = 1e9
"""Largest coordinate of a vertex [m]."""
_LIBRARY = re.compile(rb"^[ \t]*mtllib[ \t]+(.+?)[ \t]*\r?$", re.MULTILINE)
# what trimesh and pycollada raise of files that they do not understand
_FAULTS = (
    ValueError,
    TypeError,
    LookupError,
    AttributeError,
    RuntimeError,
    ArithmeticError,
    OSError,
    AssertionError,
    SyntaxError,
    ImportError,  # of a package that guesses encodings
    MemoryError,
    struct.error,
)


class MeshPart(NamedTuple):
    """Triangles of one colour: vertices (n, 3), m, float32; faces (k, 3), uint32; 0xRRGGBB or None."""

    vertices: np.ndarray
    faces: np.ndarray
    color: int | None


def load(data: bytes, path: str) -> tuple[MeshPart, ...]:
    """Parts of the content of a mesh file.

    Raises: FileError for what cannot be read; MissingExtra without trimesh or pycollada.
    """
    ending = os.path.splitext(path)[1].lower()
    if ending not in ENDINGS:
        raise FileError(f"expected a file that ends in {', '.join(ENDINGS)}")
    try:
        import trimesh

        if ending == ".dae":
            import_module("collada")  # which trimesh reads DAE with
    except ModuleNotFoundError as missing:
        package = missing.name or "trimesh"
        if package == "collada":
            package = "pycollada"
        raise MissingExtra(package, "view", "drawing meshes") from missing
    resolver = None
    if ending == ".obj":
        resolver = _materials(data, path)
    else:
        data = refuse.checked(data, ending)
    try:
        with np.errstate(all="ignore"):  # of numbers that are refused as vertices
            scene = trimesh.load_scene(
                io.BytesIO(data),
                file_type=ENDINGS[ending],
                resolver=resolver,
                process=False,
            )
            pieces = [piece for node in scene.graph.nodes_geometry for piece in _piece(scene, node)]
    except _FAULTS as fault:
        raise FileError(f"cannot be read: {escape_unprintable(str(fault), 200)}") from fault
    by_color: dict[int | None, list[tuple[np.ndarray, np.ndarray]]] = {}
    for vertices, faces, color in pieces:
        by_color.setdefault(color, []).append((vertices, faces))
    parts = [MeshPart(*merged(held), color) for color, held in by_color.items()]
    if not sum(len(part.faces) for part in parts):
        raise FileError("there are no triangles in it")
    return tuple(parts)


def _piece(scene: Any, name: str) -> list[tuple[np.ndarray, np.ndarray, int | None]]:
    """Triangles of a node of a scene and their colour; none of lines and points."""
    T, held = scene.graph[name]
    geometry = scene.geometry[held]
    faces = np.asarray(getattr(geometry, "faces", ()), dtype=np.int64)
    if not len(faces):
        return []
    vertices = shapes.transformed(np.asarray(geometry.vertices, dtype=float), T)
    unit = str(geometry.metadata.get("units") or "meters").partition(" * ")
    if unit[2]:
        vertices *= float(unit[0])
    if not np.all(np.abs(vertices) <= FARTHEST):
        raise ValueError(f"expected finite vertices within {FARTHEST:g} m")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ValueError("a face has a vertex that does not exist")
    return [(vertices, faces, _color(geometry.visual))]


def _color(visual: Any) -> int | None:
    """Colour of a piece: its material's, or the commonest one; None where the file has none."""
    if visual.kind is None:
        return None
    if visual.kind == "texture":
        material = visual.material
        if material is None:
            return None
        return rgb(material.main_color)
    colors = visual.face_colors if visual.kind == "face" else visual.vertex_colors
    ((commonest, _),) = Counter(map(tuple, colors.tolist())).most_common(1)
    return rgb(commonest)


def rgb(color: Iterable[float]) -> int:
    """Colour 0xRRGGBB of red, green and blue from 0 to 255, whatever is behind them."""
    red, green, blue, *_ = map(round, color)
    return red << 16 | green << 8 | blue


def merged(pieces: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, each once, and faces of several pieces, without faces of no area."""
    vertices, faces = shapes.merged(*pieces)
    vertices = vertices.astype(np.float32) + np.float32(0)  # -0 is 0
    keys = vertices.view(np.dtype((np.void, vertices.dtype.itemsize * 3))).ravel()
    _, first, place = np.unique(keys, return_index=True, return_inverse=True)
    return vertices[first], proper(place.ravel()[faces])


def proper(faces: np.ndarray) -> np.ndarray:
    """Faces with three different vertices."""
    a, b, c = faces.T
    return faces[(a != b) & (b != c) & (c != a)].astype(np.uint32)


def _materials(data: bytes, path: str) -> dict[str, bytes]:
    """Libraries of materials of an OBJ, those that lie beside it."""
    found = {}
    for match in _LIBRARY.finditer(data):
        name = match[1].decode("utf-8", "replace")
        beside = os.path.join(os.path.dirname(path), os.path.basename(name))
        if name.lower().endswith(".mtl") and len(found) < 16:
            try:
                found[name] = xml.read_bytes(beside)
            except PoekinError:  # it is drawn without colours
                continue
    return found
