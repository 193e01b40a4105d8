"""Last result of a computation, kept because a fit asks for each several times."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Value = TypeVar("Value")


class LastResult(Generic[Value]):
    """The result of one key, until another key is asked for."""

    def __init__(self) -> None:
        self._last: tuple[Hashable, Value] | None = None

    def __call__(self, key: Hashable, compute: Callable[[], Value]) -> Value:
        """compute(), or the last result where its key was the same."""
        if self._last is None or self._last[0] != key:
            self._last = (key, compute())
        return self._last[1]
