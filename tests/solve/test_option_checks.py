"""Checks of options: which values are whole numbers and words of a list, and what is said of others."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.solve.option_checks import is_real, is_whole, one_of, true_or_false, whole


@pytest.mark.parametrize("value", [1, np.int64(3), 2**70])
def test_whole_numbers_from_the_least_on_are_taken(value):
    assert is_whole(value, 1)
    assert whole(value, "n", 1) == value
    assert type(whole(value, "n", 1)) is int


@pytest.mark.parametrize("value", [0, -1, True, 1.0, "1", None])
def test_anything_else_is_refused_with_the_least(value):
    assert not is_whole(value, 1)
    with pytest.raises(InputError, match=f"^n: expected a whole number from 1 on, got {value!r}$"):
        whole(value, "n", 1)


def test_a_bound_is_refused_itself():
    assert whole(3, "n", 1, 4) == 3
    with pytest.raises(InputError, match=r"^n: expected a whole number from 1 on, got 4$"):
        whole(4, "n", 1, 4)


def test_real_numbers_and_truth_values_are_told_apart():
    for value in (1, 1.5, np.int64(2), np.float64(2.5)):
        assert is_real(value)
        with pytest.raises(InputError, match=r"^flag: expected True or False, got "):
            true_or_false(value, "flag")
    for value in (True, False):
        assert not is_real(value)
        true_or_false(value, "flag")
    true_or_false(np.bool_(False), "flag")
    assert not any(map(is_real, ("1", None, 1j)))


def test_a_word_is_one_of_those_that_are_known():
    one_of("b", ("a", "b"), "option")
    for value in ("c", None, ["a"]):
        with pytest.raises(InputError) as caught:
            one_of(value, ("a", "b"), "option")
        assert str(caught.value) == f"option: expected one of 'a', 'b', got {value!r}"
