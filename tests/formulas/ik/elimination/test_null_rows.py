"""Rows across columns of numbers: orthonormal and across, whatever the columns' sizes."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import null_rows


@pytest.mark.parametrize("length, columns", [(6, 2), (8, 6)])
@given(st.integers(0, 2**32 - 1))
def test_the_rows_are_orthonormal_and_across_all_columns(length, columns, seed):
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(columns, length)) * 10.0 ** rng.uniform(-6, 3, (columns, 1))
    B[rng.integers(columns)] *= rng.integers(2)
    # a column that its reflection moves hardly at all, if its sign is not minded
    B[0] = 1e-9 * rng.normal(size=length)
    B[0, 0] = rng.choice([-1.0, 1.0])
    before = [5.0] * 3
    flat = [*before, *B.ravel(), *([math.nan] * length * (length - columns))]
    null_rows.fill(flat, 3, length, columns)
    assert flat[:3] == before
    N = np.array(flat[3 + length * columns :]).reshape(-1, length)
    # a reflection of each column, of so many numbers
    rounding = columns * length * 2.3e-16
    assert np.abs(N @ N.T - np.eye(length - columns)).max() <= rounding
    assert (np.abs(N @ B.T) <= rounding * np.linalg.norm(B, axis=1)).all()
