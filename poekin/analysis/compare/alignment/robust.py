"""Alignment of arms of which most axes differ: robust least squares over all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .alignment_seeds import best, rigid_poses
from .alignments import Alignments
from .fit import fit
from .lines import Sides

REWEIGHTINGS = 12
STARTS = 3
SHARPER = 0.3
"""Factor by which the scale of the loss falls with each step, from the median to a tolerance."""


def robust_alignments(pair: Sides) -> Alignments:
    """Two poses of b's base that bring all its axes near to a's, zeros as they are.

    Iteratively reweighted least squares of the deviations d with Cauchy's loss ln(1 + (d / s)²):
    an axis far off counts little, and none is left out. First with s their median (Holland and
    Welsch 1977), then with s that falls to a tolerance, so that axes that agree exactly come to
    count most (graduated non-convexity, Blake and Zisserman 1987).
    """
    starts = best(pair, rigid_poses(pair).at, STARTS)
    found = pair.as_they_stand.joined(starts)
    wide = [_reweighted(pair, found[[k]]) for k in range(len(found))]
    sharp = [_sharpened(pair, at) for at in wide]
    one = best(pair, wide[0].joined(*wide[1:]), 1)
    other = best(pair, sharp[0].joined(*sharp[1:]), 1)
    return one.joined(other)


def _reweighted(pair: Sides, at: Alignments) -> Alignments:
    for _ in range(REWEIGHTINGS):
        at = _step(pair, at, _median(pair, at))
    return at


def _sharpened(pair: Sides, at: Alignments) -> Alignments:
    scale = _median(pair, at)
    while scale > 1.0:
        scale = max(SHARPER * scale, 1.0)
        at = _step(pair, at, scale)
    agree = pair.deviations(at) <= 1.0
    return fit(pair, at, False, agree)


def _median(pair: Sides, at: Alignments) -> float:
    alike = pair.deviations(at)[0, pair.alike]
    if not len(alike):
        return 1.0
    return max(float(np.median(alike)), 1.0)


def _step(pair: Sides, at: Alignments, scale: float) -> Alignments:
    """The least-squares alignment of axes weighed by their deviations."""
    (miss,) = pair.deviations(at)
    share = 1.0 / np.hypot(1.0, np.where(pair.alike, miss, 0.0) / scale)
    weighed = replace(pair, weights=share[:, None, None] * pair.weights)
    return fit(weighed, at, False, True)
