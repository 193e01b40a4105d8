"""A stand-in for JAX: NumPy, and arrays that have `.at[...].add`, `max` and `min`."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any
from unittest import mock

import numpy as np


class Places:
    """Places of an array whose numbers an update changes, in a copy."""

    def __init__(self, array: Updated, places: Any) -> None:
        self.array = array
        self.places = places

    def _updated(self, function: np.ufunc, values: Any) -> Updated:
        changed = self.array.copy()
        function.at(changed, self.places, values)
        return changed

    def add(self, values: Any) -> Updated:
        return self._updated(np.add, values)

    def max(self, values: Any) -> Updated:
        return self._updated(np.maximum, values)

    def min(self, values: Any) -> Updated:
        return self._updated(np.minimum, values)


class At:
    """`array.at`."""

    def __init__(self, array: Updated) -> None:
        self.array = array

    def __getitem__(self, places: Any) -> Places:
        return Places(self.array, places)


class Updated(np.ndarray):
    """An array that is not written to."""

    @property
    def at(self) -> At:
        return At(self)


def by_numpy(text: str) -> dict[str, Any]:
    """The functions of a module for JAX, with numpy for jax.numpy."""
    stand_in = ModuleType("jax")
    numpy = ModuleType("jax.numpy")
    vars(numpy).update(vars(np), where=lambda *given: np.where(*given).view(Updated))
    stand_in.numpy = numpy  # type: ignore[attr-defined]
    functions: dict[str, Any] = {}
    with mock.patch.dict(sys.modules, {"jax": stand_in, "jax.numpy": numpy}):
        exec(compile(text, "emitted.py", "exec", dont_inherit=True), functions)
    return functions
