"""Columns of conditions are told by their names, with the units that they may have."""

from __future__ import annotations

import re

import pytest

from poekin.errors import InputError
from poekin.solve.calibration.terms.condition_columns import condition_columns


@pytest.mark.parametrize(("word", "name", "factor"), [
    ("payload", "payload", 1.0), ("Payload [kg]", "payload", 1.0), ("payload (g)", "payload", 1e-3),
    ("temperature", "temperature", 1.0), ("temperature [K]", "temperature", 1.0),
    ("temperature[C]", "temperature", 1.0), ("temperature [°C]", "temperature", 1.0),
    ("time", "time", 1.0), ("time [s]", "time", 1.0), ("TIME [ms]", "time", 1e-3),
    ("time [ min ]", "time", 60.0), ("time [h]", "time", 3600.0),
])  # fmt: skip
def test_a_column_has_a_name_a_place_and_the_factor_of_its_unit(word, name, factor):
    assert condition_columns(["q1", "a b", word, "x"], (), "") == [(name, 2, word, factor)]
    assert condition_columns(["q1", word], {word}, "") == []


@pytest.mark.parametrize(("words", "message"), [
    (["payload [lb]"], "the column 'payload [lb]': expected 'kg' or 'g', got 'lb'"),
    (["time", "Time [s]"], "both 'time' and 'Time [s]': expected one"),
])  # fmt: skip
def test_another_unit_and_a_second_column_are_refused(words, message):
    with pytest.raises(InputError, match=f"^{re.escape(f'a.csv:1: {message}')}$"):
        condition_columns(words, (), "a.csv:1")
