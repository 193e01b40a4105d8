"""What the commands print: numbers, tables, matrices and JSON to the character, and progress when
it is time for it.
"""

from __future__ import annotations

import io
import json
import sys

import numpy as np
import pytest

from poekin.cli import output
from tests.terminal import Terminal


@pytest.mark.parametrize(
    "value, digits, text",
    [(1 / 3, 6, "0.333333"), (1 / 3, 4, "0.3333"), (-0.0, 6, "0"), (1e-9, 9, "1e-09")],
)
def test_a_number_has_so_many_significant_digits_and_no_negative_zero(value, digits, text):
    assert output.number(value, digits) == text


def test_a_number_has_six_digits_where_nothing_is_said():
    assert output.number(np.pi) == "3.14159"


def test_a_path_is_whole_up_to_400_characters():
    assert output.path_text("a/b\x1b.csv") == r"'a/b\x1b.csv'"
    assert output.path_text("x" * 400) == f"'{'x' * 400}'"
    assert len(output.path_text("x" * 401)) <= 402


def test_line_breaks_stay_in_text_and_not_in_a_name():
    assert output.plain("a\nb\x1b\u202e") == "a\nb\\x1b\\u202e"
    assert output.name("a\nb\x1b") == "a\\nb\\x1b"


def test_words_of_a_table_are_left_and_numbers_right_and_markup_is_text(capsys):
    output.table(("joint", "kind", "m"), [("a", "x", 1.5), ("[b]\n", "yy", "22")])
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert [line.split() for line in lines] == [
        ["joint", "kind", "m"], [lines[1].strip()], ["a", "x", "1.5"], ["[b]\\n", "yy", "22"],
    ]  # fmt: skip
    starts = {
        line.index(word) for line, word in zip(lines, ("joint", "─", "a", "[b]"), strict=True)
    }
    assert starts == {0}
    ends = {line.index(word) + len(word) for line, word in zip(lines[2:], ("x", "yy"), strict=True)}
    assert len(ends) == 1  # right-aligned
    assert {len(line) for line in lines[2:]} == {len(lines[2])}
    output.table(("joint", "kind", "m"), [("a", "x", 1.5), ("b", "yy", "22")], left=2)
    lines = capsys.readouterr().out.splitlines()
    assert lines[2].index("x") == lines[3].index("yy") == lines[0].index("kind")


def test_a_table_is_as_wide_as_it_needs_where_nobody_looks(capsys):
    output.table(("long",), [("x" * 5000,)])
    assert "x" * 5000 in capsys.readouterr().out


def test_a_matrix_has_its_columns_below_each_other_with_nine_digits(capsys):
    values = np.array([[1.0, -0.0, 1 / 3], [-10.25, 2.0, 1e-12]])
    output.matrix(values)
    assert capsys.readouterr().out == "        1 0 0.333333333\n   -10.25 2       1e-12\n"
    output.matrix(values, ("wx", "v"), ("a", "b\n", "c"))
    assert capsys.readouterr().out == (
        "          a b\\n           c\n  wx      1   0 0.333333333\n  v  -10.25   2       1e-12\n"
    )


def test_json_has_null_for_what_is_no_finite_number_and_keeps_the_kinds_of_the_others():
    value = {
        1: np.array([[1.5, np.nan], [np.inf, -2.0]]),
        "b": (True, 3, "x", None),
        "c": [{"d": float("-inf")}],
    }
    assert json.loads(output.as_json(value)) == {
        "1": [[1.5, None], [None, -2.0]], "b": [True, 3, "x", None], "c": [{"d": None}],
    }  # fmt: skip


def test_a_complaint_takes_the_line_of_progress_on_a_terminal(monkeypatch):
    for stream, before in ((Terminal(), "\r\x1b[K"), (io.StringIO(), "")):
        monkeypatch.setattr(sys, "stderr", stream)
        output.complain("error: a\x1bb")
        assert stream.getvalue() == f"{before}poekin: error: a\\x1bb\n"
