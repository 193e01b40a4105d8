"""Visual: a shape that hangs on a link."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ...groups.arrays import Array

Shape = Literal["mesh", "box", "cylinder", "sphere", "capsule", "ellipsoid"]
ShapeTag = Literal["visual", "collision"]
Color = tuple[float, float, float, float]
"""Red, green, blue and opacity, from 0 to 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Visual:
    """Shape on a link.

    Attributes
    ----------
    link : str
        Link.
    T_link_visual : (4, 4) ndarray
        Pose of the shape in the link's frame, m.
    shape : Shape
        Kind of shape. All but meshes have their centre at the origin, and their axis along z.
    size : tuple of float
        Lengths of a box along x, y, z; radius and length of a cylinder, and of a capsule between
        the centres of its caps; radius of a sphere; semi-axes of an ellipsoid, m; factors along x,
        y, z of a mesh.
    color : Color or None
        Colour, None where the file says nothing or leaves it to the mesh.
    place : str
        File and line that it stands in, for messages.
    file : str
        Name of the file of a mesh, as the model writes it; for MJCF with its folder.
    triangles : tuple of ndarray or None
        Vertices (n, 3), m, and faces (k, 3) of a mesh that stands in the model itself.
    T_mesh : (4, 4) ndarray or None
        Pose that a mesh's vertices are put in before they are scaled; None for identity.
    """

    link: str
    T_link_visual: Array
    shape: Shape
    size: tuple[float, ...]
    color: Color | None
    place: str
    file: str = ""
    triangles: tuple[Array, np.ndarray] | None = None
    T_mesh: Array | None = None


class LeftOut(NamedTuple):
    """Shape that is not drawn: its link, its place in the model, what it is and why."""

    link: str
    place: str
    what: str
    why: str


class Visuals(NamedTuple):
    """Shapes of a robot, and what was left out of them."""

    found: tuple[Visual, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
