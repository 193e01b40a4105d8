"""Warning where angles are so far beyond their limits that they look like degrees."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...errors import quote
from ...groups.arrays import Array
from ..provenance import warn

TURN = 2 * np.pi
"""Angle [rad] up to which nothing is said, whatever the limits."""

MANY = 2 * TURN
"""Angle [rad] from which a coordinate without limits is taken for degrees."""


def warn_of_degrees(
    q: Array,
    names: tuple[str, ...],
    limits: Array,
    scale: Callable[[], Array],
    what: str,
) -> None:
    """A `PoekinWarning` for the first coordinate with such an angle among configurations (..., m).

    `scale` gives the radians of each coordinate's unit, 0 for a length. The text holds no value:
    so Python shows it once for each line of the user's.
    """
    if q.ndim == 1 and all(-TURN <= angle <= TURN for angle in q.tolist()):
        return  # in a third of the time
    sizes = np.where(np.isfinite(q), np.abs(q), 0.0)
    if not (sizes > TURN).any():
        return
    bounds = np.abs(limits).max(axis=1)
    unlimited = np.isinf(bounds)
    radians = scale()
    with np.errstate(over="ignore", invalid="ignore"):
        most = np.where(unlimited, MANY, np.maximum(bounds * radians, TURN))
        beyond = sizes * radians > most
    for k in np.flatnonzero(beyond.reshape(-1, len(names)).any(axis=0))[:1]:
        size = "two turns" if unlimited[k] else "a turn, and beyond its limits"
        warn(
            f"{what}: {quote(names[k])} is more than {size}; if these are degrees, np.radians makes"
            " radians of them"
        )
