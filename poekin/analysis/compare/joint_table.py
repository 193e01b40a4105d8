"""The joints of two models side by side, as a table for reading."""

from __future__ import annotations

import math

from .comparison import Comparison, JointComparison

HEADS = (
    "",
    "joint",
    "kind",
    "axis",
    "angle (deg)",
    "normal (mm)",
    "at the arm (mm)",
    "zero",
    "direction",
    "limits",
)


def joint_row(joint: JointComparison, result: Comparison) -> tuple[object, ...]:
    """A row of the table; lengths in mm and angles in degrees, 0 far below the tolerance."""
    slides = joint.unit == "m"
    coordinate = _mm if slides else _deg
    tol = result.tol_position if slides else result.tol_rotation
    return (
        joint.number,
        " / ".join(dict.fromkeys((joint.name_a, joint.name_b))),
        " / ".join(dict.fromkeys((joint.kind_a, joint.kind_b))),
        "DIFFERS" if joint.axis_differs else "same",
        _deg(joint.angle, result.tol_rotation),
        _mm(joint.normal, result.tol_position),
        _mm(joint.shift, result.tol_position),
        f"{coordinate(joint.zero_offset, tol)} {'mm' if slides else 'deg'}",
        "flipped" if joint.reversed else "same",
        " ".join(coordinate(bound, tol) for bound in joint.limits),
    )


def _mm(value: float | None, tol: float) -> str:
    """A length in mm to four digits, 0 far below the tolerance; nothing for None."""
    if value is None:
        return ""
    return _number(1e3 * value * (abs(value) >= 1e-6 * tol))


def _deg(value: float, tol: float) -> str:
    """An angle in degrees to four digits, 0 far below the tolerance."""
    return _number(math.degrees(value) * (abs(value) >= 1e-6 * tol))


def _number(value: float) -> str:
    return f"{float(value) + 0.0:.4g}"
