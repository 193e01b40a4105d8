"""Shapes as closed triangles that face outwards: surfaces of revolution, tubes along a curve, boxes.
Vertices at sharp edges are there once for each side.

Arrows, cylinders, spheres and capsules are turned about z from a profile; arcs and helices are tubes.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..groups.arrays import Array
from ..groups.vectors import norm, normalised, rotation_part, translation_part
from ..model.geometry.local import turned_least

SHARP = 0.5
"""Cosine of the angle between two faces from which the edge between them is seen."""

SIDES = 16
"""Sides of the polygon that stands for a circle, where nothing else is said."""

AROUND = 8
"""Sides of a tube."""


def transformed(points: Array, T: Array) -> Array:
    """Points (..., 3) moved by a pose (4, 4)."""
    return points @ rotation_part(T).T + translation_part(T)


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
        R = np.reshape(turned_least(*z), (3, 3))
        vertices = self.vertices @ R.T + point
        return Surface(vertices, self.faces)


def merged(*parts: tuple[Array, np.ndarray]) -> Surface:
    """One surface of several; of lines likewise, whose pieces are pairs (k, 2) of vertices."""
    start = 0
    vertices = []
    faces = []
    for points, pieces in parts:
        vertices.append(points)
        faces.append(pieces + start)
        start += len(points)
    return Surface(np.concatenate(vertices), np.concatenate(faces))


def creased(surface: Surface) -> Surface:
    """Closed surface whose vertices at sharp edges are there once for each side, so that a renderer
    that shades smoothly shades across flat edges only.
    """
    faces = surface.faces
    normals = _normals(surface)
    first, second = _neighbours(faces)
    cosines = np.einsum("ki,ki->k", normals[first], normals[second])
    flat = cosines > SHARP
    patches = _joined(len(faces), first[flat], second[flat])
    # a vertex and a patch as one number
    corners = len(faces) * faces.ravel() + np.repeat(patches, 3)
    kept, numbers = np.unique(corners, return_inverse=True)
    vertices = surface.vertices[kept // len(faces)]
    return Surface(vertices, numbers.reshape(-1, 3))


def _normals(surface: Surface) -> Array:
    """Unit normals (k, 3) of the faces, outwards."""
    corners = surface.vertices[surface.faces]
    a = corners[:, 0]
    ab = corners[:, 1] - a
    ac = corners[:, 2] - a
    return normalised(np.cross(ab, ac))


def _neighbours(faces: np.ndarray) -> np.ndarray:
    """Two faces at each edge of a closed surface, (2, number of edges)."""
    ahead = np.roll(faces, -1, axis=1)
    begins = faces.T.ravel()
    ends = ahead.T.ravel()
    edges = np.stack([begins, ends], axis=1)
    edges.sort(axis=1)
    owners = np.tile(np.arange(len(faces)), 3)
    by_edge = owners[np.lexsort(edges.T)]
    return by_edge.reshape(-1, 2).T


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
    radii : (k - 2,) array_like
        Distances from z of the profile's corners between the first and the last, which are on it,
        m; none is 0.
    heights : (k,) array_like
        Heights of all corners, m.
    sides : int
        Sides of the polygon that stands for a circle, its corners on the circle.

    Returns
    -------
    surface : Surface
        Its volume is that of the profile turned about z, times
        sin(2π / sides) / (2π / sides).
    """
    turn = _turns(sides)
    r = np.asarray(radii, float)[:, None]
    z = np.asarray(heights, float)
    rings = np.empty((len(r), sides, 3))
    rings[..., 0] = r * np.cos(turn)
    rings[..., 1] = r * np.sin(turn)
    rings[..., 2] = z[1:-1, None]
    ends = np.zeros((2, 3))
    ends[:, 2] = z[[0, -1]]
    return _skin(rings, ends)


def _turns(sides: int) -> Array:
    """Angles (sides,) of a circle's corners, rad."""
    return 2 * np.pi / sides * np.arange(sides, dtype=float)


def _skin(rings: Array, ends: Array) -> Surface:
    """Closed surface over rings (n, sides, 3) of vertices, from one end point (2, 3) to the other."""
    count, sides, _ = rings.shape
    around = rings.reshape(-1, 3)
    vertices = np.concatenate([around, ends])
    faces = _between_rings(count, sides)
    return creased(Surface(vertices, faces))


def _between_rings(rings: int, sides: int) -> np.ndarray:
    """Faces of a skin over rings of vertices and two end points, which come last."""
    here = np.arange(sides)
    ahead = (here + 1) % sides
    below = sides * np.arange(rings - 1)[:, None]
    above = below + sides
    first = np.full(sides, rings * sides)
    last = first + 1
    top = (rings - 1) * sides
    corners = [
        (below + here, below + ahead, above + ahead),
        (below + here, above + ahead, above + here),
        (first, ahead, here),
        (last, top + here, top + ahead),
    ]
    groups = []
    for three in corners:
        faces = np.stack(three, axis=-1)
        groups.append(faces.reshape(-1, 3))
    return np.concatenate(groups)


def tube(points: ArrayLike, radius: float) -> Surface:
    """Tube of a radius along a curve through points (n, 3) that does not turn back on itself."""
    points = np.asarray(points, float)
    tangents = normalised(np.gradient(points, axis=0))
    across = np.array(turned_least(*tangents[0])[0::3])
    turn = _turns(AROUND)[:, None]
    cosine = np.cos(turn)
    sine = np.sin(turn)
    rings = []
    for point, tangent in zip(points, tangents, strict=True):
        across = across - tangent * (tangent @ across)  # carried along without twist
        across = across / norm(across)
        aside = np.cross(tangent, across)
        circle = cosine * across + sine * aside
        rings.append(point + radius * circle)
    return _skin(np.array(rings), points[[0, -1]])


