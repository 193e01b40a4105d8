"""Joints that only one of two models has: those that can be dropped so that the rest agree."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations, product

import numpy as np

from ..groups import se3
from ..groups.arrays import Array
from ..model.chain import Chain
from .axes import axes
from .lines import direction
from .search import agreeing

__all__ = ["droppable", "without"]

MOST = 2
"""So many joints are tried to be dropped; of n joints that makes n (n - 1) / 2 pairs."""
LEAST = 1e-6
"""An angle's cosine or a mutual moment (m) that changes by less tells no position."""


def droppable(a: Chain, b: Chain, tol_mm: float, tol_deg: float) -> tuple[tuple[int, ...], Array] | None:
    """The joints of the longer of two chains at rest without which both agree, and the positions at which they are
    then held: of several choices the one that leaves least to align. None where there are none, or where the chains
    differ by more than `MOST` joints.
    """
    long, short = (a, b) if len(a.screws) > len(b.screws) else (b, a)
    more = len(long.screws) - len(short.screws)
    if more > MOST:
        return None
    fitting = []
    for ks in combinations(range(len(long.screws)), more):
        for held in _positions(long, short, ks, tol_mm, tol_deg):
            rest = without(long, ks, held)
            if _may_agree(rest, short, tol_mm, tol_deg):
                reading = agreeing(rest, short, tol_mm / 1e3, math.radians(tol_deg))
                if reading is not None:
                    fitting.append((reading.cost, ks, held))
    if not fitting:
        return None
    _, ks, held = min(fitting)
    return ks, np.array(held)


def without(chain: Chain, ks: tuple[int, ...], held: Sequence[float] | Array) -> Chain:
    """The chain with some joints held at these positions."""
    q = np.zeros(chain.dof)
    q[list(ks)] = held
    chain = chain.rezeroed(q) if q.any() else chain
    names = tuple(name for k, name in enumerate(chain.joint_names) if k not in ks)
    return Chain(
        np.delete(chain.screws, ks, 0), chain.home, joint_names=names, limits=np.delete(chain.limits, ks, 0),
        base=chain.base, tip=chain.tip, pitches=np.delete(chain.pitches, ks),
    )  # fmt: skip


def _positions(
    long: Chain, short: Chain, ks: tuple[int, ...], tol_mm: float, tol_deg: float
) -> Iterator[tuple[float, ...]]:
    """Positions at which joints ks may be held: all at 0, and those at which the axes before and behind each of them
    lie to each other as in the other chain.
    """
    zero = (0.0,) * len(ks)
    yield zero
    # An end joint is held anywhere, as base and tool are free; between neighbours that both go, 0 alone is tried.
    inner = [0 < k < len(long.screws) - 1 and k - 1 not in ks and k + 1 not in ks for k in ks]
    across = tuple(k - m - 1 for m, k in enumerate(ks))
    if any(inner) and _may_agree(without(long, ks, zero), short, tol_mm, tol_deg, across):
        tried = [
            [0.0, *_held(long, short, k, i)] if free else [0.0] for k, i, free in zip(ks, across, inner, strict=True)
        ]
        yield from (held for held in product(*tried) if held != zero)


def _held(long: Chain, short: Chain, k: int, i: int) -> list[float]:
    """Positions of joint k at which the axes on both sides of it make the angle of axes i and i + 1 of the other chain,
    or, where no position of it changes their angle, have their mutual moment.

    Both are A + B cos x + C sin x of a joint that turns, and A + B x of one that slides.
    """
    slides = long.kinds[k] == "prismatic"
    sample = [0.0, 1.0] if slides else [0.0, math.pi / 2, math.pi]
    before, behind, S = long.screws[k - 1], long.screws[k + 1], long.screws[k]
    moved = [se3.adjoint(se3.exp(S * x)) @ behind for x in sample]
    ends = np.stack([before, *moved]), (long.kinds[k - 1], *[long.kinds[k + 1]] * len(sample))
    goal = direction(short.screws[i : i + 2], short.kinds[i : i + 2])
    ways = direction(*ends)
    invariants = [(ways[1:] @ ways[0], float(goal[0] @ goal[1]))]
    neighbours = (long.kinds[k - 1], long.kinds[k + 1], *short.kinds[i : i + 2])
    if set(neighbours) == {"revolute"} and long.kinds[k] != "helical":
        p, q = short.screws[i], short.screws[i + 1]
        moments = [before[:3] @ T[3:] + before[3:] @ T[:3] for T in moved]
        invariants.append((np.array(moments), float(p[:3] @ q[3:] + p[3:] @ q[:3])))
    for values, wanted in invariants:
        A = values[0] if slides else (values[0] + values[2]) / 2
        B, C = (values[1] - A, 0.0) if slides else ((values[0] - values[2]) / 2, values[1] - A)
        size = math.hypot(B, C)
        if size > LEAST:
            parts = [(sign * wanted - A) / size for sign in (1.0, -1.0)]
            if slides:
                return [part * math.copysign(1.0, B) for part in parts]
            turns = [math.acos(max(-1.0, min(1.0, part))) for part in parts if abs(part) < 1 + LEAST]
            top = math.atan2(C, B)
            return [x for turn in turns for x in (top + turn, top - turn)]
    return []


def _may_agree(a: Chain, b: Chain, tol_mm: float, tol_deg: float, but: tuple[int, ...] = ()) -> bool:
    """Whether neighbouring axes of two chains lie to each other alike: no alignment changes that, so the search for
    one, which takes long, need not begin where they do not. Pairs `but`, by their first axis, are left out.

    Axes within tolerance of the other model's change their angle by two tolerances at most; four are let pass.
    """
    if a.kinds != b.kinds:
        return False
    ours, theirs = (
        [pair for pair in axes(chain, tol_mm=tol_mm, tol_deg=tol_deg).pairs if pair.fixed] for chain in (a, b)
    )
    lever = 1e3 * max(a.reach, b.reach) * math.radians(tol_deg)
    for i, (p, q) in enumerate(zip(ours, theirs, strict=True)):
        if i in but:
            continue
        if abs(p.angle - q.angle) > 4 * tol_deg:
            return False
        # The common normal of axes near parallel flies about with their angle.
        sine = math.sin(math.radians(p.angle))
        apart = 0.0 if p.distance is None or q.distance is None or sine < 0.1 else abs(p.distance - q.distance)
        if apart * sine > 4 * (tol_mm + lever):
            return False
    return True
