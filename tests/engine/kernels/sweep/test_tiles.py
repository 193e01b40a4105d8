"""Tiles and cells uncompiled: the centre of each tile is in it, and so is what is near a corner of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.engine.kernels.sweep import tiles
from tests.sweep.test_cells import centre


def every(n: int) -> list[tuple[int, int, int]]:
    return [(face, i, j) for face in range(12) for i in range(n) for j in range(n)]


def tile_of(axis: np.ndarray, n: int) -> int:
    x, y, z = axis
    return tiles.tile(x, y, z, n)


@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_the_centre_of_each_tile_is_in_it(n):
    found = [tile_of(centre(*tile, n), n) for tile in every(n)]
    assert found == list(range(12 * n * n))


@pytest.mark.parametrize("n", [1, 3])
def test_the_centres_of_a_tile_s_nine_ninths_are_in_it(n):
    for number, (face, i, j) in enumerate(every(n)):
        ninths = [centre(face, 3 * i + a, 3 * j + b, 3 * n) for a in range(3) for b in range(3)]
        assert {tile_of(p, n) for p in ninths} == {number}


@pytest.mark.parametrize("n", [1, 4])
@pytest.mark.parametrize("z", [1.0, -1.0])
def test_a_pole_is_in_a_tile_that_ends_there(n, z):
    tile = tiles.tile(0.0, 0.0, z, n)
    assert tile == (n * n - 1 if z > 0 else 8 * n * n)


@pytest.mark.parametrize("n", [1, 5])
def test_a_unit_vector_longer_by_a_rounding_is_in_the_pole_s_tile(n):
    for z in (1 + 2.0**-52, -1 - 2.0**-52):
        assert tiles.tile(1e-9, 1e-9, z, n) == tiles.tile(1e-9, 1e-9, math.copysign(1, z), n)


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("z", [0.8, -0.8])
def test_on_a_cap_a_rounding_below_a_whole_turn_is_in_the_tile_before_it(n, z):
    assert tiles.tile(0.6, -1e-18, z, n) == tiles.tile(0.6, -1e-9, z, n)


SIDE = 0.25
CELLS = (2, 3, 4, 5)  # tiles along a side, and cubes
PLACE = (-1.0, 0.5, 2.0, 1 / SIDE)
SHARES = st.floats(1e-9, 1 - 1e-9)


@given(*[st.integers(0, k - 1) for k in CELLS[1:]], st.integers(0, 47), *[SHARES] * 3)
def test_a_cell_is_a_cube_and_a_tile_of_which_the_tile_changes_first(a, b, c, tile: int, u, v, w):
    p = np.add(PLACE[:3], SIDE * np.array([a + u, b + v, c + w]))
    axis = centre(*every(2)[tile], 2)
    number = np.ravel_multi_index((a, b, c), CELLS[1:])
    assert tiles.cell_of(CELLS, PLACE, p, axis) == 48 * number + tile
    assert tiles.cell_of((0, *CELLS[1:]), PLACE, p, axis) == number


@pytest.mark.parametrize("along", range(3))
@pytest.mark.parametrize("side", [0, 2])
def test_a_point_before_the_first_or_behind_the_last_cube_is_in_none(along, side):
    cells = (side, *CELLS[1:])
    for step, is_in in ((-1e9, False), (-1e-9, False), (1e-9, True)):
        first = np.add(PLACE[:3], SIDE / 2)
        first[along] = PLACE[along] + step
        last = first.copy()
        last[along] = PLACE[along] + SIDE * cells[1 + along] - step
        for p in (first, last):
            assert (tiles.cell_of(cells, PLACE, p, (0.0, 0.6, 0.8)) != -1) == is_in
