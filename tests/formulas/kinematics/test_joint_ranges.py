"""Travel and margin of limits, against NumPy and at a limit and in the middle."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.kinematics.joint_ranges import limit_margin, travel

U = 2.0**-53
ROWS = st.lists(
    st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(0, 9)), min_size=1, max_size=8
)


@given(ROWS)
def test_travel_is_the_largest_weighted_change(rows):
    q, r, w = np.array(rows).T
    expected = (np.abs(q - r) * w).max()
    assert travel(q, r, w, len(q)) == expected
    assert limit_margin(q, r, w, len(q)) == 1.0 - expected


def test_the_margin_is_0_at_a_limit_and_1_in_the_middle_by_the_worst_coordinate():
    limits = np.array([[-1.0, 3.0], [0.0, 0.3], [-np.pi, np.pi]])
    middles = limits.mean(axis=1)
    weights = np.array([2.0, 2.0, 0.0]) / np.ptp(limits, axis=1)  # the last one has none
    assert limit_margin(middles, middles, weights, 3) == 1.0
    for i in (0, 1):
        for end in (0, 1):
            q = middles.copy()
            q[i] = limits[i, end]
            assert abs(limit_margin(q, middles, weights, 3)) <= 4 * U
    assert limit_margin([2.0, 0.15, 9.0], middles, weights, 3) == 0.5
