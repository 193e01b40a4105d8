"""The test vectors of an emitted self-test: coordinates, what the chain computes there, and the
error allowed.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin.formats.emit.vectors import vectors

from .emitted import FRAMES, arm, bound, expected


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_they_begin_at_zero_and_reach_over_half_a_turn_and_a_metre(kind):
    q = vectors(arm("mixed").compile(), "body", kind).q
    size = np.array([np.pi, 1, np.pi, np.pi, 1])
    assert q.shape == (8, 5)
    assert not q[0].any()
    assert (np.abs(q[1:]) <= size).all()
    assert (np.abs(q[1:]).max(axis=0) > 0.5 * size).all()
    assert (q.min(axis=0) < 0).all()
    assert (q.max(axis=0) > 0).all()
    np.testing.assert_array_equal(q, q.astype(kind))
    np.testing.assert_array_equal(q, vectors(arm("mixed").compile(), "space", kind).q)


@pytest.mark.parametrize(
    "name, frame", [*(("mixed", frame) for frame in (*FRAMES, 1)), ("coupled", "body")]
)
def test_they_hold_what_the_chain_computes_and_twice_its_bound(name, frame):
    chain = arm(name)
    q, T, J, tolerance = vectors(chain.compile(), frame, np.float64)
    for got, wanted in zip((T, J), expected(chain, frame, q), strict=True):
        assert np.abs(got - wanted).max() <= bound(chain, q)
    assert tolerance == pytest.approx(bound(chain, q), rel=1e-12)
    single = vectors(chain.compile(), frame, np.float32)
    assert single.tolerance == pytest.approx(bound(chain, single.q, 2.0**-24), rel=1e-12)
