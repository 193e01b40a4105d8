"""Attributes by which objects of other libraries are known."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...errors import escape_unprintable

_NO_LISTS = (str, bytes, dict)


def has(obj: Any, *names: str) -> bool:
    """Whether an object has all these attributes."""
    return all(hasattr(obj, name) for name in names)


def as_list(obj: Any) -> list[Any]:
    """Items of a list, an array or a class that is like one; none of a text or a dict."""
    if isinstance(obj, Iterable) and has(obj, "__len__") and not isinstance(obj, _NO_LISTS):
        return list(obj)
    return []


def type_name(obj: Any) -> str:
    """The full name of an object's type, harmless for plain text."""
    kind = type(obj)
    name = f"{kind.__module__}.{kind.__qualname__}"
    return escape_unprintable(name.removeprefix("builtins."))
