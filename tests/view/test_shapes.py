"""Shapes are closed, face outwards, and hold the volume that they stand for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.view import shapes
from poekin.view.shapes import AROUND, SIDES, Surface

lengths = st.floats(-6.0, 2.0).map(lambda power: 10.0**power)
"""Sizes of parts, m, over eight decades, each on its own."""
points = st.tuples(*[st.floats(-10.0, 10.0)] * 3).map(np.array)


def volume(surface: Surface) -> float:
    """Signed volume: that of the tetrahedra over a vertex, positive where faces look outwards."""
    corners = (surface.vertices - surface.vertices[0])[surface.faces]
    return float(np.linalg.det(corners).sum() / 6)


def polygon(sides: int) -> float:
    """Area of the regular polygon in a circle, as a share of the circle's."""
    return math.sin(2 * math.pi / sides) / (2 * math.pi / sides)


def assert_closed(surface: Surface) -> None:
    """Each edge is in two faces, once in either direction, and each vertex is used: vertices of one
    place, to 1e-9 of the whole, counted as one.
    """
    assert np.array_equal(np.unique(surface.faces), np.arange(len(surface.vertices)))
    grid = np.round(surface.vertices / (1e-9 * np.ptp(surface.vertices, axis=0).max()))
    f = np.unique(grid, axis=0, return_inverse=True)[1].ravel()[surface.faces]
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    seen = {tuple(edge) for edge in edges.tolist()}
    assert len(seen) == len(edges)
    assert seen == {(b, a) for a, b in seen}


ALL = {
    "arrow": shapes.arrow(),
    "double_arrow": shapes.double_arrow(1.0, 0.02, 0.06, 0.2),
    "arc": shapes.arc_arrow(1.0, 0.05),
    "helix": shapes.helix(1.0, 0.05, 2.0),
    "left_handed_helix": shapes.helix(1.0, 0.05, -2.0),
    "capsule": shapes.capsule([0, 0, 1], [1, 2, 0], 0.2),
    "ball": shapes.capsule([1, 2, 3], [1, 2, 3], 0.2),
    "sphere": shapes.sphere(),
    "cone": shapes.cone(0.3, 1.0),
    "cylinder": shapes.cylinder(0.3, 1.0),
    "box": shapes.box([1, 2, 3]),
    "x": shapes.frame_axes(np.eye(4), 0.1)[0],
}


@pytest.mark.parametrize("surface", ALL.values(), ids=list(ALL))
def test_a_shape_is_closed_and_faces_outwards(surface):
    assert_closed(surface)
    assert volume(surface) > 0


# A determinant of three differences of coordinates of size r has an error of a few u r^3, and there
# are at most 1000 faces: 1e-12 of the volume where the parts are of one size. Parts drawn over eight
# decades cancel: the bound is 1e-12 of the box around.
def assert_volume(surface: Surface, expected: float) -> None:
    extent = float(np.ptp(surface.vertices, axis=0).max())
    assert abs(volume(surface) - expected) <= 1e-12 * extent**3


@given(lengths, lengths, st.integers(3, 40))
def test_a_cylinder_and_a_cone_have_their_volume(radius, length, sides):
    whole = math.pi * radius**2 * length * polygon(sides)
    assert_volume(shapes.cylinder(radius, length, sides), whole)
    assert_volume(shapes.cone(radius, length, sides), whole / 3)


@given(lengths, lengths, points)
def test_a_capsule_has_the_volume_of_cylinder_and_sphere(radius, length, start):
    """The rings of a ball in 8 steps of 22.5° hold what the trapezoids of its profile do."""
    end = start + length * np.array([2.0, -1.0, 2.0]) / 3
    made = shapes.capsule(start, end, radius)
    turn = np.linspace(0, math.pi, 9)
    r = np.sin(turn)
    frusta = np.diff(-np.cos(turn)) * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) / 3
    ball = math.pi * radius**3 * frusta.sum() * polygon(SIDES)
    bar = 0.0
    if length > 1e-6 * radius:
        bar = math.pi * radius**2 * length * polygon(SIDES)
    # vertices are rounded where they lie, up to 10 m + sizes from the origin
    far = np.abs(made.vertices).max() * 2.0**-52
    area = 40 * (radius + length) * radius
    assert abs(volume(made) - ball - bar) <= 1e-12 * (length + radius) ** 3 + far * area


def test_a_sphere_is_within_its_tessellation_of_the_true_volume():
    """An inscribed ball of n sides and n / 2 rings lacks at most the share 2 (π / n)² · 2."""
    for sides in (8, 16, 32, 64):
        ball = volume(shapes.sphere(0.5, sides))
        true = math.pi / 6
        assert 0 < 1 - ball / true < 4 * (math.pi / sides) ** 2


