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
    output.table(("joint", "kind", "m"), [("a", "x", 1.5), ("[b]\n", "yy", "22")], left=1)
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


class Terminal(io.StringIO):
    seen = ""

    def isatty(self) -> bool:
        return True

    def flush(self) -> None:
        self.seen = self.getvalue()


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands until it is set."""
    now = [100.0]
    monkeypatch.setattr(output.time, "monotonic", lambda: now[0])
    return now


def test_progress_in_a_file_is_a_line_when_its_pause_is_over(clock, monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with output.Progress("reading") as progress:
        for time, done in ((109.9, 1), (110.0, 2), (119.9, 3), (120.1, 4)):
            clock[0] = time
            progress(done, 0 if done == 4 else 7, "x\n" if done == 2 else "")
    assert sys.stderr.getvalue() == "reading: 2 of 7, x\\n\nreading: 4\n"  # type: ignore[attr-defined]


def test_progress_on_a_terminal_is_one_line_that_goes_away(clock, monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    with output.Progress("reading") as progress:
        for time, done in ((100.4, 1), (100.5, 2), (100.59, 3), (100.61, 4)):
            clock[0] = time
            progress(done, 7)
            assert sys.stderr.seen == sys.stderr.getvalue()  # type: ignore[attr-defined]  a line without an end
    assert sys.stderr.seen == sys.stderr.getvalue()  # type: ignore[attr-defined]
    clear = "\r\x1b[K"
    assert sys.stderr.getvalue() == f"{clear}reading: 2 of 7{clear}reading: 4 of 7{clear}"  # type: ignore[attr-defined]


def test_short_work_shows_nothing(clock, monkeypatch):
    for stream in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", stream)
        with output.Progress("reading") as progress:
            progress(1, 2)
        assert stream.getvalue() == ""


def test_a_line_of_progress_is_cut_on_a_terminal_alone(clock, monkeypatch):
    for stream, length in ((Terminal(), 100), (io.StringIO(), 209)):
        monkeypatch.setattr(sys, "stderr", stream)
        progress = output.Progress("x" * 200)
        clock[0] += 20
        progress(1, 10)
        assert len(stream.getvalue().removeprefix("\r\x1b[K").rstrip("\n")) == length


def test_a_complaint_takes_the_line_of_progress_on_a_terminal(monkeypatch):
    for stream, before in ((Terminal(), "\r\x1b[K"), (io.StringIO(), "")):
        monkeypatch.setattr(sys, "stderr", stream)
        output.complain("error: a\x1bb")
        assert stream.getvalue() == f"{before}poekin: error: a\\x1bb\n"
