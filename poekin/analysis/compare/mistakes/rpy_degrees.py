"""Models in whose file rpy stands in degrees, which were read as radians."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ....groups.arrays import Array
from ....model.chain import Chain
from ...axis_lines import Marks, direction, line_angle, prismatic
from ..alignment.hypotheses import Hypothesis

ROUNDING = 1e-3
"""Largest difference (rad) of an angle times 180 / π from what it should be: files write π / 2 as
1.5708, so that a right angle is 90.0002, and this lets 1.571 pass too, for a tilt in degrees.
"""
HALVES = np.pi / 4.0 * np.array([-4.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0])
"""Turns of a link that files have: multiples of half a right angle, up to half a turn."""
LEAST = 1e-2
"""Angles (rad) of neighbouring axes that differ by less say nothing."""


def in_degrees(a: Chain, b: Chain) -> str:
    """Model, "a" or "b", whose links turn by as many radians as the other's by degrees, or "".

    A link of rpy = (α, 0, 0) turns the next axis by α. Where 180 / π α stands there instead, the
    angle of neighbouring axes says so, whatever base, zeros and directions are. Half or more of the
    angles that differ have to.
    """
    ours = _angles(a)
    theirs = _angles(b)
    for name, right, wrong in (("b", ours, theirs), ("a", theirs, ours)):
        differ = abs(right - wrong) > LEAST
        # Lines that make an angle of α make one of π - α.
        read = np.degrees([right, np.pi - right])
        miss = abs(_line_angle(read) - wrong).min(0)
        explained = differ & (miss <= ROUNDING)
        if explained.sum() >= max(1.0, 0.5 * differ.sum()):
            return name
    return ""


def zeros_in_degrees(reading: Hypothesis, revolute: Marks) -> bool:
    """Whether the zero offsets of a reading are all those that degrees for radians make.

    Where rpy turns a link by c about the joint's own axis, 180 / π c in its place is a zero offset
    of (180 / π - 1) c. Multiples of half a right angle are tried.
    """
    offset = reading.offset
    if reading.moved.any() or not offset.any() or not revolute[offset].all():
        return False
    turns = (180.0 / np.pi - 1.0) * HALVES
    apart = reading.zeros[offset][:, None] - turns
    miss = abs(np.angle(np.exp(1j * apart))).min(axis=1)
    return bool((miss <= ROUNDING).all())


def _angles(chain: Chain) -> Array:
    ways = direction(chain.screws, prismatic(chain))
    return np.array([line_angle(w, u) for w, u in pairwise(ways)])


def _line_angle(turn: Array) -> Array:
    """Angle (0 to π / 2) of two lines, one turned from the other by so much."""
    sine = abs(np.sin(turn))
    cosine = abs(np.cos(turn))
    return np.asarray(np.arctan2(sine, cosine))
