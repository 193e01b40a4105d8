"""Separators, decimal commas, empty cells and first lines of CSV files as programs write them."""

from __future__ import annotations

import io

import numpy as np
import pytest

from poekin.errors import FileError, InputError, PoekinWarning
from poekin.formats.text import csv_dialect, csv_rows

NAMES = ("x", "y", "z")


def read(text, names=NAMES):
    columns = csv_rows.Columns(names, "column")
    return csv_rows.read(io.StringIO(text, newline=""), columns, "f.csv")[0].tolist()


SAME = {
    "comma": "1.5,-2,3e-1\n4,5,6\n",
    "comma and blanks": "1.5, -2 , 3e-1\n4,5,6\n",
    "semicolon": "1.5;-2;3e-1\n4;5;6\n",
    "semicolon and decimal commas": "1,5;-2;3e-1\n4;5,0;6\n",
    "semicolon and a comma alone": "1,5;-2,;,3\n4;5;6\n",
    "tab": "1.5\t-2\t0.3\n4\t5\t6\n",
    "tab and decimal commas": "1,5\t-2\t3,0e-1\n4\t5\t6\n",
    "comma and tab": "1.5,\t-2,\t.3\n4,\t5,\t6\n",
    "tab and comma": "1.5\t,-2\t,.3\n4\t,5\t,6\n",
    "blanks": "1.5 -2   0.3\n  4 5 6\n",
    "said": "sep=;\n1,5;-2;0,3\n4;5;6\n",
    "said as a comma": "SEP=,\r\n1.5,-2,0.3\r\n4,5,6\r\n",
    "said as a tab": "\n\nsep=\t\n1,5\t-2\t0,3\n4\t5\t6\n",
    "a separator at the end": "1.5,-2,.3,\n4,5,6,\n",
    "separators at the end of the first line": "1.5;-2;.3;;\n4;5;6\n",
    "separators at the end of a later line": "1.5;-2;.3\n4;5;6;;;\n;;;\n",
    "carriage returns": "1.5;-2;0.3\r\n4;5;6\r\n",
    "quoted": '"1,5";-2;0.3\n4;5;6\n',
    "header": "z;x;y\n,3;1,5;-2\n6;4;5\n",
    "header in blanks": "z x y\n.3 1.5 -2\n6 4 5\n",
    "header in tabs with blanks in it": "Z \t x\ty \n.3\t1.5\t-2\n6\t4\t5\n",
}


@pytest.mark.parametrize("case", SAME)
def test_what_has_one_reading_is_read(case):
    assert read(SAME[case]) == [[1.5, -2, 0.3], [4, 5, 6]]


