"""Six rows across eight columns of fourteen numbers: orthonormal and across, whatever the columns' sizes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import null_rows


@given(st.integers(0, 2**32 - 1))
def test_the_rows_are_orthonormal_and_across_all_columns(seed):
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(8, 14)) * 10.0 ** rng.uniform(-6, 3, (8, 1))
    B[rng.integers(8)] *= rng.integers(2)
    # a column that its reflection moves hardly at all, if its sign is not minded
    B[0] = 1e-9 * rng.normal(size=14)
    B[0, 0] = rng.choice([-1.0, 1.0])
    flat = [*B.ravel(), *([0.0] * 14 * 7)]
    null_rows.fill(flat)
    N = np.array(flat[14 * 9 :]).reshape(6, 14)
    # eight reflections of fourteen numbers
    assert np.abs(N @ N.T - np.eye(6)).max() <= 8 * 14 * 2.3e-16
    assert (np.abs(N @ B.T) <= 8 * 14 * 2.3e-16 * np.linalg.norm(B, axis=1)).all()
