"""Nodes that draw what a robot looks like: its visuals, on its links."""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np

from ...errors import FileError, quote
from ...formats.visuals.of_robot import visuals_of
from ...formats.visuals.visual import LeftOut, Visual
from ...groups.vectors import translation_part
from ...model.robot import Robot
from .. import shapes
from ..nodes import Attachment, Triangles
from ..shapes import Surface
from .find import MeshFinder
from .kept import parts_of
from .load import FARTHEST, MeshPart, merged, rgb
from .reduce import limit_for, reduced

BUDGET = 400_000
"""Triangles of a robot; a page of them has 5 MB."""
MOST_BYTES = 512 * 2**20
"""Bytes of all mesh files of a robot together."""
MOST_SHAPES = 1000
"""Shapes of a robot that are drawn."""


def mesh_nodes(robot: Robot) -> tuple[tuple[Triangles, ...], tuple[LeftOut, ...]]:
    """Nodes of all that can be drawn of a robot, and what cannot, with the reason.

    Parameters
    ----------
    robot : Robot
        Robot that was read from a URDF or MJCF; there is nothing to draw of another one.

    Returns
    -------
    nodes : tuple of Triangles
        For each link and colour one, in the layer "meshes", in the link's frame, m. A colour that
        the model names stands in place of that of the mesh's file.
    left_out : tuple of LeftOut
        Shapes that were not understood, files that were not found or not read; and if there are
        more than `BUDGET` triangles, a last line with the bound on how far a vertex was moved to
        have fewer.

    Raises
    ------
    MissingExtra
        If a mesh is to be read, and trimesh or pycollada is not installed.
    """
    found, left_out = visuals_of(robot)
    missing = list(left_out)
    reader = ShapeReader(robot)
    drawn: list[tuple[Visual, tuple[MeshPart, ...]]] = []
    for number, visual in enumerate(found):
        try:
            if number >= MOST_SHAPES:
                raise FileError(f"the shapes before it are {MOST_SHAPES} already")
            parts = reader.parts(visual)
            if _farthest(visual, parts) > FARTHEST:
                raise FileError(f"expected it within {FARTHEST:g} m of its link")
            drawn.append((visual, parts))
        except FileError as fault:
            what = quote(visual.file or visual.shape, 200)
            fault_of_visual = LeftOut(visual.link, visual.place, what, str(fault))
            missing.append(fault_of_visual)
    counts = [len(part.faces) for _, parts in drawn for part in parts]
    limit = limit_for(counts, BUDGET)
    pieces: dict[_Look, list[Surface]] = {}
    moved = 0.0
    for visual, parts in drawn:
        opacity = visual.color[3] if visual.color else 1.0
        for part in parts if opacity else ():
            vertices, faces, diagonal = reader.reduced(part, limit)
            moved = max(moved, diagonal * _largest(visual))
            color = part.color
            if visual.color is not None:
                color = rgb(255 * c for c in visual.color)
            group = pieces.setdefault(_Look(visual.link, color, opacity), [])
            group.append(placed(visual, vertices, faces))
    nodes = []
    for look, group in pieces.items():
        attachment = Attachment(
            "meshes",
            "first",
            robot.links.index(look.link),
            name=look.link,
            color=look.color,
            opacity=look.opacity,
        )
        nodes.append(Triangles(attachment, *shapes.merged(*group)))
    if moved:
        left = sum(len(node.faces) for node in nodes)
        words = f"{sum(counts)} triangles are drawn as {left}"
        why = f"no vertex is more than {moved * 1e3:.2g} mm off"
        missing.append(LeftOut("", str(robot.source), words, why))
    return tuple(nodes), tuple(missing)


class _Look(NamedTuple):
    """A link, and the colour and opacity of a part of what is drawn of it."""

    link: str
    color: int | None
    opacity: float


class _Reduced(NamedTuple):
    """A part with fewer triangles, and how far a vertex may be off, in the part's own unit."""

    vertices: np.ndarray
    faces: np.ndarray
    off: float


class ShapeReader:
    """Reader of the meshes of one robot, each file once; shapes of one size are made once."""

    def __init__(self, robot: Robot) -> None:
        self.finder = MeshFinder(str(robot.source))
        self.left = MOST_BYTES
        self.files: dict[str, tuple[MeshPart, ...]] = {}
        self.primitives: dict[tuple, tuple[MeshPart, ...]] = {}
        self.smaller: dict[int, _Reduced] = {}

    def parts(self, visual: Visual) -> tuple[MeshPart, ...]:
        """Triangles of a shape. Raises: FileError."""
        if visual.triangles is not None:
            vertices, faces = visual.triangles
            exist = (faces >= 0) & (faces < len(vertices))
            if not len(faces) or not exist.all():
                raise FileError("a face has a vertex that does not exist")
            return (MeshPart(*merged([visual.triangles]), None),)
        if visual.shape != "mesh":
            key = (visual.shape, visual.size)
            if key not in self.primitives:
                vertices, faces = _primitive(visual)
                self.primitives[key] = (MeshPart(vertices, faces, None),)
            return self.primitives[key]
        path = self.finder.find(visual.file)
        if path not in self.files:
            self.left -= os.path.getsize(path)
            if self.left < 0:
                raise FileError(f"the meshes before it have {MOST_BYTES >> 20} MiB already")
            self.files[path] = parts_of(path)
        return self.files[path]

    def reduced(self, part: MeshPart, limit: int) -> _Reduced:
        """MeshPart with so many triangles at most, and how far a vertex may be off, in its own unit."""
        known = id(part.faces)  # which the files, primitives and visuals keep
        if known not in self.smaller:
            fewer = reduced(part.vertices, part.faces, limit)
            self.smaller[known] = _Reduced(*fewer)
        return self.smaller[known]


def _primitive(visual: Visual) -> Surface:
    """Triangles of a shape that is no mesh."""
    size = visual.size
    if visual.shape == "box":
        return shapes.box(size)
    if visual.shape == "cylinder":
        return shapes.cylinder(*size, sides=32)
    if visual.shape == "capsule":
        radius, length = size
        end = np.array([0.0, 0.0, length / 2])
        return shapes.capsule(-end, end, radius, 32)
    unit = shapes.sphere()
    factors = (size * 3)[:3]
    return Surface(unit.vertices * factors, unit.faces)


def placed(visual: Visual, vertices: np.ndarray, faces: np.ndarray) -> Surface:
    """Triangles in the frame of their link, facing outwards still where a factor mirrors them."""
    points = np.asarray(vertices, dtype=float)
    if visual.shape == "mesh":
        if visual.T_mesh is not None:
            points = shapes.transformed(points, visual.T_mesh)
        points = points * visual.size
        if np.prod(visual.size) < 0:
            faces = faces[:, ::-1]
    return Surface(shapes.transformed(points, visual.T_link_visual), faces)


def _largest(visual: Visual) -> float:
    """Largest factor by which a shape's lengths are drawn."""
    if visual.shape != "mesh":
        return 1.0
    return max(map(abs, visual.size))


def _farthest(visual: Visual, parts: tuple[MeshPart, ...]) -> float:
    """Bound on the coordinates of a shape in its link's frame."""
    farthest = max(_largest_entry(part.vertices) for part in parts)
    if visual.T_mesh is not None:
        farthest += _largest_entry(translation_part(visual.T_mesh))
    origin = _largest_entry(translation_part(visual.T_link_visual))
    return farthest * _largest(visual) + origin


def _largest_entry(numbers: np.ndarray) -> float:
    return float(np.abs(numbers).max(initial=0.0))
