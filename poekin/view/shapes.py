"""Shapes as closed triangles that face outwards: surfaces of revolution, tubes along a curve, boxes.
Vertices at sharp edges are there once for each side.

Arrows, cylinders, spheres and capsules are turned about z from a profile; arcs and helices are tubes.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..groups.arrays import Array
from ..model.geometry.local import turned_least

SHARP = 0.5
"""Cosine of the angle between two faces from which the edge between them is seen."""

SIDES = 16
"""Sides of the polygon that stands for a circle, where nothing else is said."""

AROUND = 8
"""Sides of a tube."""


def transformed(points: Array, T: Array) -> Array:
    """Points (..., 3) moved by a pose (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]


class Surface(NamedTuple):
    """Triangles: vertices (n, 3), m, and faces (k, 3), numbers of vertices, counter-clockwise seen
    from outside.
    """

    vertices: Array
    faces: np.ndarray

    def scaled(self, factor: float) -> Surface:
        """Surface enlarged from the origin."""
        return Surface(factor * self.vertices, self.faces)

    def placed(self, point: Array, z: Array) -> Surface:
        """Surface whose z axis comes to lie along the unit vector z, its origin at a point."""
        return Surface(self.vertices @ turned_least(z).T + point, self.faces)


def merged(*parts: tuple[Array, np.ndarray]) -> Surface:
    """One surface of several; of lines likewise, whose pieces are pairs (k, 2) of vertices."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    faces = [faces + start for (_, faces), start in zip(parts, starts, strict=True)]
    return Surface(np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces))


def creased(surface: Surface) -> Surface:
    """Closed surface whose vertices at sharp edges are there once for each side, so that a renderer
    that shades smoothly shades across flat edges only.
    """
    faces = surface.faces
    a, b, c = (surface.vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owners = np.tile(np.arange(len(faces)), 3)[np.lexsort(edges.T)]
    first, second = owners.reshape(-1, 2).T
    flat = np.einsum("ki,ki->k", normals[first], normals[second]) > SHARP
    patches = _joined(len(faces), first[flat], second[flat])
    corners = np.stack([faces, np.broadcast_to(patches[:, None], faces.shape)], axis=-1)
    kept, numbers = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
    return Surface(surface.vertices[kept[:, 0]], numbers.reshape(-1, 3))


def _joined(count: int, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """For each of count items the least of those that it is joined to, by way of others too."""
    patches = np.arange(count)
    while True:
        least = np.minimum(patches[first], patches[second])
        before = patches.copy()
        np.minimum.at(patches, first, least)
        np.minimum.at(patches, second, least)
        if np.array_equal(patches, before):
            return patches


def revolved(radii: ArrayLike, heights: ArrayLike, sides: int = SIDES) -> Surface:
    """Surface of revolution about z of a profile from below to above.

    Parameters
    ----------
    radii, heights : (k,) array_like
        Distances from z and heights of the profile's corners, m; the first and the last radius
        are 0, the others are not.
    sides : int
        Sides of the polygon that stands for a circle, its corners on the circle.

    Returns
    -------
    surface : Surface
        Its volume is that of the profile turned about z, times
        sin(2π / sides) / (2π / sides).
    """
    turn = 2 * np.pi / sides * np.arange(sides)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    r = np.asarray(radii, float)[1:-1, None, None]
    z = np.asarray(heights, float)
    h = np.broadcast_to(z[1:-1, None, None], (len(r), sides, 1))
    rings = np.concatenate([r * circle, h], axis=-1).reshape(-1, 3)
    ends = [[0.0, 0.0, z[0]], [0.0, 0.0, z[-1]]]
    vertices = np.concatenate([rings, ends])
    return creased(Surface(vertices, _between_rings(len(r), sides)))


def _between_rings(rings: int, sides: int) -> np.ndarray:
    """Faces of a skin over rings of vertices and two end points, which come last."""
    here = np.arange(sides)
    ahead = (here + 1) % sides
    below = sides * np.arange(rings - 1)[:, None]
    above = below + sides
    lower = np.stack([below + here, below + ahead, above + ahead], axis=-1)
    upper = np.stack([below + here, above + ahead, above + here], axis=-1)
    first = np.full(sides, rings * sides)
    last = first + 1
    top = (rings - 1) * sides
    caps = [
        np.stack([first, ahead, here], axis=-1),
        np.stack([last, top + here, top + ahead], axis=-1),
    ]
    return np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3), *caps])


def tube(points: ArrayLike, radius: float) -> Surface:
    """Tube of a radius along a curve through points (n, 3) that does not turn back on itself."""
    points = np.asarray(points, float)
    tangents = np.gradient(points, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    across = turned_least(tangents[0])[:, 0]
    rings = []
    turn = 2 * np.pi / AROUND * np.arange(AROUND)[:, None]
    for point, tangent in zip(points, tangents, strict=True):
        across = across - tangent * (tangent @ across)  # carried along without twist
        across = across / np.linalg.norm(across)
        circle = np.cos(turn) * across + np.sin(turn) * np.cross(tangent, across)
        rings.append(point + radius * circle)
    vertices = np.concatenate([*rings, points[[0, -1]]])
    return creased(Surface(vertices, _between_rings(len(points), AROUND)))


def cylinder(radius: float, length: float, sides: int = SIDES) -> Surface:
    """Cylinder about z, its middle at the origin."""
    half = 0.5 * length
    return revolved([0, radius, radius, 0], [-half, -half, half, half], sides)


def cone(radius: float, length: float, sides: int = SIDES) -> Surface:
    """Cone about z, its base at the origin and its point above."""
    return revolved([0, radius, 0], [0, 0, length], sides)


def sphere(radius: float = 1.0, sides: int = 32) -> Surface:
    """Sphere about the origin, its vertices on it; half as many rings as sides."""
    turn = np.linspace(0, np.pi, sides // 2 + 1)
    radii = radius * np.sin(turn)
    radii[[0, -1]] = 0.0
    return revolved(radii, -radius * np.cos(turn), sides)


def capsule(start: ArrayLike, end: ArrayLike, radius: float, sides: int = SIDES) -> Surface:
    """All points within a radius of the segment between two points; a sphere where they are one."""
    start = np.asarray(start, float)
    way = np.asarray(end, float) - start
    length = float(np.linalg.norm(way))
    if length <= 1e-6 * radius:
        ball = sphere(radius, sides)
        return Surface(ball.vertices + start, ball.faces)
    quarter = np.linspace(0, 0.5 * np.pi, sides // 4 + 1)
    turn = np.concatenate([quarter, 0.5 * np.pi + quarter])  # the equator twice, at both ends
    radii = radius * np.sin(turn)
    radii[[0, -1]] = 0.0
    heights = -radius * np.cos(turn) + np.repeat([0.0, length], len(quarter))
    return revolved(radii, heights, sides).placed(start, way / length)


def box(sizes: ArrayLike) -> Surface:
    """Box of sizes (3,) along x, y and z, its middle at the origin."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    faces = [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]  # fmt: skip
    return creased(Surface(0.5 * corners * np.asarray(sizes, float), np.array(faces)))


