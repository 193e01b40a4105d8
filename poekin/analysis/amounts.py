"""Lengths and angles as summaries show them: in mm and in degrees."""

from __future__ import annotations

import math
from typing import Literal

Unit = Literal["rad", "m"]


def joint_unit(kind: str) -> Unit:
    """Unit of a joint's variable: "m" of a prismatic joint, else "rad"."""
    if kind == "prismatic":
        return "m"
    return "rad"


def amount(value: float, unit: Unit, digits: int = 4) -> str:
    """A length (m) or an angle (rad) for reading: "3.2 mm", "0.5°"."""
    if unit == "rad":
        return f"{math.degrees(value):.{digits}g}°"
    return f"{1e3 * value:.{digits}g} mm"
