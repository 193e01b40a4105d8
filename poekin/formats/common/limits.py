"""Limits of joints as files have them."""

from __future__ import annotations

import math

Interval = tuple[float, float]
UNBOUNDED: Interval = (-math.inf, math.inf)
ABSURD = 1e4
"""Bounds this large [rad or m, rad/s or m/s] bound nothing."""
ENDLESS = 1e16
"""Efforts this large [N m or N] stand for "none" in models of other programs."""


def known_velocity(value: float | None) -> float:
    """Velocity limit; infinite where it is missing, not positive or absurd.

    Real files write 0 for what is not known.
    """
    return _known(value, ABSURD)


def known_effort(value: float | None) -> float:
    """Effort limit; infinite where it is missing, not positive or above all forces on Earth."""
    return _known(value, ENDLESS)


def known_loss(value: float | None) -> float:
    """Damping or friction; 0 where it is missing, negative or infinite."""
    if value is None or not math.isfinite(value):
        return 0.0
    return max(0.0, value)


def _known(value: float | None, absurd: float) -> float:
    if value is None or not 0 < value < absurd:
        return math.inf
    return value


def without_absurd(lower: float | None, upper: float | None) -> Interval:
    """Limits in which what is missing or absurd is infinite."""
    if lower is None or abs(lower) >= ABSURD:
        lower = -math.inf
    if upper is None or abs(upper) >= ABSURD:
        upper = math.inf
    return lower, upper
