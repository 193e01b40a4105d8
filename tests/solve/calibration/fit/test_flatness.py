"""Extents of sets of points, and which sets are flat."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.fit.flatness import describe, extents, is_flat


def test_a_set_of_points_is_as_long_and_wide_as_its_root_mean_squares():
    points = np.array([[3.0, 0, 0], [-3, 0, 0], [0, 1, 0], [0, -1, 0]])
    sizes = extents(points)
    assert sizes == pytest.approx([np.sqrt(18 / 4), np.sqrt(2 / 4), 0])
    assert describe(sizes, 1) == "2.1 m along it and 0.71 m out of it, rms"
    assert describe(sizes, 2) == "2.1 m along it and 0 m out of it, rms"


@pytest.mark.parametrize("spread, scatter, flat", [
    ([1.0, 1e-6, 0], 0.0, True), ([1.0, 2e-6, 0], 0.0, False), ([2.0, 2e-6, 0], 0.0, True),
    ([1.0, 0.05, 0], 0.05, True), ([1.0, 0.06, 0], 0.05, False), ([1.0, 0.05, 0], 0.1, False),
    ([1.0, 0.05, 0], 0.099, True), ([2.0, 0.05, 0], 0.19, True),
])  # fmt: skip
def test_points_lie_flat_that_reach_no_farther_than_rounding_or_than_they_scatter(
    spread, scatter, flat
):
    assert is_flat(np.array(spread), 1, scatter) == flat
