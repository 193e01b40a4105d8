"""Results as plain data: what every result of poekin can be turned into."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar

import numpy as np

from .html_page import element, text

Progress = Callable[[int, int], None]
"""Called as progress(done, all) while a result is made."""


class Result:
    """Base of the results: frozen dataclasses that print their summary and become dicts or JSON."""

    derived: ClassVar[tuple[str, ...]] = ()  # properties that `to_dict` holds behind the fields
    left_out: ClassVar[tuple[str, ...]] = ()  # fields that are no plain data, such as a chain

    def summary(self) -> str:
        """Text for people: lengths in mm, angles in degrees or mrad.

        Returns
        -------
        text : str
            Lines without a line break at the end.
        """
        raise NotImplementedError

    def to_dict(self) -> dict[str, object]:
        """Fields and derived values as dicts, lists, strings and numbers.

        Returns
        -------
        document : dict
            Arrays are lists, in SI units; a number that is not finite is None.
        """
        fields = (field.name for field in dataclasses.fields(self))  # type: ignore[arg-type]
        kept = [name for name in fields if name not in self.left_out]
        return {name: plain(getattr(self, name)) for name in (*kept, *self.derived)}

    def to_json(self, indent: int | None = 2) -> str:
        """`to_dict` as JSON text.

        Parameters
        ----------
        indent : int, optional
            Spaces of each level; None writes one line.

        Returns
        -------
        text : str
            JSON without NaN or Infinity, which are null.

        Raises
        ------
        TypeError
            If a field is no plain data.
        """
        return json.dumps(self.to_dict(), indent=indent, allow_nan=False)

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        first, *_ = self.summary().split("\n")
        return brief(self, first)

    def _repr_html_(self) -> str:
        return element("pre", text(self.summary()))


def brief(value: object, words: str) -> str:
    """One line that stands for a value of many numbers."""
    return f"<{type(value).__name__}: {words}>"


def plain(value: object) -> object:
    """A value as dicts, lists, strings and numbers; a number that is not finite as None."""
    if isinstance(value, Result):
        return value.to_dict()
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return plain(value._asdict())  # type: ignore[attr-defined]
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        return [plain(item) for item in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    raise TypeError(f"no plain data: {type(value).__name__}")
