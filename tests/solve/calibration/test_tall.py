"""QR and products by blocks of rows are those of the whole."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.tall import times, triangle


@pytest.mark.parametrize("shape", [(0, 3), (2, 5), (7, 7), (684, 35), (5000, 46), (20_001, 3), (4000, 0), (300, 200)])
def test_the_triangle_has_the_gram_matrix_of_the_whole(shape):
    A = np.random.default_rng(0).normal(size=shape) * np.geomspace(1, 1e-3, shape[1])
    R = triangle(A)
    assert R.shape == (min(shape), shape[1])
    sizes = np.linalg.norm(A, axis=0) + (len(A) == 0)
    # the columns' own sizes times rounding, u = 1.1e-16, of sums of up to 20 000 squares
    np.testing.assert_allclose(R.T @ R / np.outer(sizes, sizes), A.T @ A / np.outer(sizes, sizes), rtol=0, atol=1e-13)


@pytest.mark.parametrize("shape", [(0, 3, 2), (684, 46, 34), (10_000, 46, 34), (5, 1, 1)])
def test_the_product_is_that_of_the_whole(shape):
    rng = np.random.default_rng(0)
    A, B = rng.normal(size=shape[:2]), rng.normal(size=shape[1:])
    np.testing.assert_allclose(times(A, B), A @ B, rtol=0, atol=1e-13)
