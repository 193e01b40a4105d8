"""YAML of names and numbers: every refusal says file and line, what was expected and what arrived."""

from __future__ import annotations

import pytest

from poekin.errors import ModelError
from poekin.formats.text import yaml_text

REFUSED = {
    "two documents": ("a: 1\n---\nb: 2\n", "f:2: expected one document, a second one begins here"),
    "an alias": ("a: &x 1\n", "f:1: tags and anchors are refused, got 'x'"),
    "a tag": ("a:\n  !!int 1\n", "f:2: tags and anchors are refused, got 'tag:yaml.org,2002:int'"),
    "a reference": ("a: 1\nb: *a\n", "f:2: expected names and numbers, got an alias"),
    "a list": ("a:\n - 1\n", "f:2: expected names and numbers, got a list"),
    "a text": ("\nword\n", "f:2: expected a mapping, as in \"kinematics:\", got 'word'"),
    "no key": ("? {a: 1}\n: 2\n", "f:1: expected the name of a key, got a mapping"),
    "twice": ("x:\n  a: 1\n  b: 1\n  a: 2\n", "f:4: 'a' appears twice (first: line 2)"),
    "deep": ("{a: " * 9 + "1" + "}" * 9, "f:1: expected at most 8 levels, got more"),
    "empty": ("# nothing\n", "f: the text is empty"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_text_that_is_refused_is_named_with_its_line(case):
    text, message = REFUSED[case]
    with pytest.raises(ModelError) as caught:
        yaml_text.parse(text, "f")
    assert str(caught.value) == message


def test_a_text_that_is_no_yaml_is_refused_with_its_line_and_the_reader_s_reason():
    with pytest.raises(ModelError, match=r"^f:2: not YAML: .*expected.* node content"):
        yaml_text.parse("a: 1\nb: }\n", "f")


def test_a_mapping_knows_the_lines_of_its_keys_and_values():
    root = yaml_text.parse("\na:\n  b: 1\n  c:\n    2\nd: x\n", "f")
    inner = root.items["a"]
    assert isinstance(inner, yaml_text.MappingNode)
    assert (root.line, root.key_lines) == (2, {"a": 2, "d": 6})
    assert (inner.line, inner.key_lines) == (3, {"b": 3, "c": 4})
    assert inner.items == {"b": yaml_text.TextNode("1", 3), "c": yaml_text.TextNode("2", 5)}
    assert yaml_text.parse("{a: " * 8 + "1" + "}" * 8, "f").items


FOUND = {
    "a key": ("a: 1\nb: 2\n", "2", 2),
    "the first of the keys": ("c: 3\nb: 2\n", "3", 1),
    "at a depth": ("x:\n  y:\n    b: 2\n", "2", 3),
    "in a list": ("x:\n- y: 1\n- b: 2\n", "2", 3),
    "behind lists, mappings and aliases": (
        "x: &x [1, {y: 2}]\nz: {b b: 1}\n? [p, q]\n: 1\nw: *x\n? *x\n: 0\nb: 2\n",
        "2",
        8,
    ),
    "not where it is a value or an item": ("x: b\ny: [b, c]\nz: {q: b}\nb: 2\n", "2", 4),
    "not where a mapping stands for it": ("b:\n  x: 1\nc: 2\n", "2", 3),
    "the document": ("'text'\n", "text", 1),
    "in a second document": ("a: 1\n---\nb: 2\n", "2", 3),
    "with a tag": ("b: !!str 2\n", "2", 1),
}


@pytest.mark.parametrize("case", FOUND)
def test_one_text_is_found_by_its_key(case):
    text, value, line = FOUND[case]
    assert yaml_text.find(text, "f", ("b", "c")) == (value, line)


@pytest.mark.parametrize(
    "text", ["a: 1\n", "- b\n", "b: [1]\n", "b: *x\n", "---\n", "", "# b: 1\n"]
)
def test_a_text_that_is_not_there_is_not_found(text):
    if "*x" in text:
        text = "x: &x 1\n" + text
    assert yaml_text.find(text, "f", ("b",)) is None


def test_what_is_behind_the_text_is_not_read():
    assert yaml_text.find("b: 1\nc: }\n", "f", ("b",)) == ("1", 1)
    with pytest.raises(ModelError, match=r"^f:2: not YAML: "):
        yaml_text.find("c: 1\nb: }\n", "f", ("b",))


def test_depth_is_bounded_where_a_text_is_looked_for():
    with pytest.raises(ModelError, match=r"^f:1: expected at most 8 levels, got more$"):
        yaml_text.find("[" * 9 + "]" * 9, "f", ("b",))
    assert yaml_text.find("[" * 8 + "]" * 8, "f", ("b",)) is None
