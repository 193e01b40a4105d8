"""What was found cannot be changed by accident, and findings of arrays are not compared number by
number.
"""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import re
from collections.abc import Callable
from typing import Any

ARRAYS = re.compile(r"\b(Array|Marks|ndarray|Any)\b")


def dataclasses_of(package: str, names: str) -> list[type]:
    """The dataclasses that modules of a package define, none of them in vain; a function may have a
    module's name.
    """
    found: list[type] = []
    for name in names.split():
        module = importlib.import_module(f"{package}.{name}")
        own = [
            kind
            for kind in vars(module).values()
            if isinstance(kind, type) and kind.__module__ == module.__name__
        ]
        chosen = [kind for kind in own if dataclasses.is_dataclass(kind)]
        assert chosen, f"{package}.{name} has no dataclass"
        found += chosen
    return found


def frozen_and_equal_only_where_its_parts_can_be(kind: type) -> bool:
    """Whether a dataclass is frozen, and has an == of its own unless it holds arrays."""
    parts = [str(part.type) for part in dataclasses.fields(kind)]  # type: ignore[arg-type]
    arrays = any(ARRAYS.search(said) for said in parts)
    parameters = kind.__dataclass_params__  # type: ignore[attr-defined]
    return (parameters.frozen, parameters.eq) == (True, not arrays)


def defaults_are_those_of_the_docstring(function: Callable[..., Any]) -> bool:
    """Whether the defaults that a docstring states, none of them in vain, are those that hold."""
    stated: dict[str, object] = {}
    for names, value in re.findall(
        r"^ *([\w, ]+) : .*default (\S+)$", function.__doc__ or "", re.M
    ):
        stated |= dict.fromkeys(names.split(", "), ast.literal_eval(value))
    assert stated, function
    parameters = inspect.signature(function).parameters
    return stated == {name: parameters[name].default for name in stated}
