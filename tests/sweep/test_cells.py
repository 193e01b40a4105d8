"""Cells of space and directions, against rounding down and the centres of HEALPix's tiles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError
from poekin.sweep import Cells
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be


def centre(face, i, j, n):
    """Centre of a tile by Górski et al. 2005: a ring and a place in it; i counts along x of the
    face, j along y.
    """
    ring = (face // 4 + 2) * n - i - j - 1
    first = (1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7)[face]
    if ring < n:
        across, z, shift = ring, 1 - ring**2 / (3 * n**2), 0
    elif ring > 3 * n:
        across = 4 * n - ring
        z, shift = -1 + across**2 / (3 * n**2), 0
    else:
        across, z, shift = n, (2 * n - ring) * 2 / (3 * n), (ring - n) % 2
    place = (first * across + i - j + 1 + shift) / 2
    turn = (place - (shift + 1) / 2) * np.pi / (2 * across)
    r = np.sqrt(1 - z * z)
    return np.array([r * np.cos(turn), r * np.sin(turn), z])


def poses(directions):
    """Poses at the origin whose z axes are these."""
    z = np.asarray(directions, float)
    T = np.tile(np.eye(4), (len(z), 1, 1))
    helper = np.where(np.abs(z[:, :1]) < 0.5, [[1.0, 0, 0]], [[0, 1.0, 0]])
    x = np.cross(helper, z)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    T[:, :3, 0] = x
    T[:, :3, 1] = np.cross(z, x)
    T[:, :3, 2] = z
    return T


ONE = Cells((-1.0, -1.0, -1.0), 2.0, (1, 1, 1))


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7])
def test_the_centre_of_each_tile_is_in_it(n):
    cells = Cells(ONE.corner, ONE.resolution, ONE.shape, n)
    every = [(face, i, j) for face in range(12) for i in range(n) for j in range(n)]
    found = cells.find(poses([centre(*tile, n) for tile in every]))
    assert found.tolist() == list(range(12 * n * n))


@pytest.mark.parametrize("n", [1, 3, 4])
def test_tiles_are_of_equal_area(n):
    z = np.random.default_rng(n).normal(size=(96_000, 3))
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    cells = Cells(ONE.corner, ONE.resolution, ONE.shape, n)
    counts = np.bincount(cells.find(poses(z)), minlength=cells.tiles)
    mean = len(z) / cells.tiles
    assert len(counts) == cells.tiles
    # of a count the variance is its mean; six standard deviations
    assert np.abs(counts - mean).max() < 6 * np.sqrt(mean)


@pytest.mark.parametrize("n", [2, 4])
def test_no_point_of_a_tile_is_farther_from_its_centre_than_half_a_diagonal(n):
    z = np.random.default_rng(9).normal(size=(5000, 3))
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    cells = Cells(ONE.corner, ONE.resolution, ONE.shape, n)
    found = cells.find(poses(z))
    centres = np.array([centre(t // (n * n), t // n % n, t % n, n) for t in found])
    angles = np.arccos(np.clip((z * centres).sum(axis=1), -1, 1))
    # the largest of all tiles, from a centre on the polar cap's edge to the tile's corner nearest the pole
    edge = np.array(
        [np.sqrt(5) / 3 * np.cos(np.pi / 4 / n), np.sqrt(5) / 3 * np.sin(np.pi / 4 / n), 2 / 3]
    )
    up = 1 - (1 - 1 / n) ** 2 / 3
    corner = np.array([np.sqrt(1 - up**2), 0.0, up])
    assert angles.max() <= np.arccos(edge @ corner)


@pytest.mark.parametrize("n", [1, 2, 4, 7])
@pytest.mark.parametrize("up", [-2 / 3, 2 / 3])
def test_a_rounding_below_a_whole_turn_is_in_the_tile_of_no_turn(n, up):
    out = np.sqrt(1 - up**2)
    cells = Cells(ONE.corner, ONE.resolution, ONE.shape, n)
    below, none = cells.find(poses([[out, -1e-18, up], [out, 0.0, up]]))
    assert below == none < cells.tiles


@given(st.lists(st.floats(-0.3, 0.7), min_size=3, max_size=3))
def test_a_point_is_in_the_cube_whose_corners_are_around_it(point):
    cells = Cells.box([-0.1, -0.1, -0.1], [0.5, 0.35, 0.2], 0.1)
    T = np.eye(4)
    T[:3, 3] = point
    found = int(cells.find(T))
    if found < 0:
        low = np.array(cells.corner)
        high = low + 0.1 * np.array(cells.shape)
        assert ((point < low + 1e-12) | (point >= high - 1e-12)).any()
    else:
        index = np.unravel_index(found, cells.shape)
        # the corner itself may be a rounding off
        assert np.abs(cells.centres()[index] - point).max() <= 0.05 + 1e-12


def test_a_box_is_covered_by_cubes_at_multiples_of_the_resolution():
    cells = Cells.box([-0.12, 0.0, 0.31], [0.12, 0.1, 0.32], 0.1, side=2)
    np.testing.assert_allclose(cells.corner, [-0.2, 0.0, 0.3], atol=1e-15)
    assert cells.shape == (4, 1, 1)
    assert cells.array_shape == (4, 1, 1, 48)
    assert cells.count == 192
    assert ONE.array_shape == (1, 1, 1)


@pytest.mark.parametrize("side", [0, 1, 3])
def test_the_middle_of_each_cell_is_in_it_however_it_is_turned(side):
    cells = Cells.box([-0.2, 0.1, 0.0], [0.2, 0.5, 0.4], 0.2, side)
    T = cells.poses(turns=5)
    assert T.shape == (2, 3, 2, cells.tiles, 5, 4, 4)
    numbers = np.arange(cells.count).reshape(2, 3, 2, cells.tiles)
    np.testing.assert_array_equal(cells.find(T), np.broadcast_to(numbers[..., None], T.shape[:-2]))
    # a fifth of a turn about z lies between neighbours
    relative = np.swapaxes(T[0, 0, 0, 0, 0, :3, :3], 0, 1) @ T[0, 0, 0, 0, 1, :3, :3]
    np.testing.assert_allclose(pk.so3.log(relative), [0, 0, 0.4 * np.pi], atol=1e-12)


def test_a_square_has_at_most_1024_tiles_along_a_side():
    assert Cells.box([0] * 3, [1] * 3, 1.0, side=1024).tiles == 12 * 1024**2
    with pytest.raises(InputError, match="side"):
        Cells.box([0] * 3, [1] * 3, 1.0, side=1025)


def test_a_pose_in_no_cell_is_in_minus_one():
    T = np.eye(4)
    T[0, 3] = 1e9
    assert int(ONE.find(T)) == -1


def test_a_batch_of_poses_keeps_its_shape():
    assert ONE.find(np.tile(np.eye(4), (2, 3, 1, 1))).tolist() == [[0] * 3] * 2


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: Cells.box([0, 0, 0], [1, 1, 1], 0.0), InputError, "resolution"),
        (
            lambda: Cells.box([0, 0, 0], [1, 0, 1], 0.1),
            InputError,
            r"^box: expected lower below upper, got \[0\. 0\. 0\.\] and \[1\. 0\. 1\.\]$",
        ),
        (
            lambda: Cells.box([0, 0], [1, 1, 1], 0.1),
            ShapeError,
            r"^lower: expected three finite numbers, m, got \[0, 0\]$",
        ),
        (lambda: Cells.box([0, 0, 0], [1, np.nan, 1], 0.1), ShapeError, "upper"),
        (
            lambda: Cells.box([0, 0, 0], [1, 1, 1], 1e-5),
            InputError,
            r"^resolution: expected at most 2\^40 cells, got 1e\+15, 100000 x 100000 x 100000 cubes of 1$",
        ),
        (lambda: Cells.box([0, 0, 0], [1, 1, 1], 0.1, side=-1), InputError, "side"),
        (lambda: ONE.find(2 * np.eye(4)), PoseError, "T"),
        (lambda: ONE.find(np.eye(3)), ShapeError, "T"),
        (lambda: ONE.poses(0), InputError, "turns"),
    ],
)
def test_what_is_no_box_and_no_pose_is_refused(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_the_public_name_is_this_one():
    assert pk.sweep.Cells is Cells


@pytest.mark.parametrize("kind", dataclasses_of("poekin.sweep", "cells"))
def test_a_box_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
