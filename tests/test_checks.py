"""Checks of arguments: which values are numbers and words of a list, and what is said of others."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.checks import (
    KERNEL_INT,
    REQUIRED,
    alternatives,
    choice,
    is_real,
    is_whole,
    positive,
    true_or_false,
    whole,
)
from poekin.errors import InputError


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


def test_a_float_is_no_whole_number_whatever_its_value():
    assert not is_whole(2.0, 1)
    assert not is_whole(np.float64(2), 1)


def test_a_bound_is_refused_itself():
    assert whole(3, "n", 1, 4) == 3
    for value in (4, 5):
        with pytest.raises(
            InputError, match=f"^n: expected a whole number from 1 on, got {value}$"
        ):
            whole(value, "n", 1, 4)


def test_the_kernels_can_add_two_numbers_below_their_bound_and_no_larger_ones():
    largest = np.iinfo(np.int64).max
    assert 2 * (KERNEL_INT - 1) <= largest < 2 * KERNEL_INT


def test_real_numbers_and_truth_values_are_told_apart():
    for value in (1, 1.5, np.int64(2), np.float64(2.5)):
        assert is_real(value)
        with pytest.raises(InputError, match=r"^flag: expected True or False, got ") as caught:
            true_or_false(value, "flag")
        assert str(caught.value).endswith(f"got {value!r}")
    for value in (True, False):
        assert not is_real(value)
        true_or_false(value, "flag")
    true_or_false(np.bool_(False), "flag")
    assert not any(map(is_real, ("1", None, 1j, np.complex128(1))))


@pytest.mark.parametrize("value", [1, 0.5, np.float32(2), np.int64(3), 5e-324, 1e308])
def test_positive_numbers_become_floats(value):
    assert positive(value, "tol") == value
    assert type(positive(value, "tol")) is float


@pytest.mark.parametrize("value", [0, -1.0, True, np.inf, np.nan, "1", None, 1j, np.complex128(1)])
def test_what_is_no_positive_finite_number_is_refused(value):
    with pytest.raises(InputError, match=r"^tol: expected a positive number, got ") as caught:
        positive(value, "tol")
    assert str(caught.value).endswith(repr(value))


def test_words_are_listed_as_people_list_them():
    assert alternatives(["a"]) == "'a'"
    assert alternatives(iter("ab")) == "'a' or 'b'"
    assert alternatives({"a": 1, "b": 2, "c": 3}) == "'a', 'b' or 'c'"


def test_a_hint_ends_the_message_of_a_word_that_was_left_out():
    with pytest.raises(InputError, match=r"^option: expected 'a' or 'b', it was left out; it may$"):
        choice(REQUIRED, ("a", "b"), "option", "; it may")


def test_a_word_is_one_of_those_that_are_known():
    choice("b", ("a", "b"), "option")
    for value in ("c", None, ["a"], np.array(["a", "b"])):
        with pytest.raises(InputError) as caught:
            choice(value, ("a", "b"), "option")
        assert str(caught.value) == f"option: expected 'a' or 'b', got {value!r}"
