"""Alignment of arms of which most axes differ: robust least squares over all of them."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
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
    wide = pair.as_they_stand.joined(starts)
    if not pair.alike.any():
        return wide[:1].tiled(2)
    for _ in range(REWEIGHTINGS):
        wide = _step(pair, wide, _medians(pair, wide))
    scales = _medians(pair, wide)
    sharp = wide
    while (scales > 1.0).any():
        scales = np.maximum(SHARPER * scales, 1.0)
        sharp = _step(pair, sharp, scales)
    agree = pair.deviations(sharp) <= 1.0
    sharp = fit(pair, sharp, False, agree)
    return best(pair, wide, 1).joined(best(pair, sharp, 1))


def _medians(pair: Sides, at: Alignments) -> Array:
    """The median deviation (m) under each alignment, or a tolerance where it is less."""
    alike = pair.deviations(at)[:, pair.alike]
    return np.maximum(np.median(alike, axis=1), 1.0)


def _step(pair: Sides, at: Alignments, scales: Array) -> Alignments:
    """The least-squares alignments of axes weighed by their deviations, on scales (m)."""
    miss = np.where(pair.alike, pair.deviations(at), 0.0)
    shares = 1.0 / np.hypot(1.0, miss / scales[:, None])
    return fit(pair, at, False, shares)
