"""CSV of numbers: columns in the order of the names, and every refusal with its file, line and
column.
"""

from __future__ import annotations

import io

import numpy as np
import pytest

from poekin.errors import FileError, InputError, UnknownName
from poekin.formats.text import csv_rows

NAMES = ("a", "b", "c")


def read(text: str, **more) -> tuple[list, list]:
    options = {key: more.pop(key) for key in ("progress", "size") if key in more}
    columns = csv_rows.Columns(NAMES, "coordinate", **more)
    rows, lines = csv_rows.read(io.StringIO(text), columns, "f.csv", **options)
    return rows.tolist(), lines.tolist()


def test_rows_come_in_the_order_of_the_names_with_their_lines():
    assert read("1,2,3\n\n4,5,6\n") == ([[1, 2, 3], [4, 5, 6]], [1, 3])
    assert read("\n c, a ,b\n3,1,2\n") == ([[1, 2, 3]], [3])
    assert read("t,b,c,a\n9,2,3,1\n", besides=("t",)) == ([[1, 2, 3]], [2])
    assert read("a,b,c\n") == ([], [])


REFUSED = {
    "empty": ("\n \n", InputError, "f.csv: rows of numbers expected, the file is empty"),
    "too few": ("1,2,3\n1,2\n", InputError, "f.csv:2: 3 values expected (a, b, c), got 2"),
    "too few by the header": ("t,a,b,c\n1,2,3\n", InputError, "f.csv:2: 4 values expected, as the header has, got 3"),
    "no number": ("1,2,3\n\n4,x,6\n", InputError, "f.csv:3, column 2: a number expected, got 'x'"),
    "no number in a column of the file": ("t,c,b,a\n0,3,x,1\n", InputError,
                                          "f.csv:2, column 3: a number expected, got 'x'"),
    "unknown": ("a,b,cc\n", UnknownName, "f.csv:1: 'cc' is neither a number nor a coordinate; did you mean 'c'?"),
    "missing": ("a,b\n", InputError, "f.csv:1: the header has to name each of the 3 coordinates once; 'c' is missing"),
    "twice": ("a,b,c,b\n", InputError,
              "f.csv:1: the header has to name each of the 3 coordinates once; a name appears twice"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_line_that_is_refused_is_named_with_what_was_expected_and_what_arrived(case):
    text, kind, message = REFUSED[case]
    with pytest.raises(kind) as caught:
        read(text, besides=("t",))
    assert str(caught.value) == message


def test_a_file_of_chosen_columns_has_a_first_line():
    choose = lambda words, where: [words.index("b"), words.index("a")]  # noqa: E731
    rows, lines = csv_rows.read_chosen(io.StringIO("\na,name,b\n1,x,2\n"), choose, "f.csv")
    assert (rows.tolist(), lines.tolist()) == ([[2, 1]], [3])
    with pytest.raises(
        InputError,
        match=r"^f\.csv: a first line that names the columns expected, the file is empty$",
    ):
        csv_rows.read_chosen(io.StringIO(""), choose, "f.csv")
    with pytest.raises(
        InputError, match=r"^f\.csv:2: 3 values expected, as the header has, got 1$"
    ):
        csv_rows.read_chosen(io.StringIO("a,name,b\n1\n"), choose, "f.csv")


@pytest.mark.parametrize(
    "content, message",
    [
        (b"1,2\n\xff", "is no text file: byte 4 is not UTF-8"),
        (None, r"^cannot read .*none\.csv: No such file or directory$"),
    ],
)
def test_a_file_that_cannot_be_read_is_named(content, message, tmp_path):
    path = tmp_path / ("none.csv" if content is None else "f.csv")
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(FileError, match=message) as caught, csv_rows.opened(path) as (stream, _, _):
        stream.read()
    assert str(path) in str(caught.value)


def test_an_error_while_a_file_is_open_passes_through(tmp_path):
    path = tmp_path / "f.csv"
    path.write_text("1\n")
    mine = InputError("mine")
    with pytest.raises(InputError) as caught, csv_rows.opened(path) as (_, where, size):
        _raise(mine if (where, size) == (str(path), 2) else InputError("another file"))
    assert caught.value is mine


def _raise(error: Exception) -> None:
    raise error


def test_many_rows_are_read_and_written_in_parts_and_each_part_is_told(monkeypatch):
    monkeypatch.setattr(csv_rows, "AT_ONCE", 2)
    numbers = np.arange(15.0).reshape(5, 3) / 7
    told: list[tuple[int, int]] = []
    text = csv_rows.text(NAMES, numbers, lambda done, size: told.append((done, size)))
    assert told == [(0, 5), (2, 5), (4, 5)]
    told.clear()
    rows, lines = read(text, progress=lambda done, size: told.append((done, size)), size=len(text))
    assert (rows, lines) == (numbers.tolist(), [2, 3, 4, 5, 6])
    ends = np.cumsum([len(line) for line in text.splitlines(keepends=True)])
    assert told == [
        (ends[2] - ends[0], len(text)),
        (ends[4] - ends[0], len(text)),
    ]  # the characters of the rows


@pytest.mark.parametrize("length", [400, 401])
def test_of_a_path_messages_have_at_most_400_characters(length, tmp_path):
    folder = tmp_path / ("d" * (200 - len(str(tmp_path)))) / ("e" * 150)
    path = f"{folder}/{'f' * (length - len(str(folder)) - 1)}"
    with pytest.raises(FileError) as refused, csv_rows.opened(path):
        pass
    assert len(path) == length
    assert (path in str(refused.value)) == (length == 400)


def test_a_name_in_the_header_obeys_no_terminal_and_breaks_no_line():
    assert (
        csv_rows.text(["a\nb", "\x1b[31m", "c,d"], np.ones((1, 3)))
        == 'a\\nb,\\x1b[31m,"c,d"\n1.0,1.0,1.0\n'
    )
