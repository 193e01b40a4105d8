"""Conditions of readings: what is given is taken, what is not is derived from the order of rows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.calibration.terms.conditions import (
    at_rest,
    drift_source,
    in_order,
    later_conditions,
    parse_conditions,
)

Q = np.array([[0.0, 1.0], [0.5, 1.0], [0.2, 1.0], [0.2, 0.5]])
SIGNS = [[0, 0], [1, 0], [-1, 0], [-1, -1]]


def test_rows_in_order_say_the_move_before_and_how_each_joint_came():
    found, reference = parse_conditions(None, Q)
    np.testing.assert_array_equal(found.previous, Q[[0, 0, 1, 2]])
    # a joint that stands still came as it did when it last moved
    np.testing.assert_array_equal(found.approach, SIGNS)
    np.testing.assert_allclose(found.drift, np.array([-3, -1, 1, 3]) / 6, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(found.payload, np.zeros(4))
    np.testing.assert_array_equal(found.gravity, np.tile([0, 0, -1], (4, 1)))
    assert reference == {}


def test_columns_that_are_given_replace_what_the_order_says():
    previous = Q - [[0.1, -0.1]]
    given = {"previous": previous, "payload": [0, 1, 2, 5], "gravity": [0, -2, 0]}
    found, reference = parse_conditions(given, Q)
    np.testing.assert_array_equal(found.previous, previous)
    np.testing.assert_array_equal(found.approach, np.tile([1, -1], (4, 1)))
    np.testing.assert_array_equal(found.payload, [0, 1, 2, 5])
    np.testing.assert_array_equal(found.gravity, np.tile([0, -1, 0], (4, 1)))
    assert reference == {"payload": 2.0, "gravity": [0, -1, 0]}
    signs = np.ones_like(Q)
    found, _ = parse_conditions({"approach": signs, "previous": previous}, Q)
    np.testing.assert_array_equal(found.approach, signs)


@pytest.mark.parametrize("given", [("time",), ("temperature",), ("time", "temperature")])
def test_a_drift_follows_the_temperature_and_else_the_time_beyond_their_means(given):
    columns: dict[str, Any] = {"time": [0.0, 10, 20, 50], "temperature": [290.0, 291, 293, 294]}
    found, reference = parse_conditions({name: columns[name] for name in given}, Q)
    followed = given[-1]
    assert drift_source(reference) == followed
    np.testing.assert_array_equal(found.drift, columns[followed] - np.mean(columns[followed]))
    later = later_conditions({followed: 300.0}, Q, reference)
    np.testing.assert_array_equal(later.drift, np.full(4, 300 - np.mean(columns[followed])))


def test_at_rest_the_conditions_are_those_of_the_calibration_on_average():
    reference = {"payload": 3.0, "gravity": [0.0, -1.0, 0.0], "time": 7.0}
    found = at_rest(Q, reference)
    np.testing.assert_array_equal(found.previous, Q)
    np.testing.assert_array_equal(found.payload, np.full(4, 3.0))
    np.testing.assert_array_equal(found.gravity, np.tile([0, -1, 0], (4, 1)))
    assert not found.approach.any()
    assert not found.drift.any()
    for same, again in zip(found, later_conditions(None, Q, reference), strict=True):
        np.testing.assert_array_equal(same, again)
    np.testing.assert_array_equal(in_order(Q, reference).payload, found.payload)


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"weight": [1]}, UnknownName, "conditions: expected 'payload', .* got 'weight'"),
        ([1], InputError, "expected columns by name"),
        ({"payload": [1, 2]}, ShapeError, r"\['payload'\]: expected shape \(4,\), got \(2,\)"),
        ({"gravity": np.zeros(3)}, InputError, "expected directions in the base frame, got zero"),
        ({"approach": np.zeros(4)}, ShapeError, r"expected shape \(4, 2\), got \(4,\)"),
        ({"time": [0, 1, np.nan, 2]}, InputError, "time"),
    ],
)
def test_conditions_that_do_not_fit_are_refused(given, error, words):
    with pytest.raises(error, match=words):
        parse_conditions(given, Q)


def test_conditions_that_the_calibration_does_not_know_are_refused():
    with pytest.raises(InputError, match="the calibration was not told its payload"):
        later_conditions({"payload": 1.0}, Q, {"time": 0.0})
