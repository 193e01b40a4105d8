"""The defect of nine numbers that may be a rotation, against NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.formulas.lie import defect


@pytest.mark.parametrize("row", range(3))
@pytest.mark.parametrize("column", range(3))
def test_a_defect_of_any_two_rows_is_seen_at_its_size(row, column):
    # (I + d E) (I + d E)^T misses I by d + d^T, and d^2 more
    d = 1e-3
    M = np.eye(3)
    M[row, column] -= d
    expected = 2 * d - d * d if row == column else d
    assert abs(defect.orthonormality(M.ravel()) - expected) < 1e-15
    assert defect.orthonormality(np.eye(3).ravel()) == 0.0


def test_the_determinant_is_that_of_the_matrix():
    M = np.random.default_rng(11).normal(size=(20, 3, 3))
    for R in M:
        assert defect.determinant(R.ravel()) == pytest.approx(np.linalg.det(R), abs=1e-14)
