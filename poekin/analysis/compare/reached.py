"""Whether two arms whose axes agree under an alignment reach the same poses, each within its own
limits.
"""

from __future__ import annotations

import numpy as np

from ...groups import so3
from ...groups.arrays import Array
from ...groups.vectors import norms, rotation_part, translation_part
from ...model.chain import Chain
from ...model.sampling import sampling_range
from ..axis_lines import Tolerances
from .alignment.hypotheses import Hypothesis
from .alignment.lines import Sides

SAMPLES = 8
ONE_ARM = 0.03
"""Pose errors up to this share of the reach and of half a turn, added up, are those of one arm, not of
two.
"""


def poses_agree(
    pair: Sides,
    a: Chain,
    b: Chain,
    reading: Hypothesis,
) -> bool:
    """Whether f_a(x) = base f_b(directions x + zeros) tool as nearly as axes within tolerance let
    it be.

    Looked at within the limits of a and within those of b: a slide's zero position far outside of
    both would make up for an axis that is elsewhere, by the angle within tolerance between the
    slide and the axes.

    A joint turned about an axis that is off by tol_rad and by tol_m at its place moves what is L
    away from there by at most 2 (tol_m + tol_rad L) more or less, whatever the angle, and turns it
    by at most 2 tol_rad; a joint that slides by x moves it by at most tol_rad x, and pitches that
    are alike differ by at most tol_m a turn. Over the joints these add up.
    """
    moved, turned = _sampled(a, b, reading)
    most = _bounds(pair, a, b)
    near_enough = moved.max() <= most.position
    return bool(near_enough and turned.max() <= most.rotation)


def near(a: Chain, b: Chain, reading: Hypothesis) -> bool:
    """Whether poses under a reading differ as those of one arm do, whichever comes first."""
    moved, turned = _sampled(a, b, reading)
    reach = max(a.reach, b.reach)
    errors = moved.max() / reach + turned.max() / np.pi
    return bool(errors <= ONE_ARM)


def _sampled(a: Chain, b: Chain, reading: Hypothesis) -> tuple[Array, Array]:
    """Differences of poses under a reading, within the limits of either arm."""
    x_b = b.random(0, SAMPLES)
    theirs = reading.directions * (x_b - reading.zeros)
    x = np.concatenate([a.random(0, SAMPLES), theirs])
    return pose_differences(a.fk(x), reading.poses(b, x))


def pose_differences(ours: Array, theirs: Array) -> tuple[Array, Array]:
    """Distances (m) and angles (rad) between two rows of poses (m, 4, 4)."""
    back = rotation_part(ours).swapaxes(1, 2)
    turns = so3.log(back @ rotation_part(theirs))
    gaps = translation_part(ours) - translation_part(theirs)
    moved = norms(gaps)
    turned = norms(turns)
    return moved, turned


def _bounds(pair: Sides, a: Chain, b: Chain) -> Tolerances:
    """The largest differences of poses of arms whose axes agree within tolerance."""
    slides = pair.a.slides
    tol = pair.tol
    # The lengths from place to place are those of the links; a slide has no place, and lengthens
    # what is behind it.
    placed = pair.a.places + pair.a.centre
    places = placed[~slides]
    end = translation_part(a.home)
    steps = np.diff([*places, end], axis=0)
    lengths = norms(steps)
    ranges = (np.abs(sampling_range(chain)) for chain in (a, b))
    largest = [size.max(0) for size in ranges]
    most = np.max(largest, axis=0)
    slides_by = np.where(slides, 1.0, np.abs(a.pitches))
    travel = most * slides_by
    slid = travel.sum()
    behind = np.cumsum(lengths[::-1]) + slid
    apart = len(places) * tol.position
    moved = 2.0 * (apart + tol.rotation * behind.sum())
    moved += tol.rotation * slid
    turned_by = float(most[a.pitches != 0].sum())
    moved += tol.position * turned_by / (2.0 * np.pi)
    rounding = 1e-12 * max(a.reach, b.reach)
    turned = 1.001 * 2.0 * tol.rotation * len(places)
    return Tolerances(1.001 * moved + rounding, turned + 1e-12)
