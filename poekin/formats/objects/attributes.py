"""What an object is, by the attributes that it has."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...errors import escape_unprintable


def has(obj: Any, *names: str) -> bool:
    """Whether an object has all these attributes."""
    return all(hasattr(obj, name) for name in names)


def as_list(obj: Any) -> list[Any]:
    """The items of what has an order and a length, as a list, an array or a class that is like one;
    none of a text.
    """
    if (
        isinstance(obj, (str, bytes, dict))
        or not isinstance(obj, Iterable)
        or not has(obj, "__len__")
    ):
        return []
    return list(obj)


def type_name(obj: Any) -> str:
    """The full name of an object's type, harmless for plain text."""
    kind = type(obj)
    return escape_unprintable(
        kind.__qualname__
        if kind.__module__ == "builtins"
        else f"{kind.__module__}.{kind.__qualname__}"
    )


def free_name(name: str, taken: set[str]) -> str:
    """A name that is not taken yet, the one given with underscores behind it; it is taken from now
    on.
    """
    while name in taken:
        name += "_"
    taken.add(name)
    return name
