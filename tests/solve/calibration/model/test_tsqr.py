"""QR and products by blocks of rows are those of the whole."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.model.tsqr import blocked_product, qr_r


@pytest.mark.parametrize(
    "shape", [(0, 3), (2, 5), (7, 7), (684, 35), (5000, 46), (20_001, 3), (4000, 0), (300, 200)]
)
def test_the_triangle_has_the_gram_matrix_of_the_whole(shape):
    A = np.random.default_rng(0).normal(size=shape) * np.geomspace(1, 1e-3, shape[1])
    R = qr_r(A)
    assert R.shape == (min(shape), shape[1])
    sizes = np.linalg.norm(A, axis=0) + (len(A) == 0)
    # the columns' own sizes times rounding, u = 1.1e-16, of sums of up to 20 000 squares
    np.testing.assert_allclose(
        R.T @ R / np.outer(sizes, sizes), A.T @ A / np.outer(sizes, sizes), rtol=0, atol=1e-13
    )


@pytest.mark.parametrize("shape", [(0, 3, 2), (684, 46, 34), (10_000, 46, 34), (5, 1, 1)])
def test_the_product_is_that_of_the_whole(shape):
    rng = np.random.default_rng(0)
    A, B = rng.normal(size=shape[:2]), rng.normal(size=shape[1:])
    np.testing.assert_allclose(blocked_product(A, B), A @ B, rtol=0, atol=1e-13)


@pytest.mark.parametrize("shape, blocks", [
    ((8192, 1), [(8192, 1)]), ((8193, 1), [(2, 8192, 1), (2, 1)]), ((8190, 3), [(3, 2730, 3), (9, 3)]),
    ((400, 100), [(2, 200, 100), (200, 100)]), ((7, 3), [(7, 3)]), ((30, 0), [(30, 0)]),
])  # fmt: skip
def test_a_block_of_a_qr_has_8192_numbers_or_twice_as_many_rows_as_columns(
    shape, blocks, monkeypatch
):
    taken, qr = [], np.linalg.qr
    monkeypatch.setattr(np.linalg, "qr", lambda A, mode: taken.append(A.shape) or qr(A, mode=mode))
    qr_r(np.ones(shape))
    assert taken == blocks


@pytest.mark.parametrize("shape, rows", [
    ((2**18 + 5, 1, 1), [2**18, 5]), ((2, 1, 2**18 + 1), [1, 1]), ((600, 20, 30), [436, 164]), ((9, 3, 0), [9]),
])  # fmt: skip
def test_a_block_of_a_product_has_as_many_rows_as_stay_within_2_to_the_18_multiplications(
    shape, rows, monkeypatch
):
    taken, matmul = [], np.matmul
    monkeypatch.setattr(
        np, "matmul", lambda A, B, out: taken.append(len(A)) or matmul(A, B, out=out)
    )
    blocked_product(np.ones(shape[:2]), np.ones(shape[1:]))
    assert taken == rows
