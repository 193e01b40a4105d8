"""A default that a docstring states is the default."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator
from typing import Any

from tools import docs_names, docs_render

NAMES = {"π": math.pi, "inf": math.inf, "False": False, "True": True}
IN_WORDS = "4 GiB"


def stated(text: str) -> dict[str, Any]:
    """Defaults of the parameters that a docstring says have one, by name."""
    found = {}
    for title, lines in docs_render.sections(text.splitlines()):
        if title not in ("Parameters", "Other Parameters"):
            continue
        for line in lines:
            head, _, kind = line.partition(" : ")
            _, has_default, said = kind.partition(", default ")
            if not has_default or line.startswith(" ") or said == IN_WORDS:
                continue
            names = [name.lstrip("*") for name in head.split(", ")]
            values = said.split(" and ") if " and " in said else [said] * len(names)
            for name, value in zip(names, values, strict=True):
                found[name] = eval(value, {"__builtins__": {}}, NAMES)
    return found


def others(thing: Any, text: str) -> Iterator[tuple[str, object, object]]:
    """Parameters whose defaults are other ones than are stated: name, stated, taken."""
    told = stated(text)
    if told:
        for name, parameter in inspect.signature(thing).parameters.items():
            if name in told and told[name] != parameter.default:
                yield name, told[name], parameter.default


def test_defaults_are_those_that_docstrings_state():
    wrong = []
    count = 0
    for dotted in docs_names.documented():
        thing = docs_names.resolved(dotted)
        text = inspect.getdoc(thing) or ""
        count += len(stated(text))
        wrong += [(dotted, *other) for other in others(thing, text)]
    assert wrong == []
    assert count > 100


def test_another_default_is_seen():
    def f(a=1, *, b=2.5, c="x"):
        """
        Parameters
        ----------
        a : int, default 1
            One.
        b, c : float or str, default 2.5
            Others.
        """

    assert list(others(f, inspect.getdoc(f) or "")) == [("c", 2.5, "x")]
