"""Models that mirror each other: one file in left-handed coordinates."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ....groups.vectors import angular_part, linear_part, rotation_part
from ....model.chain import Chain
from ...axis_lines import Tolerances
from ..alignment.hypotheses import Hypothesis, as_they_stand
from ..alignment.search import agreeing
from ..reached import near

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
    R = rotation_part(F)
    screws = chain.screws.copy()
    screws[:, :3] = -angular_part(screws) @ R
    screws[:, 3:] = linear_part(screws) @ R
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
    wanted, as a calibrated arm or with base and tool elsewhere; None where there is none.
    """
    mirrors = [mirrored(b, axis) for axis in AXES]
    for axis, mirror in zip(AXES, mirrors, strict=True):
        reading = as_they_stand(a, mirror, tol)
        if _one_way(reading) and not (reading.moved.any() or reading.frames):
            return axis
    if not moved:
        return None
    one_arm = [_near(a, other, tol) for other in (b, *mirrors)]
    if True in one_arm:
        return (None, *AXES)[one_arm.index(True)]
    # Mirrors across other planes differ by a motion.
    found = agreeing(a, mirrors[0], tol)
    if found is not None and not found.offset.any():
        return "x"
    return None


def _one_way(reading: Hypothesis) -> bool:
    """Whether all directions or none are reversed, as a file keeps the signs of its axes or turns them."""
    return len(np.unique(reading.directions)) == 1


def _near(a: Chain, b: Chain, tol: Tolerances) -> bool:
    """Whether the poses, as the models stand, differ as those of one arm do."""
    reading = as_they_stand(a, b, tol)
    return _one_way(reading) and near(a, b, reading)
