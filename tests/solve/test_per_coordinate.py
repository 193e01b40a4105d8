"""A positive number for each coordinate."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.per_coordinate import per_coordinate

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 1.0)], np.eye(4), joint_names=["a", "b"]
)


def test_one_number_or_one_for_each_or_names():
    assert per_coordinate(2, ARM, "speed").tolist() == [2.0, 2.0]
    assert per_coordinate([1, 2], ARM, "speed").tolist() == [1.0, 2.0]
    assert per_coordinate({"b": 1, "a": 2}, ARM, "speed").tolist() == [2.0, 1.0]


@pytest.mark.parametrize(
    ("value", "kind", "says"),
    [
        (0, InputError, r"^speed: expected positive numbers, got \[0\.0, 0\.0\]$"),
        (np.nan, InputError, "speed: expected positive numbers"),
        (
            [[1, 2]],
            ShapeError,
            r"speed: expected one number, or one a coordinate \(2,\), got shape \(1, 2\)$",
        ),
        ([1, 2, 3], ShapeError, "speed: expected 2 coordinates"),
        ({"a": 1}, InputError, "speed: no value for 'b'"),
        ({"a": 1, "b": 1, "c": 1}, UnknownName, "speed: no coordinate 'c'"),
    ],
    ids=["zero", "NaN", "two axes", "three", "missing", "unknown"],
)
def test_what_is_no_such_number_is_refused(value, kind, says):
    with pytest.raises(kind, match=says):
        per_coordinate(value, ARM, "speed")
