"""Spheres that cover a robot's collision geometry."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...errors import FileError, InputError, quote
from ...formats.visuals import urdf_visuals
from ...formats.visuals.visual import Visual
from ...groups.arrays import Array
from ...groups.vectors import dots, norms, translation_part
from ...model.robot import Robot
from ..tile_centres import tile_centres
from .spheres import LinkSphere

_DEPTHS = (0.0, 0.25, 0.5, 1.0, 2.0)  # of a piece's length: how far inside a sphere's centre is
_TILES = (
    2  # of a face of the sphere, whose centres are 48 points at which it is looked how far it is
)
_SIDES = 32  # of the polygon around a cylinder
_LEAST = np.finfo(float).tiny
_ROUNDED = 2.0**-22  # of the largest coordinate: vertices are kept in single precision


class Covering(NamedTuple):
    """Spheres, and how far the farthest of their points is outside of the geometry, m."""

    spheres: list[LinkSphere]
    excess: float


class _Candidate(NamedTuple):
    """A sphere, and how far it stands out."""

    excess: float
    radius: float
    centre: tuple[float, ...]


def covering(robot: Robot, tolerance: float) -> Covering:
    """Spheres around all <collision> geometry that stand out by `tolerance` (m) at most, where single
    triangles need no more.

    Raises: InputError where there is none, FileError where a mesh is not found or not read,
    MissingExtra without trimesh.
    """
    source = robot.source
    text = None if source is None else source.text
    shapes = [] if source is None or not text else _shapes(robot, text, source.name)
    if not shapes:
        raise InputError(
            f"self-collision: {robot!r} has no <collision> geometry of a URDF; give spheres"
        )
    spheres = []
    excess = 0.0
    for shape, corners in shapes:
        if shape.shape == "sphere":
            middle = translation_part(shape.T_link_visual).tolist()
            radius = shape.size[0]
            spheres.append(LinkSphere(shape.link, tuple(middle), radius))
            continue
        rounded = _ROUNDED * float(np.abs(corners).max())
        for found in _cover(corners, tolerance):
            excess = max(excess, found.excess)
            radius = found.radius + rounded
            spheres.append(LinkSphere(shape.link, found.centre, radius))
    return Covering(spheres, excess)


def _shapes(robot: Robot, text: str | bytes, name: str) -> list[tuple[Visual, Array]]:
    """Shapes and the corners (k, 3, 3) of their triangles, in the link's frame, m."""
    from ...view.meshes.mesh_nodes import ShapeReader, placed  # whose pages draw sweeps

    found, left_out = urdf_visuals.read(text, name, "collision")
    for left in left_out:
        raise InputError(f"self-collision: {left.place}: {left.why}")
    reader = ShapeReader(robot)
    shapes = []
    for shape in found:
        try:
            parts = reader.parts(_around(shape))
        except FileError as fault:
            what = quote(shape.file or shape.shape, 200)
            raise FileError(f"self-collision: {shape.place}: {what}: {fault}") from fault
        surfaces = [placed(shape, part.vertices, part.faces) for part in parts]
        corners = [surface.vertices[surface.faces] for surface in surfaces]
        shapes.append((shape, np.concatenate(corners)))
    return shapes


def _around(shape: Visual) -> Visual:
    """The shape, or one around it whose triangles hold it."""
    if shape.shape not in ("cylinder", "capsule"):
        return shape
    radius, length = shape.size
    if shape.shape == "capsule":
        length += 2 * radius
    around = radius / math.cos(math.pi / _SIDES)
    return replace(shape, shape="cylinder", size=(around, length))


def _cover(corners: Array, tolerance: float) -> Iterator[_Candidate]:
    """Spheres that hold triangles (k, 3, 3): of all of them, or where that one stands out too far, of
    those on either side of the middle.
    """
    pieces = _refined(corners, tolerance)
    skin = _skin(pieces, tolerance)
    waiting = [pieces]
    while waiting:
        piece = waiting.pop()
        best = min(_candidates(piece, skin))
        low = piece.min(axis=(0, 1))
        high = piece.max(axis=(0, 1))
        axis = int((high - low).argmax())
        middle = (low + high)[axis] / 2
        along = piece[:, :, axis].mean(axis=1)
        is_low = along < middle
        if best.excess <= tolerance or is_low.all() or not is_low.any():
            yield best
        else:
            waiting += [piece[is_low], piece[~is_low]]


def _candidates(piece: Array, skin: _Skin) -> Iterator[_Candidate]:
    """Spheres that hold triangles, their centres in the middle and further inside."""
    low = piece.min(axis=(0, 1))
    high = piece.max(axis=(0, 1))
    middle = (low + high) / 2
    length = (high - low).max()
    normals = _normals(piece)
    area = norms(normals).sum()
    outward = normals.sum(axis=0) / max(area, _LEAST)
    for depth in _DEPTHS:
        inside = depth * length
        centre = middle - inside * outward
        away = norms(piece - centre)
        radius = float(away.max())
        points = centre + radius * tile_centres(_TILES)
        yield _Candidate(skin.farthest(points), radius, tuple(centre.tolist()))


class _Skin(NamedTuple):
    """Points of a surface, and its normals there."""

    points: Array
    normals: Array

    def farthest(self, points: Array) -> float:
        """Distance of the farthest point from the surface, of those that are outside, m."""
        # a product of so few columns is slower where a library takes threads for it
        products = np.einsum("ik,kj->ij", points, np.ascontiguousarray(self.points.T))
        squares = (self.points**2).sum(axis=1) - 2 * products
        nearest = squares.argmin(axis=1)
        away = points - self.points[nearest]
        is_outside = dots(away, self.normals[nearest])[:, 0] > 0
        return float((norms(away) * is_outside).max())


def _skin(pieces: Array, tolerance: float) -> _Skin:
    """One triangle's middle and normal of each cube of half the tolerance."""
    middles = pieces.mean(axis=1)
    cubes = np.floor(middles / (tolerance / 2))
    _, first = np.unique(cubes, axis=0, return_index=True)
    return _Skin(middles[first], _normals(pieces[first]))


def _normals(pieces: Array) -> Array:
    """Normals (k, 3) of triangles, as long as twice their areas."""
    a, b, c = pieces.swapaxes(0, 1)
    return np.cross(b - a, c - a)


def _refined(corners: Array, longest: float) -> Array:
    """Triangles cut across their longest edges until none is longer."""
    while True:
        edges = norms(np.roll(corners, -1, axis=1) - corners)
        is_long = edges.max(axis=1) > longest
        if not is_long.any():
            return corners
        cut = corners[is_long]
        start = edges[is_long].argmax(axis=1)
        row = np.arange(len(cut))
        a, b, c = (cut[row, (start + k) % 3] for k in range(3))
        middle = (a + b) / 2
        first = np.stack([a, middle, c], axis=1)
        second = np.stack([middle, b, c], axis=1)
        corners = np.concatenate([corners[~is_long], first, second])
