"""Joints that only one of two models has: those that can be dropped so that the rest agree."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations, product

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ..axes import axis_pairs
from ..axis_lines import Tolerances, prismatic
from .alignment.search import agreeing
from .locked_joints import held_positions, index_without

MOST = 2
"""So many joints are tried to be dropped; of n joints that makes n (n - 1) / 2 pairs."""


def droppable(
    a: Chain,
    b: Chain,
    tol: Tolerances,
) -> tuple[tuple[int, ...], Array] | None:
    """The joints of the longer of two chains at rest without which both agree, and the positions at
    which they are then held.

    Of several choices the one that leaves least to align. None where there are none. Of more than
    `MOST` joints those at the ends alone are tried, as base and tool of another length leave them.
    """
    short, long = sorted((a, b), key=lambda chain: len(chain.screws))
    more = len(long.screws) - len(short.screws)
    fitting = []
    for ks in _choices(len(long.screws), more):
        held_at = _positions(long, short, ks, tol)
        if more > MOST:
            held_at = iter([(0.0,) * more])
        for held in held_at:
            rest = without(long, ks, held)
            if not _may_agree(rest, short, tol):
                continue
            reading = agreeing(rest, short, tol)
            if reading is not None:
                *changes, near = reading.cost
                # Of choices that fit exactly, as parallel joints leave, the first one, and not
                # rounding's.
                fitting.append((changes, round(near, 3), ks, held))
    if not fitting:
        return None
    *_, ks, held = min(fitting)
    return ks, np.array(held)


def _choices(n: int, more: int) -> Iterator[tuple[int, ...]]:
    """The joints of n that may be dropped, so many at once."""
    if more <= MOST:
        yield from combinations(range(n), more)
        return
    for front in range(more, -1, -1):
        behind = range(n - (more - front), n)
        yield (*range(front), *behind)


def without(
    chain: Chain,
    ks: tuple[int, ...],
    held: Sequence[float] | Array,
) -> Chain:
    """The chain with some joints held at these positions."""
    q = np.zeros(chain.dof)
    q[list(ks)] = held
    if q.any():
        chain = chain.rezeroed(q)
    names = tuple(name for k, name in enumerate(chain.joint_names) if k not in ks)
    return Chain.from_space(
        np.delete(chain.screws, ks, 0),
        chain.home,
        joint_names=names,
        limits=np.delete(chain.limits, ks, 0),
        base=chain.base,
        tip=chain.tip,
        pitches=np.delete(chain.pitches, ks),
    )


def _positions(
    long: Chain,
    short: Chain,
    ks: tuple[int, ...],
    tol: Tolerances,
) -> Iterator[tuple[float, ...]]:
    """Positions at which joints ks may be held: all 0, and those that make the axes on both sides
    lie as in the other chain.
    """
    zero = (0.0,) * len(ks)
    yield zero
    runs: list[tuple[int, ...]] = [ks]
    if ks[-1] - ks[0] != len(ks) - 1:
        runs = [(k,) for k in ks]
    # End joints are held anywhere, as base and tool are free.
    last = len(long.screws) - 1
    inner = [run[0] > 0 and run[-1] < last for run in runs]
    across = tuple(index_without(ks, run[0] - 1) for run in runs)
    if any(inner) and _may_agree(
        without(long, ks, zero),
        short,
        tol,
        across,
    ):
        tried: list[list[tuple[float, ...]]] = []
        for run, free in zip(runs, inner, strict=True):
            tried.append([(0.0,) * len(run)])
            if free:
                tried[-1] += held_positions(long, short, run, ks, tol)
        for parts in product(*tried):
            held = sum(parts, ())
            if held != zero:
                yield held


def _may_agree(
    a: Chain,
    b: Chain,
    tol: Tolerances,
    but: tuple[int, ...] = (),
) -> bool:
    """Whether neighbouring axes of two chains, and those on both sides of a slide, lie to each
    other alike.

    No alignment changes that, so the search for one, which takes long, need not begin where they do
    not. Pairs of neighbours `but`, by their first axis, are left out.

    Axes within tolerance of the other model's change their angle by two tolerances at most; four
    are let pass.
    """
    if a.kinds != b.kinds:
        return False
    lever = max(a.reach, b.reach) * tol.rotation
    turning = np.flatnonzero(~prismatic(a)).tolist()
    for p, q in zip(axis_pairs(a, tol), axis_pairs(b, tol), strict=True):
        between = range(p.first, p.second - 1)
        if p.first - 1 in but or not {*but, *turning}.isdisjoint(between):
            continue
        if abs(p.angle - q.angle) > 4 * tol.rotation:
            return False
        # A slide moves the axes beyond it.
        if p.fixed and p.distance is not None and q.distance is not None:
            # The common normal of axes near parallel flies about with their angle, unless they
            # count as parallel.
            sine = math.sin(p.angle)
            certain = 0.0
            if p.parallel and q.parallel:
                certain = 1.0
            elif sine >= 0.1:
                certain = sine
            if abs(p.distance - q.distance) * certain > 4 * (tol.position + lever):
                return False
    return True
