"""Numbers in text: what is one, what is said of what is none, and the shortest form."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import InputError
from poekin.formats.text.numbers import expected, real, shortest


@pytest.mark.parametrize("text", ["", " ", "x", "1_0", "1_", "١", "1,5", "1 2", "0x10"])
def test_what_is_no_number_is_none_and_is_said_with_its_place(text):
    assert real(text) is None
    with pytest.raises(InputError, match=rf"^--q: a number expected, got '{re.escape(text)}'$"):
        expected(text, "--q")


@pytest.mark.parametrize(
    ("text", "number"), [("1", 1.0), (" -2.5e3\n", -2500.0), ("inf", math.inf), ("+.5", 0.5)]
)
def test_a_number_may_have_blanks_around_it(text, number):
    assert real(text) == expected(text, "--q") == number


def test_not_a_number_is_one_too():
    assert math.isnan(expected("nan", "--q"))


@given(st.lists(st.floats(allow_nan=False)))
def test_the_shortest_form_reads_back_as_the_same_numbers(values):
    words = shortest(values).split()
    assert list(map(float, words)) == values
    for word, value in zip(words, values, strict=True):
        assert word == (
            repr(int(value)) if value.is_integer() and abs(value) < 1e16 else repr(value)
        )
