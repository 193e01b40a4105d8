"""Joints that only one of two models has: those that can be dropped so that the rest agree."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

from ..model.chain import Chain
from .axes import axes
from .search import agreeing

__all__ = ["droppable", "without"]

MOST = 2
"""So many joints are tried to be dropped; of n joints that makes n (n - 1) / 2 pairs."""


def droppable(a: Chain, b: Chain, tol_mm: float, tol_deg: float) -> tuple[int, ...] | None:
    """The joints of the longer of two chains at rest without which both agree, if there are such: of several choices
    the one that leaves least to align. None where the chains differ by more than `MOST` joints.
    """
    long, short = (a, b) if len(a.screws) > len(b.screws) else (b, a)
    more = len(long.screws) - len(short.screws)
    if more > MOST:
        return None
    fitting = []
    for ks in combinations(range(len(long.screws)), more):
        rest = without(long, ks)
        if _may_agree(rest, short, tol_mm, tol_deg):
            reading = agreeing(rest, short, tol_mm / 1e3, math.radians(tol_deg))
            if reading is not None:
                fitting.append((reading.cost, ks))
    return min(fitting)[1] if fitting else None


def without(chain: Chain, ks: tuple[int, ...]) -> Chain:
    """The chain with some joints held at their zero positions."""
    names = tuple(name for k, name in enumerate(chain.joint_names) if k not in ks)
    return Chain(
        np.delete(chain.screws, ks, 0), chain.home, joint_names=names, limits=np.delete(chain.limits, ks, 0),
        base=chain.base, tip=chain.tip, pitches=np.delete(chain.pitches, ks),
    )  # fmt: skip


def _may_agree(a: Chain, b: Chain, tol_mm: float, tol_deg: float) -> bool:
    """Whether neighbouring axes of two chains lie to each other alike: no alignment changes that, so the search for
    one, which takes long, need not begin where they do not.

    Axes within tolerance of the other model's change their angle by two tolerances at most; four are let pass.
    """
    if a.kinds != b.kinds:
        return False
    ours, theirs = (
        [pair for pair in axes(chain, tol_mm=tol_mm, tol_deg=tol_deg).pairs if pair.fixed] for chain in (a, b)
    )
    lever = 1e3 * max(a.reach, b.reach) * math.radians(tol_deg)
    for p, q in zip(ours, theirs, strict=True):
        if abs(p.angle - q.angle) > 4 * tol_deg:
            return False
        # The common normal of axes near parallel flies about with their angle.
        sine = math.sin(math.radians(p.angle))
        apart = 0.0 if p.distance is None or q.distance is None or sine < 0.1 else abs(p.distance - q.distance)
        if apart * sine > 4 * (tol_mm + lever):
            return False
    return True
