"""Measures in words, with their units and the side on which they are better."""

from __future__ import annotations

import pytest

import poekin as pk
from poekin.sweep.measures.measure import Reach
from poekin.sweep.measures.names import LABELS

# what it is, a value of 0.0123 of SI with its unit, and whether larger is better
SAID = {
    "manipulability": ("manipulability", "0.0123", 1),
    "inverse_condition": ("inverse condition number", "0.0123", 1),
    "smallest_singular_value": ("smallest singular value", "0.0123", 1),
    "limit_margin": ("distance to the joint limits", "1.23 % of half the range", 1),
    "travel": ("joint travel", "0.0123 rad or m", -1),
    "travel_time": ("joint travel", "0.0123 s", -1),
    "solutions": ("number of IK solutions", "0.0123", 1),
    "position_error": ("standard deviation of the position", "12.3 mm", -1),
    "orientation_error": ("standard deviation of the orientation", "12.3 mrad", -1),
    "position_bound": ("worst-case error of the position", "12.3 mm", -1),
    "orientation_bound": ("worst-case error of the orientation", "12.3 mrad", -1),
}


@pytest.mark.parametrize("name", LABELS)
def test_a_measure_is_said_in_words_with_its_unit(name):
    label = LABELS[name]
    words, value, sign = SAID[name]
    assert (label.words, label.value(0.0123), label.sign) == (words, value, sign)
    # 0.01 of SI is one part in ten thousand off where the factor is one off
    number, space, unit = value.partition(" ")
    per_si = round(float(number) / 0.0123)
    assert label.value(1.234) == f"{per_si * 1.234:.4g}{space}{unit}"
    assert label.between(0.01, 1.234) == f"{per_si * 0.01:.4g} to {label.value(1.234)}"


def test_a_sweep_without_a_measure_has_no_numbers():
    arm = pk.load("ur5e").chain()
    assert Reach().numbers(arm).shape == (0,)
    # which, its sign, outputs behind the pose, rows of the Jacobian, room for a column
    assert Reach().whole_numbers(arm, -1).tolist() == [0, -1, 0, 6, 6]
