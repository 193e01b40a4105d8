"""TOML that takes tomllib for ever, or has numbers that Python cannot write, is refused as what it is."""

from __future__ import annotations

import pytest

from poekin.errors import ModelError
from poekin.formats import toml_text
from poekin.formats.dh import files

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
    with pytest.raises(ModelError, match=r"^f:2: expected keys of at most 32 parts"):
        toml_text.parse("\n" + text.format(between.join([part] * 100_000)), "f")


def test_numbers_and_sentences_are_no_keys():
    assert toml_text.parse("x = [" + "1.5, " * 100 + "]", "f") == {"x": [1.5] * 100}
    said = ". ".join(["One thing and another"] * 100)
    assert toml_text.parse(f'x = "{said}"', "f") == {"x": said}


@pytest.mark.parametrize("number", [HUGE, "0b" + "1" * 20_000, "0o" + "7" * 5000], ids=["hex", "binary", "octal"])
@pytest.mark.parametrize("text", ["x = {}", "x = [[{}]]", "x = [{{y = {}}}]", "[[x]]\ny = {}"])
def test_a_whole_number_that_python_cannot_write_is_refused(text, number):
    with pytest.raises(ModelError, match=r"^f: expected whole numbers of at most 4300 digits, got a longer one$"):
        toml_text.parse(text.format(number), "f")
    assert toml_text.parse(f"x = 0x{'f' * 3000}", "f") == {"x": 16**3000 - 1}


@pytest.mark.parametrize("old", ['"standard"', "theta = 0", "alpha = 0\n"])
def test_a_huge_number_anywhere_in_a_table_is_a_model_error(old):
    key = old.partition(" = ")[0] + " = " if " = " in old else ""
    with pytest.raises(ModelError, match=r"^t\.toml: expected whole numbers"):
        files.read_text(TABLE.replace(old, f"{key}{HUGE}\n"), "t.toml")


def test_a_column_that_is_there_thousands_of_times_is_said_once():
    with pytest.raises(ModelError, match=r"^t\.csv:1: column theta is there 20000 times, expected once$"):
        files.read_text(",".join(["theta"] * 20_000), "t.csv")
