"""Centres of tiles: unit vectors, in rings, as many above the equator as below."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.sweep.tile_centres import tile_centres
from tests.sweep.test_cells import centre


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_they_are_those_of_the_published_formula_for_each_tile(n):
    expected = [centre(f, i, j, n) for f in range(12) for i in range(n) for j in range(n)]
    np.testing.assert_allclose(tile_centres(n), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_they_lie_in_4_n_minus_1_rings_evenly_around_each(n):
    z = tile_centres(n)
    np.testing.assert_allclose(np.linalg.norm(z, axis=1), 1.0, rtol=1e-15)
    np.testing.assert_allclose(z.sum(axis=0), 0.0, atol=1e-12)
    heights, counts = np.unique(z[:, 2].round(12), return_counts=True)
    assert len(heights) == 4 * n - 1
    ring = np.arange(1, 4 * n)
    np.testing.assert_array_equal(counts, 4 * np.minimum(np.minimum(ring, 4 * n - ring), n))
