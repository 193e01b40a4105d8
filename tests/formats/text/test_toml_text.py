"""TOML that takes tomllib for ever, or has numbers that Python cannot write, is refused as what it
is.
"""

from __future__ import annotations

import math
import sys

import pytest

from poekin.errors import FileError, MissingExtra, ModelError
from poekin.formats.dh import table_io
from poekin.formats.text import toml_text

DATA = """
word = "a"
words = ["a", "b"]
yes = true
one = 1
half = 0.5
below = -1
endless = inf
row = [1, 2, 3]
rows = [[1, 2], [3, 4]]
table = {x = 1}
tables = [{x = 1}, {x = 2}]
mixed = [1, "a"]
"""
REFUSED = {
    "missing": (lambda k: k.value("none"), "f: none is missing"),
    "missing, of a long name": (lambda k: k.value("k" * 81), f"f: {'k' * 79}… is missing"),
    "no table": (lambda k: k.table("one"), "f: one: expected a table, got 1"),
    "unknown in a table": (
        lambda k: k.table("table", ["y"]),
        "f: table: no such key: 'x'; available: 'y'",
    ),
    "no tables": (lambda k: k.tables("one", []), "f: one: expected [[one]] tables, got 1"),
    "no table in tables": (lambda k: k.tables("row", []), "f: row 1: expected a table, got 1"),
    "unknown in tables": (
        lambda k: k.tables("tables", ["xx"]),
        "f: tables 1: no such key: 'x'; did you mean 'xx'?",
    ),
    "no text": (lambda k: k.text("one"), "f: one: expected a text, got 1"),
    "none of those": (
        lambda k: k.text("word", ("b", "c")),
        "f: word: expected 'b' or 'c', got 'a'",
    ),
    "no texts": (lambda k: k.texts("mixed"), "f: mixed: expected a list of texts, got [1, 'a']"),
    "no truth": (lambda k: k.truth("one"), "f: one: expected true or false, got 1"),
    "no whole number": (
        lambda k: k.whole("half"),
        "f: half: expected whole numbers from 0 on, got 0.5",
    ),
    "below 0": (lambda k: k.whole("below"), "f: below: expected whole numbers from 0 on, got -1"),
    "not finite": (lambda k: k.number("endless"), "f: endless: expected finite numbers, got inf"),
    "no number": (lambda k: k.number("word"), "f: word: expected a number, got 'a'"),
    "truth for a number": (lambda k: k.number("yes"), "f: yes: expected a number, got True"),
    "too few": (
        lambda k: k.array("row", (4,)),
        "f: row: expected a list of 4 numbers, got 3 of them",
    ),
    "no list": (lambda k: k.array("one", (None,)), "f: one: expected a list of numbers, got 1"),
    "no lists": (lambda k: k.array("row", (3, 2)), "f: row: expected a list of 2 numbers, got 1"),
    "few lists": (
        lambda k: k.array("rows", (3, 2)),
        "f: rows: expected a list of 3 lists, got 2 of them",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_key_does_not_hold_is_said_with_the_key(case):
    ask, message = REFUSED[case]
    with pytest.raises(ModelError) as caught:
        ask(toml_text.Keys(toml_text.parse(DATA, "f"), "f"))
    assert str(caught.value) == message


def test_of_a_table_s_name_80_characters_are_said():
    for length, said in ((80, "k" * 80), (81, "k" * 79 + "…")):
        keys = toml_text.Keys({"k" * length: {}}, "f")
        with pytest.raises(ModelError) as caught:
            keys.table("k" * length).text("none")
        assert str(caught.value) == f"f: {said}: none is missing"


def test_what_a_key_holds_is_given_as_what_it_is():
    keys = toml_text.Keys(toml_text.parse(DATA, "f"), "f")
    assert (keys.text("word"), keys.text("word", ("b", "a")), keys.texts("words")) == (
        "a",
        "a",
        ("a", "b"),
    )
    assert (keys.truth("yes"), keys.whole("one"), keys.number("half")) == (True, 1, 0.5)
    assert keys.number("endless", finite=False) == float("inf")
    assert keys.array("row", (3,)).tolist() == keys.array("row", (None,)).tolist() == [1, 2, 3]
    assert keys.array("rows", (None, 2)).tolist() == [[1, 2], [3, 4]]
    assert keys.table("table", ["x"]).place == "f: table"
    assert [table.whole("x") for table in keys.tables("tables", ["x"])] == [1, 2]
    assert keys.tables("none", []) == []


def test_tables_in_a_list_are_counted_from_1():
    keys = toml_text.Keys({"rows": [{"x": k} for k in range(6)]}, "f")
    assert [(t.place, t.whole("x")) for t in keys.tables("rows", ["x"])] == [
        (f"f: rows {k + 1}", k) for k in range(6)
    ]


def test_a_whole_number_that_is_too_large_for_a_float_is_infinite():
    keys = toml_text.Keys({"n": [10**400, -(10**400), -3]}, "f")
    assert keys.array("n", (3,), finite=False).tolist() == [math.inf, -math.inf, -3]
    with pytest.raises(ModelError, match=r"^f: n: expected finite numbers, got inf$"):
        keys.array("n", (None,))


@pytest.mark.parametrize("number", [2**53 + 2, 2**60, -1, -(2**60), 0.5, -0.5])
def test_each_number_of_a_list_is_a_whole_one_from_0_on(number):
    for row in ([number, 1], [1, number], [number, -7]):
        with pytest.raises(ModelError) as caught:
            toml_text.Keys({"n": row}, "f").wholes("n", (2,))
        assert str(caught.value) == f"f: n: expected whole numbers from 0 on, got {number:g}"


@pytest.mark.parametrize("number, whole", [(0, True), (2**53 - 1, True), (2**53, False)])
def test_a_whole_number_is_one_that_a_float_holds(number, whole):
    keys = toml_text.Keys({"n": number}, "f")
    if whole:
        assert keys.whole("n") == number
        return
    with pytest.raises(
        ModelError, match=r"^f: n: expected whole numbers from 0 on, got 9\.0072e\+15$"
    ):
        keys.whole("n")


def test_a_file_that_is_no_text_is_refused_with_its_byte(tmp_path):
    path = tmp_path / "t.toml"
    path.write_bytes(b"x = 1\n\xff")
    with pytest.raises(FileError, match=r"t\.toml: not UTF-8 at byte 6$"):
        toml_text.read(path)


HUGE = "0x" + "f" * 5000
TABLE = 'convention = "standard"\n[[joint]]\ntheta = 0\nd = 0\na = 1\nalpha = 0\n'


@pytest.mark.parametrize(
    "text",
    ["{} = 1", "[{}]", "[[{}]]", "x = {{{} = 1}}", "x = [{{{} = 1}}]", " \t{} = 1"],
    ids=["key", "table", "list", "inline", "inline in a list", "indented"],
)
@pytest.mark.parametrize("part", ["a", '"a b"', "'a.b'", "-1_"])
@pytest.mark.parametrize("between", [".", " . "], ids=["dots", "blanks"])
def test_a_key_of_many_parts_is_refused_and_one_of_few_is_read(text, part, between):
    assert toml_text.parse("\n" + text.format(between.join([part] * 32)), "f")
    with pytest.raises(
        ModelError,
        match=r"^f:2: expected keys of at most 32 parts, a\.b\.c has three, got a longer one$",
    ):
        toml_text.parse("\n" + text.format(between.join([part] * 100_000)), "f")


def test_numbers_and_sentences_are_no_keys():
    assert toml_text.parse("x = [" + "1.5, " * 100 + "]", "f") == {"x": [1.5] * 100}
    said = ". ".join(["One thing and another"] * 100)
    assert toml_text.parse(f'x = "{said}"', "f") == {"x": said}


@pytest.mark.parametrize(
    "number",
    [HUGE, "0b" + "1" * 20_000, "0o" + "7" * 5000, hex(10**4300)],
    ids=["hex", "binary", "octal", "least"],
)
@pytest.mark.parametrize("text", ["x = {}", "x = [[{}]]", "x = [{{y = {}}}]", "[[x]]\ny = {}"])
def test_a_whole_number_that_python_cannot_write_is_refused(text, number):
    with pytest.raises(
        ModelError, match=r"^f: expected whole numbers of at most 4300 digits, got a longer one$"
    ):
        toml_text.parse(text.format(number), "f")
    assert toml_text.parse(f"x = {hex(10**4300 - 1)}", "f") == {"x": 10**4300 - 1}


@pytest.mark.parametrize("old", ['"standard"', "theta = 0", "alpha = 0\n"])
def test_a_huge_number_anywhere_in_a_table_is_a_model_error(old):
    key = old.partition(" = ")[0] + " = " if " = " in old else ""
    with pytest.raises(
        ModelError,
        match=r"^t\.toml: expected whole numbers of at most 4300 digits, got a longer one$",
    ):
        table_io.read_text(TABLE.replace(old, f"{key}{HUGE}\n"), "t.toml")


def test_a_column_that_is_there_thousands_of_times_is_said_once():
    with pytest.raises(
        ModelError, match=r"^t\.csv:1: theta: it appears 20000 times, expected once$"
    ):
        table_io.read_text(",".join(["theta"] * 20_000), "t.csv")


def test_without_tomli_w_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "tomli_w", None)
    message = r"^writing TOML needs the package tomli-w: pip install 'poekin\[formats\]'$"
    with pytest.raises(MissingExtra, match=message):
        toml_text.make_text({})
