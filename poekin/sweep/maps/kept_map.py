"""The plain data of a map, as a file keeps it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

ARRAYS = ("counts", "best", "attained")


class KeptMap(NamedTuple):
    """A map as plain data: the sweep, the arrays by name, and how many samples were outside."""

    about: dict[str, Any]
    arrays: dict[str, np.ndarray]
    outside: int
