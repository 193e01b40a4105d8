"""Statements of coupled readings are linear sums of names, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import InputError, quote
from poekin.model.readings.statements import (
    LONGEST,
    MOST,
    canonical,
    make_statements,
    parse_statements,
    statements_by_joint,
)

FORM = "; a statement is a joint as a sum of readings, as in 'J3 = J2 + J3'"
THERE = "; available: 'J1', 'J2', 'J3', 'J10', 'left arm' and 2 more"
SINGULAR = "different readings give the same values of the joints, the matrix is singular"
NAMES = ("J1", "J2", "J3", "J10", "left arm", "a-b", "it's")


def row(statement: str, k: int = 2) -> dict[str, float]:
    K = parse_statements(statement, NAMES)
    others = np.delete(K, k, axis=0)
    np.testing.assert_array_equal(others, np.delete(np.eye(len(NAMES)), k, axis=0))
    return {NAMES[j]: float(K[k, j]) for j in np.flatnonzero(K[k])}


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("J3 = J2 + J3", {"J2": 1, "J3": 1}),
        ("J3=J3-J2", {"J2": -1, "J3": 1}),
        (" J3 = - J2+J3 ", {"J2": -1, "J3": 1}),
        ("J3 = +J3 + 0.5 J2", {"J2": 0.5, "J3": 1}),
        ("J3 = J3 - 1/80 J10", {"J3": 1, "J10": -1 / 80}),
        ("J3 = 2J3 + 1e-2*J1 + .25 * J2", {"J1": 0.01, "J2": 0.25, "J3": 2}),
        ("J3 = J3 + J2 + J2 - 3. J1", {"J1": -3, "J2": 2, "J3": 1}),
        ("J3 = 'left arm' + J3", {"left arm": 1, "J3": 1}),
        ('"J3" = left arm + J3', {"left arm": 1, "J3": 1}),
        ("J3 = J3 + a-b - 2 it's", {"J3": 1, "a-b": 1, "it's": -2}),
        ("q3 = q2 + J3", {"J2": 1, "J3": 1}),
        ("J3 = J3 + J4", {"J3": 1, "J10": 1}),
    ],
)
def test_names_numbers_fractions_and_signs_are_understood(statement, expected):
    assert row(statement) == expected


def test_the_longest_name_that_fits_is_meant():
    names = ["left", "left arm", "b", "b-c", "c"]
    K = parse_statements(["left = left + left arm", "c = c - b-c"], names)
    expected = np.eye(5)
    expected[0, 1] = 1
    expected[4, 3] = -1
    np.testing.assert_array_equal(K, expected)


def test_a_name_of_the_robot_comes_before_its_number():
    assert parse_statements("J1 = J1 + J2", ["J2", "J1"]).tolist() == [[1, 0], [1, 1]]


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("J3", f"'J3': expected '=' after the name of a joint, got nothing{FORM}"),
        ("J3 J2", f"'J3 J2': expected '=' after the name of a joint, got 'J2'{FORM}"),
        ("foo", f"'foo': expected the name of a joint, got 'foo'{THERE}{FORM}"),
        ("", f"'': expected the name of a joint, got nothing{THERE}{FORM}"),
        ("= J2", f"'= J2': expected the name of a joint, got '='{THERE}"),
        ("J33 = J2", "'J33 = J2': expected the name of a joint, got 'J33'; did you mean 'J3'?"),
        ("J3 =", f"'J3 =': expected the name of a reading, got nothing{THERE}"),
        ("J3 = J2 + 3", f"'J3 = J2 + 3': expected the name of a reading, got nothing{THERE}"),
        ("J3 = (J2)", f"'J3 = (J2)': expected the name of a reading, got '('{THERE}"),
        ("J3 = J2 * J3", "'J3 = J2 * J3': expected '+' or '-' between readings, got '*'"),
        ("J3 = J2|", "'J3 = J2|': expected '+' or '-' between readings, got '|'"),
        ("J3 = J2 J3", "'J3 = J2 J3': expected '+' or '-' between readings, got 'J3'"),
        ("J3 = J3 + -J2", f"'J3 = J3 + -J2': expected the name of a reading, got '-'{THERE}"),
        ("J3 = 1/0 J2", "'J3 = 1/0 J2': expected a number other than 0 after '/', got 'J2'"),
        ("J3 = 1/J2", "'J3 = 1/J2': expected a number other than 0 after '/', got 'J2'"),
        ("J3 = 'lef'", f"'J3 = 'lef'': expected the name of a reading, got ''lef''{THERE}"),
        ("J3 = J3 + 1e999 J2", "'J3 = J3 + 1e999 J2' has numbers that are not finite"),
        ("J3 = J2", f"'J3 = J2': {SINGULAR}"),
        ("J3 = 1e10 J3", f"'J3 = 1e10 J3': {SINGULAR}"),
        (["J3 = J2 + J3", "q3 = J3"], "'J3' is said twice"),
        ([3], "expected a text, got 3"),
        (3, "expected statements such as 'J3 = J2 + J3', got 3"),
        ({"J3": "J2"}, "expected statements such as 'J3 = J2 + J3', got {'J3': 'J2'}"),
        ("J3 = " + "J" * LONGEST, f"expected at most {LONGEST} characters, got {LONGEST + 5}"),
    ],
)  # fmt: skip
def test_all_else_is_refused_with_what_was_expected(statement, message):
    with pytest.raises(InputError) as caught:
        parse_statements(statement, NAMES)
    assert str(caught.value) == f"coupling: {message}"


def test_of_a_long_word_that_was_not_expected_forty_characters_are_shown():
    word = "abcdefghij" * 6
    with pytest.raises(InputError) as caught:
        parse_statements(f"J3 {word}", NAMES)
    assert f"got {quote(word, 40)};" in str(caught.value)
    assert quote(word, 40) != quote(word, 41)


def test_what_is_singular_does_not_depend_on_the_unit():
    np.testing.assert_array_equal(parse_statements("J1 = 1e-10 J1", ["J1"]), [[1e-10]])


def test_a_name_ends_where_its_own_last_character_says():
    names = ("a-", "b", "c_")
    with pytest.raises(InputError, match="expected '\\+' or '-' between readings, got 'b'"):
        parse_statements("a- = a-b", names)
    with pytest.raises(InputError, match="got 'c_b'; did you mean 'c_'"):
        parse_statements("a- = c_b", names)


def test_a_robot_of_more_than_a_thousand_coordinates_is_refused():
    with pytest.raises(InputError) as caught:
        parse_statements("J3 = J2 + J3", [f"j{k}" for k in range(MOST + 1)])
    assert str(caught.value) == "coupling: expected at most 1000 coordinates, got 1001"
    assert statements_by_joint((), ["a"] * (MOST + 1)) == [""] * (MOST + 1)


@given(
    st.lists(
        st.lists(st.floats(-4, 4).map(lambda x: round(x, 3)), min_size=7, max_size=7),
        min_size=7,
        max_size=7,
    )
)
def test_what_is_written_reads_back_as_the_same_matrix(rows):
    K = np.array(rows) + 10 * np.eye(7) + 0.0
    statements = make_statements(K, NAMES)
    if statements:
        np.testing.assert_array_equal(parse_statements(statements, NAMES), K)
        assert canonical(statements, NAMES) == statements


def test_statements_are_as_people_write_them():
    said = ["J3 = J3 - J2", "'left arm' = 1*left arm + 0.5 a-b"]
    assert canonical(said, NAMES) == ("J3 = -J2 + J3", "'left arm' = 'left arm' + 0.5 'a-b'")
    assert canonical(["J3 = J3"], NAMES) == ()
    assert make_statements(None, NAMES) == ()
    assert canonical("\"it's\" = it's + J1", NAMES) == ('"it\'s" = J1 + "it\'s"',)


def test_a_name_with_quotes_of_both_kinds_cannot_be_written():
    name = "a'b\"c"
    K = parse_statements(f"J1 = J1 + {name}", ["J1", name])
    with pytest.raises(InputError) as caught:
        make_statements(K, ["J1", name])
    said = f"coupling: {quote(name)} has quotes of both kinds and cannot be written"
    assert str(caught.value) == said
