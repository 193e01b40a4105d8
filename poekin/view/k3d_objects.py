"""Nodes as objects of k3d, numbered 1, 2, 3, …, in k3d's own offline page.

Nodes that move as one and look alike become one object: a browser draws few large objects faster
than many small ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import MissingExtra
from .nodes import Attachment, Cloud, Label, Node, Polyline, Triangles
from .palette import CLOUD, color
from .shapes import merged

LEVEL = 6
"""Level of compression: a page of meshes is made in half the time of level 9, and 1 % larger."""

LIGHT = 1.4
"""Brightness of the lights, by which white meshes are shaded still; 1.6 makes them white all over."""

Drawable = Triangles | Polyline | Cloud


@dataclass(frozen=True, slots=True, eq=False)
class DrawnObject:
    """Object of the page: its number, and the nodes in it, of which the first says how it moves."""

    number: int
    nodes: tuple[Drawable, ...]

    @property
    def attachment(self) -> Attachment:
        """Link, layer and look of all its nodes; the name is the first's."""
        return self.nodes[0].attachment


def grouped(nodes: Iterable[Node]) -> list[DrawnObject]:
    """Objects of the nodes, in their order; labels are no objects."""
    groups: dict[tuple[object, ...], list[Drawable]] = {}
    for place, node in enumerate(nodes):
        if not isinstance(node, Label):
            groups.setdefault(_look(node, place), []).append(node)
    return [DrawnObject(k, tuple(v)) for k, v in enumerate(groups.values(), start=1)]


def snapshot(objects: Sequence[DrawnObject], script: str) -> str:
    """Offline page of k3d with these objects; script runs when they are there, and finds the plot
    as K3DInstance.

    Raises
    ------
    MissingExtra
        If k3d is not installed.
    """
    try:
        import k3d
        from k3d.factory import plot as new_plot  # k3d.plot is a module as well
    except ImportError as missing:
        raise MissingExtra("k3d", "view", "drawing a page") from missing
    plot: Any = new_plot(
        grid_visible=False,
        menu_visibility=False,
        camera_auto_fit=False,
        camera_mode="orbit",
        camera_up_axis="z",
        camera_fov=35.0,
        axes_helper=0.0,
        colorbar_object_id=0,
        lighting=LIGHT,
    )
    for drawn in objects:
        made = _made(k3d, drawn)
        made.id = drawn.number  # k3d's own is the address in memory: no two pages would be equal
        plot += made
    return plot.get_snapshot(LEVEL, additional_js_code=script)


def _look(node: Drawable, place: int) -> tuple[object, ...]:
    """Look and link of a node, equal for all nodes of one object."""
    own: object = None
    if isinstance(node, Polyline):
        own = node.width
    elif isinstance(node, Cloud):
        own = place
    return type(node), own, replace(node.attachment, name="")


def _made(k3d: Any, drawn: DrawnObject) -> Any:
    """The object of k3d."""
    first = drawn.nodes[0]
    look = {"color": color(drawn.attachment), "opacity": drawn.attachment.opacity}
    if isinstance(first, Triangles):
        vertices, faces = merged(*((n.vertices, n.faces) for n in drawn.nodes))  # type: ignore[union-attr]
        # smooth shading would round the sharp edges of meshes off
        flat = first.attachment.layer == "meshes"
        shape = {"side": "double", "flat_shading": flat, "roughness": 0.7}
        return k3d.mesh(vertices.astype(np.float32), faces.astype(np.uint32), **shape, **look)
    if isinstance(first, Polyline):
        vertices, pairs = merged(*((n.points, _pairs(len(n.points))) for n in drawn.nodes))  # type: ignore[union-attr]
        shape = {"indices_type": "segment", "width": first.width, "shader": "mesh"}
        return k3d.lines(vertices.astype(np.float32), pairs.astype(np.uint32), **shape, **look)
    points = np.asarray(first.points, np.float32)
    shape = {"point_size": first.size, "shader": "3d"}
    if first.values is None:
        return k3d.points(points, **shape, **look)
    return k3d.points(
        points,
        attribute=np.asarray(first.values, np.float32),
        color_map=[part for x, value in enumerate(CLOUD) for part in (x, *_rgb(value))],
        opacity=drawn.attachment.opacity,
        **shape,
    )


def _rgb(value: int) -> tuple[float, float, float]:
    """Red, green and blue of 0xRRGGBB, from 0 to 1."""
    return (value >> 16) / 255, (value >> 8 & 255) / 255, (value & 255) / 255


def _pairs(count: int) -> np.ndarray:
    """Numbers of the ends of the pieces of a line through so many points."""
    start = np.arange(count - 1)
    return np.stack([start, start + 1], axis=1)
