"""Limits of joints as files have them."""

from __future__ import annotations

import math

Interval = tuple[float, float]
UNBOUNDED: Interval = (-math.inf, math.inf)
ABSURD = 1e4
"""Bounds this large [rad or m] bound nothing."""


def without_absurd(lower: float | None, upper: float | None) -> Interval:
    """Limits in which what is missing or absurd is infinite."""
    if lower is None or abs(lower) >= ABSURD:
        lower = -math.inf
    if upper is None or abs(upper) >= ABSURD:
        upper = math.inf
    return lower, upper
