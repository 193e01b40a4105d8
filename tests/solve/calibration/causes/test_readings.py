"""Readings taken otherwise are the columns that the words say."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.causes.readings import other_readings, other_zeros, short_names

ARM = pk.Chain.from_space(
    [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.prismatic([1, 0, 0]),
        pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5]),
    ],
    np.eye(4),
    q_names=["a", "s", "b"],
)
Q = np.array([[0.1, 2.0, 30.0], [0.4, 5.0, 60.0]])
A, S, B = Q.T


def test_angles_follow_one_another_coordinates_are_reversed_or_exchanged():
    found = list(other_readings(ARM, Q))
    expected = {
        "the readings coupled, 'a = a + b'": [A + B, S, B],
        "the readings coupled, 'a = a - b'": [A - B, S, B],
        "the readings coupled, 'b = b + a'": [A, S, B + A],
        "the readings coupled, 'b = b - a'": [A, S, B - A],
        "a reversed": [-A, S, B],
        "s reversed": [A, -S, B],
        "b reversed": [A, S, -B],
        "a and s exchanged": [S, A, B],
        "a and b exchanged": [B, S, A],
        "s and b exchanged": [A, B, S],
    }
    assert [words for words, _ in found] == list(expected)
    for words, q in found:
        np.testing.assert_array_equal(q, np.column_stack(expected[words]))


def test_quarters_and_half_a_turn_are_added_to_angles_alone():
    found = {words: q - Q for words, q in other_zeros(ARM, Q)}
    assert list(found) == [f"{turn}° added to {name}" for name in "ab" for turn in (90, -90, 180)]
    for words, change in found.items():
        column = 0 if words.endswith("a") else 2
        expected = np.zeros((2, 3))
        expected[:, column] = np.pi / 180 * float(words.partition("°")[0])
        assert change == pytest.approx(expected, abs=1e-14)  # rounding of 60


def test_names_of_more_than_forty_characters_are_shortened():
    names = [40 * "x", 41 * "x", "s"]
    first, second, last = short_names(ARM.replace(q_names=names))
    assert (first, last) == (names[0], "s")
    assert len(second) <= 40
