"""Results become dicts and JSON that hold all of them, and nothing that JSON has not."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import pytest

from poekin.results import Result, plain


@dataclass(frozen=True)
class Part:
    names: tuple[str, ...]


class Pair(NamedTuple):
    left: float
    right: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Whole(Result):
    derived: ClassVar = ("double",)
    left_out: ClassVar = ("chain",)
    value: float
    parts: tuple[Part, ...]
    chain: object = None

    @property
    def double(self) -> float:
        return 2 * self.value

    def summary(self) -> str:
        return f"value {self.value}"


def test_a_result_is_its_fields_and_what_it_derives_from_them():
    whole = Whole(1.5, (Part(("a", "b")),), chain=object())
    assert whole.to_dict() == {"value": 1.5, "parts": [{"names": ["a", "b"]}], "double": 3.0}
    assert json.loads(whole.to_json()) == whole.to_dict()
    assert '{\n  "value": 1.5,\n  "parts": [\n    {' in whole.to_json()
    assert '{\n "value": 1.5,' in whole.to_json(indent=1)
    assert "\n" not in whole.to_json(indent=None)
    assert str(whole) == "value 1.5"
    assert Result.__repr__(whole) == "<Whole: value 1.5>"
    assert whole._repr_html_() == "<pre>value 1.5</pre>"


def test_a_result_in_a_result_has_what_it_derives():
    inner = Whole(1.0, ())
    assert plain([inner]) == [{"value": 1.0, "parts": [], "double": 2.0}]


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (np.array([[1.0, np.nan], [np.inf, -0.5]]), [[1.0, None], [None, -0.5]]),
        (np.float64(2.5), 2.5),
        (np.bool_(True), True),
        (np.int64(3), 3),
        (float("-inf"), None),
        ({1: (2, "x", None)}, {"1": [2, "x", None]}),
        ([Pair(1.0, (2, 3))], [{"left": 1.0, "right": [2, 3]}]),
    ],
    ids=["array", "float", "bool", "int", "not finite", "dict", "named tuple"],
)
def test_numbers_become_those_of_python(value, expected):
    found = plain(value)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    "value, kind", [(object(), "object"), (b"bytes", "bytes"), (Part, "type"), ({1}, "set")]
)
def test_what_is_no_data_is_refused_by_its_kind(value, kind):
    with pytest.raises(TypeError, match=f"^no plain data: {kind}$"):
        plain([value])


def test_a_result_without_a_summary_has_none():
    with pytest.raises(NotImplementedError):
        Result().summary()
