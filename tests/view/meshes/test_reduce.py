"""Smaller meshes: as few triangles as were asked for, and no vertex farther off than said."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.view.meshes import reduce
from poekin.view.meshes.reduce import limit_for, reduced


def torus(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Torus of 2 n² triangles that faces outwards."""
    u, v = np.meshgrid(*[np.arange(n) * 2 * np.pi / n] * 2, indexing="ij")
    r = 1 + 0.3 * np.cos(v)
    vertices = np.stack([r * np.cos(u), r * np.sin(u), 0.3 * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    a, b = i * n + j, (i + 1) % n * n + j
    c, d = (i + 1) % n * n + (j + 1) % n, i * n + (j + 1) % n
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    return vertices.astype(np.float32), faces.astype(np.uint32)


def volume(vertices, faces) -> float:
    a, b, c = np.asarray(vertices, float)[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def distance(points: np.ndarray, others: np.ndarray) -> float:
    """Largest distance of a point to the nearest one of others."""
    return max(float(np.linalg.norm(others - point, axis=1).min()) for point in points)


@pytest.mark.parametrize("limit", [5000, 1000, 200])
def test_a_mesh_keeps_its_place_its_volume_and_its_sides(limit):
    vertices, faces = torus(80)
    fewer, kept, diagonal = reduced(vertices, faces, limit)
    assert 0.4 * limit < len(kept) <= limit
    used = fewer[np.unique(kept)]
    assert distance(used, vertices) <= diagonal
    assert distance(vertices, fewer) <= diagonal
    # the surface is moved by no more than the diagonal on all sides
    area = 4 * np.pi**2 * 0.3
    assert abs(volume(fewer, kept) - volume(vertices, faces)) <= area * diagonal
    assert volume(fewer, kept) > 0


def test_no_triangle_is_there_twice_or_without_area():
    _, kept, _ = reduced(*torus(60), 500)
    ordered = np.sort(kept, axis=1)
    assert (np.diff(ordered.astype(int), axis=1) > 0).all()
    turned = [tuple(np.roll(face, -int(np.argmin(face)))) for face in kept]
    assert len(set(turned)) == len(turned)


def test_a_small_mesh_comes_back_as_it_is():
    vertices, faces = torus(10)
    assert reduced(vertices, faces, 200) == (vertices, faces, 0.0)


@given(st.lists(st.integers(0, 1000), max_size=20), st.integers(1, 5000))
def test_the_limit_spends_the_budget_and_leaves_small_meshes_alone(counts, budget):
    limit = limit_for(counts, budget)
    spent = sum(min(count, limit) for count in counts)
    if sum(counts) <= budget:
        assert spent == sum(counts)
    else:
        assert budget - len(counts) < spent <= budget


def test_the_grid_is_found_in_the_steps_that_were_looked_at():
    """Counts and diagonals [m] of the torus, 2.6 m wide, as its pictures were found good enough."""
    found = [reduced(*torus(80), limit) for limit in (6000, 1000, 200)]
    diagonals = [diagonal for _, _, diagonal in found]
    np.testing.assert_allclose(diagonals, [0.103014, 0.311232, 0.700034], rtol=1e-5)


@pytest.mark.parametrize(
    ("counts", "budget", "limit"),
    [([], 5, 0), ([3], 3, 3), ([3], 2, 2), ([2, 10], 5, 3), ([10, 2], 5, 3), ([4, 4, 9], 11, 3)],
)
def test_what_small_meshes_leave_is_shared_by_the_others(counts, budget, limit):
    assert limit_for(counts, budget) == limit


def test_as_many_triangles_as_the_limit_are_enough():
    """Vertices that are far apart in a grid of a thousand cells; a triangle that is there twice is
    left out by it.
    """
    vertices, faces = torus(20)
    _, kept, diagonal = reduced(
        np.vstack([vertices, vertices[:1]]), np.vstack([faces, faces[:1]]), 800
    )
    assert len(kept) == 800
    assert diagonal == pytest.approx(2.6 / 1000 * 3**0.5, rel=1e-6)


def test_the_number_of_a_cell_is_that_of_its_digits_to_the_base_of_two_million():
    most = 2**21 - 1
    rows = np.array([[0, 0, 0], [1, 2, 3], [most, 0, most], [0, most, most], [most, most, most]])
    wanted = [(i * 2**21 + j) * 2**21 + k for i, j, k in rows.tolist()]
    assert reduce._number(rows).tolist() == wanted
