"""Digits that numbers were printed with: the decimal grid that all of them lie on, if there is one."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ....groups import rpy, so3
from ....groups.arrays import Array

MOST = 9
"""Decimals of a degree or a millimetre up to which digits are looked for: 1e-11 rad, 1e-12 m."""
_OFF = 0.01  # of a unit of the last digit: what is nearer to it than this lies on the grid
# of angles of rotations, which rounding moves where two of their axes are nearly parallel
_SHARE = 0.9


class DecimalGrid(NamedTuple):
    """Multiples of 10^-places units: numbers printed with so many decimals.

    Fields: size of the unit in rad or m, its symbol, decimals.
    """

    unit: float
    symbol: str
    places: int

    @property
    def half(self) -> float:
        """Half a unit of the last digit, rad or m: the largest error of rounding."""
        return 0.5 * self.unit * 10.0**-self.places

    def __str__(self) -> str:
        gap = "" if self.symbol == "°" else " "
        return f"{10.0**-self.places:g}{gap}{self.symbol}"


class RotationGrid(NamedTuple):
    """Grid of the numbers by which rotations were printed, what they are, and the largest angle
    (rad) by which their rounding turns a frame.
    """

    grid: DecimalGrid
    what: str
    radius: float


_DEGREE = DecimalGrid(math.radians(1.0), "°", 0)
_RADIAN = DecimalGrid(1.0, "rad", 0)
_MILLIMETRE = DecimalGrid(1e-3, "mm", 0)
_PLAIN = DecimalGrid(1.0, "1", 0)


def angle_grid(values: Array) -> DecimalGrid | None:
    """Coarsest grid of angles, in degrees or rad, that all of them lie on."""
    return _coarsest(values, (_DEGREE, _RADIAN), 1.0)


def length_grid(values: Array) -> DecimalGrid | None:
    """Coarsest grid of lengths, m, in millimetres, that all of them lie on."""
    return _coarsest(values, (_MILLIMETRE,), 1.0)


def rotation_grid(R: Array) -> RotationGrid | None:
    """Grid of rotations (N, 3, 3): of roll, pitch and yaw, of the rotation vector, or of R itself.

    Numbers off by h at most turn the frame by at most sqrt(6) h (three axes, each orthogonal to the
    next: |E|^2 = 1 + |cos| <= 2 times |h|^2 <= 3 h^2), sqrt(3) h (the Jacobian of exp is no longer
    than 1) and 3 h / sqrt(2) (half of R - R^T counts). Other sequences of angles and quaternions,
    which are made unit again where they are read, leave no grid.
    """
    angles = _DEGREE, _RADIAN
    ways = (
        ("roll, pitch, yaw", rpy.angles(R), angles, _SHARE, math.sqrt(6.0)),
        ("rotation vector", so3.log(R), angles, _SHARE, math.sqrt(3.0)),
        ("matrix", R, (_PLAIN,), 1.0, 3.0 / math.sqrt(2.0)),
    )
    for what, values, units, share, times in ways:
        found = _coarsest(values, units, share)
        if found is not None:
            return RotationGrid(found, what, times * found.half)
    return None


def _coarsest(
    values: Array,
    units: tuple[DecimalGrid, ...],
    share: float,
) -> DecimalGrid | None:
    """The grid of fewest decimals that this share of the values lies on, in one of these units."""
    for places in range(MOST + 1):
        for unit in units:
            steps = values / unit.unit * 10.0**places
            off = np.abs(steps - np.round(steps))
            if np.quantile(off, share) <= _OFF:
                return unit._replace(places=places)
    return None
