"""Objects that are equal where all that they hold is."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


class ByValue:
    """Base of frozen dataclasses with arrays, which are compared, hashed and pickled by their fields."""

    __slots__ = ()

    def _values(self) -> list[Any]:
        return [getattr(self, field.name) for field in fields(self)]  # type: ignore[arg-type]

    def _data(self) -> tuple[Any, ...]:
        """Its fields, arrays as bytes, which can be compared and hashed."""
        return tuple(x.tobytes() if isinstance(x, np.ndarray) else x for x in self._values())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return NotImplemented
        return self._data() == other._data()

    def __hash__(self) -> int:
        return hash(self._data())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), tuple(self._values())
