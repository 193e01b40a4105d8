"""Messages: what they show of what arrived, and that no entrance answers with an error that is not poekin's."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, closest, harmless, listed, shown, told


@given(st.text(), st.integers(2, 100))
def test_nothing_that_a_terminal_obeys_is_shown(text, width):
    for plain in (harmless(text), shown(text), told(text), told([text])):
        assert plain.isprintable()
    assert len(harmless(text, width)) <= width


@pytest.mark.parametrize(
    "name, plain",
    [("a", "'a'"), ("\u202ea", r"'\u202ea'"), ("a\nb", r"'a\nb'"), ("it's", "'it's'"), ("a\\b", r"'a\b'"), (7, "'7'")],
)
def test_each_character_is_escaped_once_or_not_at_all(name, plain):
    assert shown(name) == plain


def test_line_breaks_are_kept_where_that_is_asked():
    assert harmless("a\n\x1bb", keep="\n") == "a\n\\x1bb"


@pytest.mark.parametrize("value, plain", [("", "''"), (None, "None"), (5, "5"), ("\u202e", r"'\u202e'")])
def test_what_arrived_is_told_as_python_writes_it(value, plain):
    assert told(value) == plain
    assert len(told([value] * 1000)) == 80


def test_a_long_list_ends_with_how_many_more_there_are():
    assert listed("abc") == "'a', 'b', 'c'"
    assert listed("abc", 2) == "'a', 'b' and 1 more"
    assert listed(()) == ""
    assert closest("x", "abcdefgh") == "available: 'a', 'b', 'c', 'd', 'e' and 3 more"


def test_of_long_names_only_the_first_are_looked_at():
    names = ["x" * 190 + str(i) for i in range(1000)]
    assert closest(names[0] + "y", names).startswith("did you mean")
    assert closest(names[-1], names).startswith("did you mean")
    assert closest("y" * 190 + "999", [*names, "y" * 190 + "998"]).startswith("available: ")
    assert closest("joint_x", [f"joint_{i}" for i in range(20_000)]).startswith("did you mean 'joint_")


ARM = pk.Chain([pk.screw.revolute([0, 0, 1], [i, 0, 0]) for i in range(2)], np.eye(4))


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
