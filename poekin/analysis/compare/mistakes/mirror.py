"""Models that mirror each other: one file in left-handed coordinates."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ....model.chain import Chain
from ...axis_lines import Tolerances
from ..alignment.hypotheses import Hypothesis, as_they_stand
from ..alignment.search import agreeing

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, ...] = ("x", "y", "z")


def mirrored(chain: Chain, axis: Axis) -> Chain:
    """The arm as a mirror across a coordinate plane of its base shows it.

    With F the reflection, a pose T becomes F T F: points p become F p, and the angular part of a
    screw, which is an axial vector, -F w; joints that turn then count the other way, so that it is
    their screws' sign that is free.
    """
    F = np.eye(4)
    k = AXES.index(axis)
    F[k, k] = -1.0
    R = F[:3, :3]
    screws = chain.screws.copy()
    screws[:, :3] = -screws[:, :3] @ R
    screws[:, 3:] = screws[:, 3:] @ R
    # A mirrored screw thread runs the other way.
    return chain.replace(screws=screws, home=F @ chain.home @ F, pitches=-chain.pitches)


def mirror_of(
    a: Chain,
    b: Chain,
    tol: Tolerances,
    *,
    moved: bool,
) -> Axis | None:
    """The coordinate of the base whose other sign makes b a, as it stands or, where `moved` is
    wanted, with base and tool elsewhere; None where there is none.
    """
    for axis in AXES:
        if _agree(as_they_stand(a, mirrored(b, axis), tol)):
            return axis
    # Mirrors across other planes differ by a motion.
    if moved:
        reading = agreeing(a, mirrored(b, "x"), tol)
        if reading is not None and not reading.offset.any():
            return "x"
    return None


def _agree(reading: Hypothesis) -> bool:
    """Whether nothing differs but all directions at once."""
    one_way = abs(reading.directions.sum()) == len(reading.directions)
    return one_way and not (reading.moved.any() or reading.offset.any() or reading.frames)
