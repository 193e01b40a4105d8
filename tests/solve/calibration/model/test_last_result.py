"""The last result is computed once for each key that differs from the one before."""

from __future__ import annotations

from poekin.solve.calibration.model.last_result import LastResult


def test_the_same_key_again_computes_nothing():
    asked = []
    last = LastResult[int]()
    keys = [1, 1, 2, 1]
    found = [last(key, lambda key=key: asked.append(key) or 10 * key) for key in keys]
    assert found == [10, 10, 20, 10]
    assert asked == [1, 2, 1]
