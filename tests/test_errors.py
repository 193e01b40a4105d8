"""Messages: what they show of what arrived, and that no entrance answers with an error that is not
poekin's.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import (  # fmt: skip
    BranchError,
    FileError,
    InputError,
    MissingExtra,
    ModelError,
    PoekinError,
    PoseError,
    ShapeError,
    UnknownName,
    close_names,
    escape_unprintable,
    join_names,
    quote,
    safe_repr,
    show_numbers,
    suggest,
)


@given(st.integers(1, 100), st.integers(0, 3))
def test_text_is_cut_exactly_where_it_is_longer_than_its_width(width, more):
    assert escape_unprintable("x" * width, width) == "x" * width
    assert escape_unprintable("x" * (width + 1 + more), width) == "x" * (width - 1) + "…"


@given(st.text(), st.integers(2, 100))
def test_nothing_that_a_terminal_obeys_is_shown(text, width):
    for plain in (escape_unprintable(text), quote(text), safe_repr(text), safe_repr([text])):
        assert plain.isprintable()
    assert len(escape_unprintable(text, width)) <= width


@pytest.mark.parametrize(
    "name, plain",
    [
        ("a", "'a'"),
        ("\u202ea", r"'\u202ea'"),
        ("a\nb", r"'a\nb'"),
        ("it's", "'it's'"),
        ("a\\b", r"'a\b'"),
        (7, "'7'"),
    ],
)
def test_each_character_is_escaped_once_or_not_at_all(name, plain):
    assert quote(name) == plain


@pytest.mark.parametrize(
    "row, text",
    [
        ([], "[]"),
        ([0.0, -0.0], "[0.0, 0.0]"),
        ([2.7e-49], "[2.7e-49]"),
        ([2.7e-49, 1.0, -1e-12], "[0.0, 1.0, 0.0]"),
        ([1.01e-12, 1.0], "[1.01e-12, 1.0]"),
        (np.array([1 / 3, -20.0]), "[0.333333, -20.0]"),
        ([float("nan"), float("inf"), 1e-9], "[nan, inf, 1e-09]"),
    ],
)
def test_numbers_are_shown_to_six_digits_and_rounding_as_0(row, text):
    assert show_numbers(row) == text


def test_line_breaks_are_kept_where_that_is_asked():
    assert escape_unprintable("a\n\x1bb", keep="\n") == "a\n\\x1bb"


@pytest.mark.parametrize(
    "value, plain", [("", "''"), (None, "None"), (5, "5"), ("\u202e", r"'\u202e'")]
)
def test_what_arrived_is_told_as_python_writes_it(value, plain):
    assert safe_repr(value) == plain
    assert len(safe_repr([value] * 1000)) == 80


def test_a_long_list_ends_with_how_many_more_there_are():
    assert join_names("abc") == "'a', 'b', 'c'"
    assert join_names("abc", 2) == "'a', 'b' and 1 more"
    assert join_names("abcdefg", 2) == "'a', 'b' and 5 more"
    assert join_names(()) == ""
    assert suggest("x", "abcdefgh") == "available: 'a', 'b', 'c', 'd', 'e' and 3 more"


@pytest.mark.parametrize("length", [79, 80, 81])
def test_what_is_too_long_is_cut_at_eighty_characters(length):
    text = "x" * min(length, 80) if length <= 80 else "x" * 79 + "…"
    assert quote("x" * length) == f"'{text}'"
    assert escape_unprintable("x" * length, 80) == text
    assert safe_repr(["x"] * 100) == repr(["x"] * 100)[:79] + "…"
    assert escape_unprintable("x" * length) == "x" * length


def test_a_dozen_names_are_listed_and_five_offered():
    assert join_names(range(12)) == ", ".join(f"'{i}'" for i in range(12))
    assert join_names(range(13)) == ", ".join(f"'{i}'" for i in range(12)) + " and 1 more"
    near = [f"joint{i}" for i in range(6)]
    assert suggest("joint", near).count("'joint") == 5
    assert suggest("joint", near, 2).count("'joint") == 2
    assert len(close_names("joint", near)) == 5
    assert suggest("joint", []) == "there are none"
    assert suggest("", ["a"]) == "available: 'a'"


def test_a_name_is_found_whatever_its_case():
    assert suggest("UR5", ["ur3", "ur5", "ur5e"]) == "did you mean 'ur5'?"
    assert suggest("ur-5", ["ur3", "UR5", "ur5e"]) == "did you mean 'UR5' or 'ur5e'?"
    assert close_names("TOOL", ["tool", "Tool", "tool0"]) == ["tool", "Tool"]
    assert close_names("x", ["ur5"]) == []


@pytest.mark.parametrize(
    "name, meant", [("abcdefghij", False), ("abcdefghxx", True), ("abcdexxxxx", False)]
)
def test_a_name_is_meant_where_three_fifths_of_it_are_there(name, meant):
    # of two names of ten characters, 2 × 8 ÷ 20 = 0.8 are there in the second case, 0.5 in the
    # third
    found = suggest(name, ["abcdefghyy" if name != "abcdefghij" else "klmnopqrst"])
    assert found.startswith("did you mean" if meant else "available: ")


@pytest.mark.parametrize(
    "error, also",
    [
        (InputError("x"), ValueError), (ShapeError("x"), ValueError), (PoseError("x"), ValueError),
        (BranchError("x"), ValueError), (ModelError("x"), ValueError), (UnknownName("x"), KeyError),
        (FileError("x"), OSError), (MissingExtra("a", "b", "c"), ImportError),
    ],
)  # fmt: skip
def test_an_error_of_poekin_s_is_also_the_one_that_python_s_users_expect(error, also):
    assert isinstance(error, PoekinError)
    assert isinstance(error, also)
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again)) == (type(error), str(error))
    assert not isinstance(PoekinError("x"), (ValueError, KeyError, OSError, ImportError))


def test_what_an_error_says_is_what_it_was_given():
    assert str(UnknownName("no link 'a'")) == "no link 'a'"
    assert str(UnknownName()) == ""
    assert str(UnknownName("what", "more")) == "what"
    missing = MissingExtra("mujoco", "mjcf", "reading MJCF")
    assert str(missing) == "reading MJCF needs the package mujoco: pip install 'poekin[mjcf]'"
    assert (missing.package, missing.extra, missing.purpose) == ("mujoco", "mjcf", "reading MJCF")


def test_of_long_names_only_the_first_are_looked_at():
    assert suggest("x" * 1000, ["y" * 1000, "x" * 1000]).startswith(
        "did you mean"
    )  # the second of two
    assert suggest("x" * 1000, ["y" * 1000] * 2 + ["x" * 1000]).startswith("available: ")
    names = ["x" * 190 + str(i) for i in range(1000)]
    assert suggest(names[0] + "y", names).startswith("did you mean")
    assert suggest(names[-1], names).startswith("did you mean")
    assert suggest("y" * 190 + "999", [*names, "y" * 190 + "998"]).startswith("available: ")
    assert suggest("joint_x", [f"joint_{i}" for i in range(20_000)]).startswith(
        "did you mean 'joint_"
    )


ARM = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [i, 0, 0]) for i in range(2)], np.eye(4))


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: pk.count("panda"), "expected a Chain, .* got 'panda'"),  # pyright: ignore[reportArgumentType]
        (lambda: pk.count(ARM, method=[]), r"no method \[\]; there are: direct"),  # pyright: ignore[reportArgumentType]
        (lambda: pk.count(ARM, frame={}), r"no method 'recursive' in frame \{\}"),  # pyright: ignore[reportArgumentType]
    ],
)
def test_a_count_of_what_is_no_chain_or_method_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()