def arrow(
    length: float = 1.0,
    shaft: float = 0.02,
    head: float = 0.05,
    head_length: float = 0.15,
    sides: int = SIDES,
) -> Surface:
    """Arrow from the origin along z: radius of its shaft, radius and length of its head, m."""
    neck = length - head_length
    return revolved([0, shaft, shaft, head, 0], [0, 0, neck, neck, length], sides)


def double_arrow(length: float, shaft: float, head: float, head_length: float) -> Surface:
    """Arrow along z with a head at both ends, its middle at the origin: a prismatic joint."""
    half = 0.5 * length
    neck = half - head_length
    heights = [-half, -neck, -neck, neck, neck, half]
    return revolved([0, head, shaft, shaft, head, 0], heights)


def arc_arrow(radius: float, thickness: float, angle: float = 1.5 * np.pi) -> Surface:
    """Arc about z from the x axis on, with a head that points ahead: a revolute joint.

    The head is a cone of three times the tube's radius `thickness`, and ends at `angle`, rad.
    """
    tip = 3.0 * thickness
    neck = angle - 2.0 * tip / radius
    points = helix_points(radius, neck, 0.0)
    middle = 0.5 * (neck + angle)
    ahead = np.array([-np.sin(middle), np.cos(middle), 0.0])
    head = cone(tip, 2.0 * tip, AROUND).placed(points[-1], ahead)
    return merged(tube(points, thickness), head)


def helix(radius: float, thickness: float, rise: float) -> Surface:
    """Tube along a helix about z, its middle at the origin: a helical joint.

    It rises by `rise` metres in three turns, and is left-handed where that is negative.
    """
    points = helix_points(radius, 6 * np.pi, rise)
    return tube(points - [0.0, 0.0, 0.5 * rise], thickness)


def helix_points(radius: float, angle: float, rise: float) -> Array:
    """Points (n, 3) of a helix about z from the x axis on, 24 a turn; of an arc where rise is 0."""
    count = max(2, int(np.ceil(24 * angle / (2 * np.pi))) + 1)
    turn = np.linspace(0.0, angle, count)
    height = np.linspace(0.0, rise, count)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)


def frame_axes(pose: Array, length: float) -> tuple[Surface, Surface, Surface]:
    """Arrows along x, y and z of a frame at a pose (4, 4), m."""
    one = _axis_arrow().scaled(length)
    x, y, z = (one.placed(pose[:3, 3], pose[:3, k]) for k in range(3))
    return x, y, z


@cache
def _axis_arrow() -> Surface:
    return arrow(1.0, 0.03, 0.08, 0.25, AROUND)