def cylinder(radius: float, length: float, sides: int = SIDES) -> Surface:
    """Cylinder about z, its middle at the origin."""
    half = 0.5 * length
    radii = [radius, radius]
    heights = [-half, -half, half, half]
    return revolved(radii, heights, sides)


def cone(radius: float, length: float, sides: int = SIDES) -> Surface:
    """Cone about z, its base at the origin and its point above."""
    return revolved([radius], [0, 0, length], sides)


def sphere(radius: float = 1.0, sides: int = 32) -> Surface:
    """Sphere about the origin, its vertices on it; half as many rings as sides."""
    count = sides // 2 + 1
    turn = np.linspace(0, np.pi, count)
    return revolved(*_half_circle(radius, turn), sides)


def _half_circle(radius: float, turn: Array) -> tuple[Array, Array]:
    """Profile of a sphere at angles from 0 to π from below, as `revolved` takes it."""
    return radius * np.sin(turn[1:-1]), -radius * np.cos(turn)


def capsule(start: ArrayLike, end: ArrayLike, radius: float, sides: int = SIDES) -> Surface:
    """All points within a radius of the segment between two points; a sphere where they are one."""
    start = np.asarray(start, float)
    way = np.asarray(end, float) - start
    length = norm(way)
    if length <= 1e-6 * radius:
        ball = sphere(radius, sides)
        return Surface(ball.vertices + start, ball.faces)
    right = 0.5 * np.pi
    quarter = np.linspace(0, right, sides // 4 + 1)
    turn = np.concatenate([quarter, right + quarter])  # the equator twice, at both ends
    radii, heights = _half_circle(radius, turn)
    apart = np.repeat([0.0, length], len(quarter))
    surface = revolved(radii, heights + apart, sides)
    return surface.placed(start, way / length)


def box(sizes: ArrayLike) -> Surface:
    """Box of sizes (3,) along x, y and z, its middle at the origin."""
    signs = list(product((-0.5, 0.5), repeat=3))
    corners = np.array(signs)
    sides = [
        [0, 1, 3, 2],  # -x
        [4, 6, 7, 5],  # +x
        [0, 4, 5, 1],  # -y
        [2, 3, 7, 6],  # +y
        [0, 2, 6, 4],  # -z
        [1, 5, 7, 3],  # +z
    ]
    halves = np.array(sides)[:, [0, 1, 2, 0, 2, 3]]
    faces = halves.reshape(-1, 3)
    vertices = corners * np.asarray(sizes, float)
    return creased(Surface(vertices, faces))


def arrow(
    length: float = 1.0,
    shaft: float = 0.02,
    head: float = 0.05,
    head_length: float = 0.15,
    sides: int = SIDES,
) -> Surface:
    """Arrow from the origin along z: radius of its shaft, radius and length of its head, m."""
    neck = length - head_length
    radii = [shaft, shaft, head]
    heights = [0, 0, neck, neck, length]
    return revolved(radii, heights, sides)


def double_arrow(length: float, shaft: float, head: float, head_length: float) -> Surface:
    """Arrow along z with a head at both ends, its middle at the origin: a prismatic joint."""
    half = 0.5 * length
    neck = half - head_length
    radii = [head, shaft, shaft, head]
    heights = [-half, -neck, -neck, neck, neck, half]
    return revolved(radii, heights)


def arc_arrow(radius: float, thickness: float, angle: float = 1.5 * np.pi) -> Surface:
    """Arc about z from the x axis on, with a head that points ahead: a revolute joint.

    The head is a cone of three times the tube's radius `thickness`, and ends at `angle`, rad.
    """
    tip = 3.0 * thickness
    neck = angle - 2.0 * tip / radius
    points = helix_points(radius, neck, 0.0)
    middle = 0.5 * (neck + angle)
    x = -np.sin(middle)
    y = np.cos(middle)
    ahead = np.array([x, y, 0.0])
    head = cone(tip, 2.0 * tip, AROUND)
    shaft = tube(points, thickness)
    return merged(shaft, head.placed(points[-1], ahead))


def helix(radius: float, thickness: float, rise: float) -> Surface:
    """Tube along a helix about z, its middle at the origin: a helical joint.

    It rises by `rise` metres in three turns, and is left-handed where that is negative.
    """
    points = helix_points(radius, 6 * np.pi, rise)
    return tube(points - [0.0, 0.0, 0.5 * rise], thickness)


def helix_points(radius: float, angle: float, rise: float) -> Array:
    """Points (n, 3) of a helix about z from the x axis on, 24 a turn; of an arc where rise is 0."""
    steps = np.ceil(24 * angle / (2 * np.pi))
    count = max(2, int(steps) + 1)
    turn = np.linspace(0.0, angle, count)
    x = radius * np.cos(turn)
    y = radius * np.sin(turn)
    height = np.linspace(0.0, rise, count)
    return np.stack([x, y, height], axis=1)


def frame_axes(pose: Array, length: float) -> tuple[Surface, Surface, Surface]:
    """Arrows along x, y and z of a frame at a pose (4, 4), m."""
    one = _axis_arrow().scaled(length)
    origin = translation_part(pose)
    axes = rotation_part(pose).T
    x, y, z = (one.placed(origin, axis) for axis in axes)
    return x, y, z


@cache
def _axis_arrow() -> Surface:
    return arrow(1.0, 0.03, 0.08, 0.25, AROUND)
