"""Motions of a tool and rates of joints as text."""

from __future__ import annotations

import math

import numpy as np

from ...errors import quote
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part


def motion_words(V: Array) -> str:
    """A twist (6,) in base axes at the tool's origin, as the end of a sentence: "turning about the
    base's z axis".
    """
    w = np.linalg.norm(angular_part(V))
    v = np.linalg.norm(linear_part(V))
    # 2 cm per rad, and 1/50 rad per m, are too little to be told
    if v <= 0.02 * w:
        return f"turning about {_direction(angular_part(V))}"
    if w <= 0.02 * v:
        return f"moving along {_direction(linear_part(V))}"
    turning = f"turning about {_direction(angular_part(V))}"
    moving = f"moving along {_direction(linear_part(V))}"
    if v > w:
        return f"{moving} while {turning} by {w / v:.3g} rad per m"
    return f"{turning} while its origin is {moving} by {v / w:.3g} m per rad"


def rate_words(
    q_names: tuple[str, ...],
    rates: Array,
    ratios: Array,
) -> str:
    """Rates of coordinates as "'elbow' +0.89, 'wrist' -0.45": those whose joints go by more than
    0.1, the fastest joint first.
    """
    speeds = np.abs(rates * ratios)
    told = [k for k in np.argsort(-speeds, kind="stable") if speeds[k] > 0.1]
    return ", ".join(f"{quote(q_names[k])} {_rate(float(rates[k]))}" for k in told)


def _rate(rate: float) -> str:
    """A rate with two decimals, or with three digits where those say too little or too much."""
    return f"{rate:+.2f}" if 0.1 < abs(rate) < 100 else f"{rate:+.3g}"


def _direction(x: Array) -> str:
    """An axis of the base, where x is within a degree of one, or x as a unit vector."""
    e = x / np.linalg.norm(x)
    k = int(np.argmax(np.abs(e)))
    if abs(e[k]) >= math.cos(math.radians(1)):
        return f"the base's {'xyz'[k]} axis"
    return "({})".format(", ".join(f"{value + 0.0:.2f}" for value in np.round(e, 2)))
