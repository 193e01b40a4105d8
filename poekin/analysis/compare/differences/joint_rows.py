"""Joints of two models side by side: what differs in each, by how much."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ....groups.arrays import Array
from ...axis_lines import (
    Tolerances,
    direction,
    distance_to_line,
    normal_length,
    place,
    prismatic,
    sine,
)
from ..alignment.hypotheses import Hypothesis
from ..alignment.lines import lines
from ..comparison import JointComparison
from ..followers import follows
from .effects import joint_effects
from .matching import Matched


def joint_rows(
    pair: Matched,
    reading: Hypothesis,
    tol: Tolerances,
) -> Iterator[JointComparison]:
    """Each joint of a beside that of b, as a reading has them."""
    a = pair.a
    b = pair.b
    ours = lines(a)
    slides = prismatic(b)
    their_ways = reading.directions[:, None] * direction(reading.axes, slides)
    gaps = place(reading.axes) - (ours.places + ours.centre)
    coupled = follows(pair.C_a, pair.C_b, a, b, reading, tol)
    effects = joint_effects(a, b, reading, pair.x)
    for i, following in enumerate(coupled):
        gap = gaps[i]
        if ours.slides[i] or slides[i]:
            gap = None
        angle, normal, shift = _apart(ours.ways[i], their_ways[i], gap, tol)
        zero = float(reading.zeros[i])
        theirs = b.limits[i]
        if ours.slides[i] != slides[i]:
            theirs = np.full(2, np.nan)
        yield JointComparison(
            number=int(pair.numbers[i]),
            name_a=a.joint_names[i],
            name_b=b.joint_names[i],
            kind_a=a.kinds[i],
            kind_b=b.kinds[i],
            angle=angle,
            normal=normal,
            shift=shift,
            zero_offset=zero,
            reversed=bool(reading.directions[i] < 0),
            limits=_limits_apart(reading.directions[i] * (theirs - zero), a.limits[i]),
            axis_differs=bool(reading.moved[i]),
            zero_differs=bool(reading.offset[i]),
            **following._asdict(),
            effect=effects[i],
            limit_numbers=_limits_apart(theirs, a.limits[i]),
        )


def _apart(
    w: Array,
    u: Array,
    gap: Array | None,
    tol: Tolerances,
) -> tuple[float, float | None, float | None]:
    """Angle (rad), common normal and distance at a place (m) of two axes, `gap` between their
    places; of axes without a place the angle alone.
    """
    angle = math.atan2(sine(w, u), float(w @ u))
    if gap is None:
        return angle, None, None
    shift = distance_to_line(gap, u)
    if angle <= tol.rotation:
        return angle, shift, shift
    return angle, normal_length(w, u, gap), shift


def _limits_apart(theirs: Array, ours: Array) -> tuple[float, float]:
    """Lower and upper limit of b, in either order, less a's."""
    pairs = zip(np.sort(theirs), ours, strict=True)
    # Infinite less infinite is no difference.
    low, high = (0.0 if p == q else float(p - q) for p, q in pairs)
    return low, high