REFUSED = {
    "decimal commas with commas": ("1,1,2,2,3,3\n", InputError,
        "f.csv:1: 3 values expected (x, y, z), got 6; with decimal commas, write ; between the columns"),
    "twice as many that are no halves": ("1.0,1,2,2,3,3\n", InputError,
        "f.csv:1: 3 values expected (x, y, z), got 6"),
    "thousands": ("1;2;3\n1.234,5;2;3\n", InputError,
        "f.csv:2, column 1: '1.234,5' has a comma and is no number with a decimal comma;"
        " write numbers without separators of thousands"),
    "two commas": ("1;2,3,4;3\n", InputError,
        "f.csv:1, column 2: '2,3,4' has a comma and is no number with a decimal comma;"
        " write numbers without separators of thousands"),
    "thousands by blanks": ("1 234,5;2;3\n", InputError,
        "f.csv:1, column 1: '1 234,5' has a comma and is no number with a decimal comma;"
        " write numbers without separators of thousands"),
    "another separator later": ("1,2,3\n1;2;3\n", InputError, "f.csv:2: 3 values expected (x, y, z), got 1"),
    "a quote that is left open": ('\n1;2;"3\n4;5;6\n', FileError, "f.csv:3: not CSV: unexpected end of data"),
    "a quote in the middle": ('1,2,"3"4\n', FileError, """f.csv:1: not CSV: ',' expected after '"'"""),
    "an empty cell": ("1,,3\n", InputError, "f.csv:1, column 2: a number expected, got ''"),
    "the last one is empty": ("1,2,3\n4,5,\n", InputError, "f.csv:2, column 3: a number expected, got ''"),
    "the last ones are empty": ("x;y;z\n4;;;\n", InputError, "f.csv:2, column 2: a number expected, got ''"),
    "one of three and an empty one": ("1,2,3\n4,\n", InputError, "f.csv:2: 3 values expected (x, y, z), got 2"),
    "one too many": ("1,2,3\n4,5,6, ,7\n", InputError, "f.csv:2: 3 values expected (x, y, z), got 5"),
    "too few at the end": ("1,2,\n", InputError, "f.csv:1: 3 values expected (x, y, z), got 2"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_has_none_or_two_is_refused_with_the_line_and_the_cure(case):
    text, kind, message = REFUSED[case]
    with pytest.raises(kind) as caught:
        read(text)
    assert str(caught.value) == message


def test_commas_that_could_all_be_of_thousands_are_read_as_decimals_and_told():
    with pytest.warns(PoekinWarning) as told:
        assert read("100,250;-2,125;3\n") == [[100.25, -2.125, 3]]
    assert [str(w.message) for w in told] == [
        "f.csv: every comma is before three digits; read as decimal commas (1,234 is 1.234)"
    ]
    assert told[0].filename == __file__
    # one that can be nothing else settles it
    for text in ("100,250;0,125;3\n", "100,250;2,1254;3\n", "1,250;2;3\n4,5;6;7\n"):
        assert len(read(text)) >= 1


def test_a_line_that_is_a_name_with_blanks_is_one_cell():
    assert csv_dialect.separator_of("my joint\n", ("my joint",)) == ","
    assert csv_dialect.separator_of("my joint\n") == " "
    assert read("my joint\n0.5\n", ("my joint",)) == [[0.5]]


def test_a_unit_behind_a_blank_belongs_to_the_name_before_it():
    for unit in ("[deg]", "(deg)"):
        for name in ("q", "my joint"):
            rows = csv_dialect.split(iter([f"{name} {unit}\n", "30\n"]), "f.csv", (name,))
            assert list(rows) == [(1, [f"{name} {unit}"]), (2, ["30"])]
        rows = csv_dialect.split(iter([f"a {unit}  b {unit} c\n", "1 2 3\n"]), "f.csv")
        assert list(rows) == [(1, [f"a{unit}", f"b{unit}", "c"]), (2, ["1", "2", "3"])]


def test_names_with_a_semicolon_are_written_so_that_they_are_read():
    text = csv_rows.text(["a;b", "c"], np.array([[1.5, 2.0]]))
    assert text == '"a;b","c"\n1.5,2.0\n'
    assert read(text, ("a;b", "c")) == [[1.5, 2]]
    text = csv_rows.text(["a\tb", "c"], np.array([[1.5, 2.0]]))
    assert text == "a\\tb,c\n1.5,2.0\n"


def test_lines_are_counted_whatever_comes_first():
    rows = csv_dialect.split(iter(["\n", "sep=;\n", "\n", "1;2\n", ";\n", "3;4\n"]), "f.csv")
    assert list(rows) == [(4, ["1", "2"]), (6, ["3", "4"])]
    assert list(csv_dialect.split(iter(["\n", " \n"]), "f.csv")) == []


def test_lines_of_separators_alone_are_passed_over_however_many_there_are():
    lines = [f"{','.join('123')}\n", *(f"{',' * count}\n" for count in range(1, 6)), "4,5,6\n"]
    assert list(csv_dialect.split(iter(lines), "f.csv")) == [(1, [*"123"]), (7, [*"456"])]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_blanks_in_a_cell_stay_where_they_are_no_separators(separator):
    lines = [f"a  b{separator}c\n", f'" 1  2"{separator}3 \n']
    rows = list(csv_dialect.split(iter(lines), "f.csv"))
    assert rows == [(1, ["a  b", "c"]), (2, [" 1  2", "3 "])]
    assert list(csv_dialect.split(iter(["a  b \n", " 1   2\n"]), "f.csv")) == [
        (1, ["a", "b"]),
        (2, ["1", "2"]),
    ]


def test_utf_16_is_named(tmp_path):
    path = tmp_path / "excel.txt"
    path.write_bytes("1\t2\t3\n".encode("utf-16"))
    with pytest.raises(FileError) as caught, csv_rows.opened(path) as (stream, _, _):
        stream.read()
    assert str(caught.value).endswith(
        "is no text file: byte 0 is not UTF-8; it is UTF-16, save it as CSV UTF-8"
    )


@pytest.mark.parametrize("text", [" " * 200_000 + "x", "(" * 200_000, "a" + " (" * 100_000 + ")"])
def test_a_long_line_is_gone_over_once(text):
    """Not once for each of its characters, which would take minutes."""
    assert csv_dialect.separator_of(text, ("q",)) in (",", " ")