@given(lengths, st.floats(0.01, 0.3), st.floats(0.5, 6.0))
def test_a_tube_has_the_volume_of_its_section_along_the_curve(radius, share, angle):
    """Pappus: section × way of its middle. Chords of 15° are shorter by δ² / 6 = 0.3 %, δ = 7.5°, and
    the first and the last section lean by δ: of two steps that takes 1 - cos δ = 0.9 %.
    """
    curve = shapes.helix_points(radius, angle, 0.0)
    made = shapes.tube(curve, share * radius)
    section = math.pi * (share * radius) ** 2 * polygon(AROUND)
    assert abs(volume(made) / (section * angle * radius) - 1) < 0.012
    assert_closed(made)


@given(points, points.filter(lambda p: np.linalg.norm(p) > 1e-3), lengths)
def test_an_arrow_points_from_its_point_along_its_direction(point, way, length):
    z = way / np.linalg.norm(way)
    made = shapes.arrow(length, 0.02 * length, 0.05 * length, 0.2 * length).placed(point, z)
    end = point + length * z
    gaps = np.linalg.norm(made.vertices - end, axis=1)
    # rounding of the vertex itself, and of the rotation over the length
    assert gaps.min() <= 8 * 2.0**-53 * (np.abs(point).max() + length)
    assert_closed(made)


def test_the_arc_of_a_revolute_joint_turns_the_positive_way():
    """The head of a three quarter arc about z is at 270°, ahead of its tube, in the plane z = 0."""
    made = shapes.arc_arrow(1.0, 0.05)
    head = made.vertices[-2:]  # the ends of the cone: its base and its point
    base, tip = np.arctan2(head[:, 1], head[:, 0])
    assert -math.pi < base < tip < 0.0
    assert abs(tip + 0.5 * math.pi) < 0.05
    np.testing.assert_allclose(head[:, 2], 0.0, atol=1e-15)
    low, high = made.vertices[:, 2].min(), made.vertices[:, 2].max()
    assert high == pytest.approx(-low, abs=1e-15)
    assert high <= 3 * 0.05  # the head's radius


@pytest.mark.parametrize("radius", [0.25, 1.0, 3.0])
def test_an_arc_s_head_is_two_of_its_radii_long_and_ends_at_the_angle(radius):
    made = shapes.arc_arrow(radius, 0.02 * radius, 2.0)
    base, tip = made.vertices[-2:]
    assert np.linalg.norm(tip - base) == pytest.approx(6 * 0.02 * radius, rel=1e-14)
    # a chord instead of an arc of 0.12 rad
    end = radius * np.array([math.cos(2.0), math.sin(2.0), 0.0])
    assert np.linalg.norm(tip - end) <= 0.12**3 * radius


@pytest.mark.parametrize("rise", [2.0, -2.0])
def test_a_helix_is_right_handed_where_its_pitch_is_positive(rise):
    points = shapes.helix_points(1.0, 6 * math.pi, rise)
    assert len(points) == 3 * 24 + 1
    turning = np.cross(points[0], points[1])[2]
    assert turning > 0
    assert math.copysign(1.0, points[1, 2] - points[0, 2]) == math.copysign(1.0, rise)
    ends = shapes.helix(1.0, 0.05, rise).vertices[-2:]
    np.testing.assert_allclose(ends[:, 2], [-0.5 * rise, 0.5 * rise], rtol=1e-15)


def test_the_axes_of_a_frame_are_its_columns():
    pose = np.eye(4)
    pose[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    pose[:3, 3] = [1, 2, 3]
    for k, surface in enumerate(shapes.frame_axes(pose, 0.5)):
        reached = surface.vertices[-1]
        np.testing.assert_allclose(reached, pose[:3, 3] + 0.5 * pose[:3, k], atol=1e-15)


def test_only_sharp_edges_are_split():
    assert len(shapes.box([1, 2, 3]).vertices) == 24
    assert len(shapes.cylinder(1.0, 1.0, 16).vertices) == 4 * 16 + 2
    assert len(shapes.sphere(1.0, 16).vertices) == 7 * 16 + 2


def test_merged_pieces_keep_their_faces():
    """Of three vertices each, so that a face of the second begins at 3, and of the third at 6."""
    pieces = [(np.eye(3) * k, np.array([[0, 1, 2]])) for k in (1, 2, 3)]
    vertices, faces = shapes.merged(*pieces)
    assert faces.tolist() == [[0, 1, 2], [3, 4, 5], [6, 7, 8]]
    assert vertices[faces[2]].tolist() == (3 * np.eye(3)).tolist()


def test_a_capsule_between_equal_points_is_a_sphere_around_them():
    ball = shapes.capsule([1, 2, 3], [1, 2, 3], 0.5)
    distances = np.linalg.norm(ball.vertices - [1, 2, 3], axis=1)
    np.testing.assert_allclose(distances, 0.5, rtol=1e-14)


@pytest.mark.parametrize("radius", [2e-4, 0.5, 40.0])
def test_a_capsule_shorter_than_a_millionth_of_its_radius_is_a_sphere(radius):
    """A sphere of 16 sides has 7 rings and two ends, a capsule the ring of the equator twice."""
    for share, rings in ((0.0, 7), (0.9e-6, 7), (1.1e-6, 8), (1.0, 8)):
        made = shapes.capsule([0, 0, 0], [0, 0, share * radius], radius)
        assert len(made.vertices) == rings * 16 + 2
