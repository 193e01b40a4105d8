"""Triangles have normals, and spheres around them centres that go further in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.formats.visuals import urdf_visuals
from poekin.sweep.masks import covering as module
from poekin.sweep.masks.covering import (
    _around,
    _candidates,
    _cover,
    _normals,
    _refined,
    _Skin,
    _skin,
    covering,
)
from poekin.sweep.tile_centres import tile_centres
from tests.sweep.masks.arm_of_all_shapes import SHAPES, robot_in, urdf

# of 0.3 m along x and 0.4 m along y, its front to +z, away from the origin
TRIANGLE = np.array([[[1.0, 2.0, 3.0], [1.3, 2.0, 3.0], [1.0, 2.4, 3.0]]])


def test_a_normal_is_twice_the_area_and_to_the_side_from_which_corners_go_round_to_the_left():
    turned = TRIANGLE[:, :, [2, 0, 1]]
    found = _normals(np.concatenate([TRIANGLE, turned, TRIANGLE[:, ::-1]]))
    expected = [[0, 0, 0.12], [0.12, 0, 0], [0, 0, -0.12]]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)


def test_centres_are_in_the_middle_and_up_to_two_lengths_behind_the_front():
    skin = _skin(TRIANGLE, 0.1)
    found = list(_candidates(TRIANGLE, skin))
    middle, length = np.array([1.15, 2.2, 3.0]), 0.4
    for one, depth in zip(found, (0.0, 0.25, 0.5, 1.0, 2.0), strict=True):
        centre = middle - [0, 0, depth * length]
        assert one.centre == pytest.approx(centre)
        # all corners are as far from the middle of the box around a right triangle
        assert one.radius == pytest.approx(np.hypot(0.25, depth * length))
        # looked at from 48 points of it
        points = np.array(one.centre) + one.radius * tile_centres(2)
        assert one.excess == skin.farthest(points)


def test_a_triangle_without_an_area_has_its_middle_as_the_centre_of_all():
    line = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]])
    centres = {one.centre for one in _candidates(line, _skin(TRIANGLE, 0.1))}
    assert centres == {(2.0, 0.0, 0.0)}


def test_the_farthest_point_is_that_of_those_that_are_before_the_nearest_normal():
    rng = np.random.default_rng(3)
    surface, normals, points = rng.normal(size=(3, 40, 3))
    skin = _Skin(surface, normals)
    away = []
    for point in points:
        number = np.linalg.norm(surface - point, axis=1).argmin()
        step = point - surface[number]
        if step @ normals[number] > 0:
            away.append(np.linalg.norm(step))
    assert 5 < len(away) < 35
    # a few roundings of numbers below 10
    assert skin.farthest(points) == pytest.approx(max(away), abs=1e-14)
    assert _Skin(surface, -(points - surface)).farthest(points[:1]) >= 0
    behind = _Skin(np.zeros((1, 3)), np.array([[0, 0, 1.0]]))
    assert behind.farthest(np.array([[3.0, 0, -1.0], [3.0, 0, 0.0], [0, 0, 0.0]])) == 0


@pytest.mark.parametrize("tolerance", [0.1, 0.8])
def test_a_surface_has_one_triangle_in_each_cube_of_half_the_tolerance(tolerance):
    pieces = np.random.default_rng(4).uniform(-1, 1, (200, 3, 3))
    first = {}
    for piece in pieces:
        cube = tuple(np.floor(piece.mean(axis=0) / (tolerance / 2)))
        first.setdefault(cube, piece)
    skin = _skin(pieces, tolerance)
    expected = np.array([first[cube] for cube in sorted(first)])
    np.testing.assert_array_equal(skin.points, expected.mean(axis=1))
    np.testing.assert_array_equal(skin.normals, _normals(expected))
    assert 1 < len(expected) <= 200


def test_a_triangle_is_cut_in_the_middle_of_its_longest_edge_until_none_is_longer():
    a, b, c = [0.0, 0, 0], [3.0, 0, 0], [0.0, 4, 0]  # the longest from b to c
    middle = [1.5, 2, 0]
    for corners in ([a, b, c], [b, c, a], [c, a, b]):
        found = _refined(np.array([corners, corners]), 4.0).tolist()
        assert sorted(found) == sorted(2 * [[b, middle, a], [middle, c, a]])
        # an edge as long as that is none that is longer
        assert _refined(np.array([corners]), 5.0).tolist() == [corners]
    fine = _refined(np.array([[a, b, c]]), 0.5)
    assert np.linalg.norm(np.roll(fine, -1, axis=1) - fine, axis=2).max() <= 0.5
    np.testing.assert_allclose(_normals(fine).sum(axis=0), [0, 0, 12], rtol=1e-12)
    assert (_normals(fine)[:, 2] > 0).all()


@pytest.mark.parametrize("axis", range(3))
def test_pieces_that_are_apart_have_a_sphere_each(axis):
    corners = 0.01 * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    small = corners[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]]
    near = [5.0, 5.4, 7.0]
    places = np.array([np.roll([x, 0.2, 3.0], axis) for x in near])
    surface = (places[:, None, None] + small).reshape(-1, 3, 3)
    found = list(_cover(surface, 0.02))
    assert len(found) == 3
    for one, place in zip(sorted(found, key=lambda x: x.centre[axis]), places, strict=True):
        assert np.abs(np.array(one.centre) - place).max() <= 0.02
        assert one.radius <= 0.02
    assert max(one.excess for one in found) <= 0.02
    (one,) = _cover(surface, 9.0)
    assert one.radius > 0.9


def test_a_triangle_has_a_sphere_however_far_that_stands_out(monkeypatch):
    candidate = module._Candidate(9.0, 1.0, (0.0, 0.0, 0.0))
    monkeypatch.setattr(
        module, "_candidates", lambda piece, skin: [candidate._replace(radius=len(piece))]
    )
    # of one the middle of the corners is below that of the box, of the other above
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0.5, 0]])
    for one in (triangle, -triangle):
        assert [found.radius for found in _cover(one[None], 2.0)] == [1]
    apart = triangle + 10 * np.array([[[0.0, 0, 0]], [[1, 0, 0]], [[1, 0, 1]], [[3, 0, 0]]])
    assert [found.radius for found in _cover(apart, 2.0)] == [1] * 4


def test_a_shape_that_is_round_is_inside_a_cylinder_of_a_32nd_of_a_turn_a_side():
    found = urdf_visuals.read(urdf(), "r", "collision").found
    (cylinder,) = (shape for shape in found if shape.shape == "cylinder")
    around = 0.05 / np.cos(np.pi / 32)
    assert _around(cylinder).size == pytest.approx((around, 0.3), rel=1e-15)
    capsule = _around(replace(cylinder, shape="capsule"))
    assert (capsule.shape, capsule.size) == ("cylinder", pytest.approx((around, 0.4), rel=1e-15))
    (ball,) = (shape for shape in found if shape.shape == "sphere")
    assert _around(ball) is ball


def test_a_sphere_is_larger_by_the_rounding_of_its_vertices(tmp_path):
    box = '<box size="0.5 0.25 0.125"/>'
    text = urdf(dict.fromkeys(SHAPES, box)).replace('xyz="0 0 0.15" rpy="0 0.1 0.3"', 'xyz="0 0 4"')
    found = covering(robot_in(tmp_path, text), 9.0).spheres
    # half the diagonal, and 2^-22 of the largest coordinate; all vertices are exact
    radius = np.sqrt(0.25**2 + 0.125**2 + 0.0625**2) + 2.0**-22 * 4.0625
    assert [one.link for one in found] == list(SHAPES)
    for one in found:
        assert one.radius == pytest.approx(radius, abs=1e-12)
        assert one.centre == pytest.approx((0, 0, 4), abs=1e-12)
