"""Rows of numbers that are no poses are refused, however large the numbers are."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import PoseError
from poekin.formats import pose_rows


@pytest.mark.parametrize("size", [1e-200, 1e154, 1e308, np.finfo(float).max], ids=str)
@pytest.mark.parametrize("order", pose_rows.ORDERS)
def test_a_quaternion_whose_square_is_no_number_is_refused(size, order):
    rows = np.array([[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, size, 0, 0, size]], float)
    with pytest.raises(PoseError, match=r"row 1: the quaternion's length is .*, expected 1 within 0\.001"):
        pose_rows.to_poses(rows, "7", order, lambda i: f"row {i}")


@pytest.mark.parametrize("order", pose_rows.ORDERS)
def test_a_row_that_is_not_finite_gives_nan(order):
    rows = np.array([[0, 0, 0, 1e308, np.inf, 0, 0], [0, 0, np.nan, 1, 0, 0, 0]], float)
    assert np.isnan(pose_rows.to_poses(rows, "7", order, str)).all()
