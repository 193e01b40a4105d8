"""Residuals: distances in m and turns in rad, of which set and row, and their figures."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.model.residuals import (
    Residuals,
    concatenate,
    largest,
    median,
    residuals,
    rms,
)
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

POSES: Any = SimpleNamespace(width=6, angular=3)
POINTS: Any = SimpleNamespace(width=6, angular=0)  # two points
LENGTHS: Any = SimpleNamespace(width=1, angular=0)


def test_of_a_pose_the_angles_come_first_and_of_several_points_the_length_is_the_root_mean_square():
    errors = (
        np.array([[0, 3e-3, 4e-3, 1, 2, 2.0]]),
        np.array([[3, 0, 4, 0, 0, 12.0]]),
        np.array([[-7.0], [0.5]]),
    )
    rows = [np.array([4]), np.array([2]), np.array([0, 3])]
    found = residuals([POSES, POINTS, LENGTHS], rows, errors)
    np.testing.assert_allclose(found.length, [3, np.sqrt((25 + 144) / 2), 7, 0.5])
    np.testing.assert_allclose(found.angle, [5e-3, np.nan, np.nan, np.nan])
    assert found.set.tolist() == [0, 1, 2, 2]
    assert found.row.tolist() == [4, 2, 0, 3]
    assert len(found) == 4


def test_figures_are_of_what_was_measured_alone_and_said_in_mm_and_mrad():
    found = Residuals(
        np.array([1e-3, 3e-3, 8e-3]), np.array([2e-3, np.nan, 4e-3]), np.zeros(3, int), np.arange(3)
    )
    assert (found.median_length, found.rms_length) == (3e-3, pytest.approx(np.sqrt(74 / 3) * 1e-3))
    assert (found.median_angle, found.rms_angle) == (
        pytest.approx(3e-3),
        pytest.approx(np.sqrt(10) * 1e-3),
    )
    assert str(found) == "position 4.97 mm rms, median 3 mm; rotation 3.16 mrad rms, median 3 mrad"
    none = Residuals(found.length, np.full(3, np.nan), found.set, found.row)
    assert str(none) == "position 4.97 mm rms, median 3 mm"
    assert np.isnan([none.median_angle, none.rms_angle]).all()


def test_of_values_that_are_none_no_figure_is_known_and_the_largest_is_of_the_others():
    values = np.array([np.nan, 2.0, -3.0, 1.0])
    figures = (median, rms, largest)
    assert [f(values) for f in figures] == [1.0, pytest.approx(np.sqrt(14 / 3)), 2.0]
    assert all(type(f(values)) is float for f in figures)
    assert np.isnan([f(values[:1]) for f in figures]).all()


def test_of_a_set_there_are_its_own_residuals_alone():
    found = Residuals(np.arange(4.0), -np.arange(4.0), np.array([1, 0, 1, 2]), np.arange(4))
    assert found.of_set(1).row.tolist() == [0, 2]
    assert found.of_set(1).length.tolist() == [0, 2]
    assert len(found.of_set(3)) == 0


def test_parts_are_joined_in_the_order_of_set_and_row():
    def part(sets, rows):
        return Residuals(
            np.array(rows, float), -np.array(rows, float), np.array(sets), np.array(rows)
        )

    found = concatenate([part([1, 0], [5, 7]), part([0, 1, 0], [9, 2, 3])])
    assert found.set.tolist() == [0, 0, 0, 1, 1]
    assert found.row.tolist() == [3, 7, 9, 2, 5]
    assert found.length.tolist() == [3, 7, 9, 2, 5]
    assert found.angle.tolist() == [-3, -7, -9, -2, -5]


@pytest.mark.parametrize("kind", dataclasses_of("poekin.solve.calibration.model", "residuals"))
def test_residuals_cannot_be_changed_and_are_equal_to_themselves_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
