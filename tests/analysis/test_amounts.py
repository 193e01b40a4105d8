"""Lengths and angles are shown in mm and degrees."""

from __future__ import annotations

import math

import pytest

from poekin.analysis.amounts import amount, joint_unit


@pytest.mark.parametrize(
    ("value", "unit", "digits", "text"),
    [
        (0.0032, "m", 4, "3.2 mm"),
        (0.00123456, "m", 4, "1.235 mm"),
        (0.00123456, "m", 2, "1.2 mm"),
        (math.pi / 6, "rad", 4, "30°"),
        (-math.radians(12.3456), "rad", 3, "-12.3°"),
    ],
)
def test_a_length_is_in_mm_and_an_angle_in_degrees(value, unit, digits, text):
    assert amount(value, unit, digits) == text
    assert amount(0.0012345678, "m") == "1.235 mm", "four digits unless said otherwise"


def test_what_slides_has_a_length_and_what_turns_an_angle():
    kinds = ("revolute", "prismatic", "helical")
    assert [joint_unit(kind) for kind in kinds] == ["rad", "m", "rad"]
