"""Errors in what is said: cosmic-ray has no operator for text, and a sentence that names the wrong
joint is an error.

Three small ones, with cosmic-ray's interface: a field of an f-string is left out, two neighbouring
fields of one change places, and a number in a sentence is one larger. A sentence is a string with a
space in it; docstrings and format specifications are left alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

_NUMBER = re.compile(r"(?<![\w.%\\-])\d+(?![\w.])")
_LITERAL = re.compile(r"\s*[uU]?['\"]")  # neither bytes nor a raw string, which is a pattern


@dataclass(frozen=True)
class Text:
    """What is written in place of a node."""

    text: str

    def get_code(self) -> str:
        return self.text


class FieldRemover:
    """`f"{a} and {b}"` becomes `f"{a} and "`."""

    def mutation_positions(self, node: Any) -> Iterator[tuple]:
        for k in _fields(node):
            yield node.children[k].start_pos, node.children[k].end_pos

    def mutate(self, node: Any, index: int) -> Text:
        return _with(node, {_fields(node)[index]: ""})


class FieldSwapper:
    """`f"{a} and {b}"` becomes `f"{b} and {a}"`."""

    def mutation_positions(self, node: Any) -> Iterator[tuple]:
        for k in _fields(node)[:-1]:
            yield node.children[k].start_pos, node.children[k].end_pos

    def mutate(self, node: Any, index: int) -> Text:
        first, second = _fields(node)[index : index + 2]
        return _with(
            node, {first: node.children[second].get_code(), second: node.children[first].get_code()}
        )


class SentenceNumber:
    """`"of 3 joints"` becomes `"of 4 joints"`."""

    def mutation_positions(self, node: Any) -> Iterator[tuple]:
        for _ in _numbers(node):
            yield node.start_pos, node.end_pos

    def mutate(self, node: Any, index: int) -> Text:
        number, code = _numbers(node)[index], node.get_code()
        return Text(f"{code[: number.start()]}{int(number[0]) + 1}{code[number.end() :]}")


OPERATORS = (
    ("messages/FieldRemover", FieldRemover()),
    ("messages/FieldSwapper", FieldSwapper()),
    ("messages/SentenceNumber", SentenceNumber()),
)


def _fields(node: Any) -> list[int]:
    """Which children of an f-string are fields."""
    return (
        [k for k, child in enumerate(node.children) if child.type == "fstring_expr"]
        if node.type == "fstring"
        else []
    )


def _with(node: Any, changed: dict[int, str]) -> Text:
    return Text(
        "".join(
            changed[k] if k in changed else child.get_code()
            for k, child in enumerate(node.children)
        )
    )


def _numbers(node: Any) -> list[re.Match[str]]:
    """The numbers in the text of a sentence."""
    if node.type == "fstring_string" and node.parent.type == "fstring":
        sentence = " " in node.parent.get_code().strip()
    else:
        sentence = node.type == "string" and " " in node.value and bool(_LITERAL.match(node.value))
        sentence = sentence and node.parent.type != "simple_stmt"  # a docstring
    return list(_NUMBER.finditer(node.get_code())) if sentence else []
