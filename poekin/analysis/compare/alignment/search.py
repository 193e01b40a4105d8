"""The reading of two models' difference that blames the fewest joints.

Each hypothesis, nothing differs, one zero offset, one axis, one joint, one link, all zero offsets,
all of them and one axis, is fitted by least squares over the axes that it holds to agree. What is
then beyond tolerance is implicated; the fewest implicated joints win, then the base and tool that stay
where they are, then the fewest changes. So one bad joint is not smeared over its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ..reached import poses_agree
from .alignment_seeds import best, one_by_one, one_turn, rigid_poses
from .fit import fit
from .hypotheses import COSTS, Hypothesis, make_hypotheses, off_centre, still
from .lines import Marks, Sides, aligned_deviations, deviations, sides, signs, transformed


def search(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> tuple[Hypothesis, list[Hypothesis]]:
    """The best reading of the difference of two chains at rest, and the others that blame one joint
    only.
    """
    pair = sides(a, b, tol_m, tol_rad)
    n = pair.n
    alone = np.eye(n, dtype=bool)
    poses = rigid_poses(pair)
    rigid = (poses[1], np.zeros((len(poses[1]), n)))

    def rigidly(P: Array, z: Array, used: Marks) -> list[Hypothesis]:
        return make_hypotheses(pair, *fit(pair, P, z, np.zeros(n, bool), used))

    found = make_hypotheses(pair, rigid[0][:1], rigid[1][:1])
    # Alike as they stand: nothing is to be aligned.
    if not found[0].cost[0] and not found[0].frames:
        return found[0], []
    P, z = best(pair, *rigid)
    found += rigidly(P, z, np.ones(n, bool))
    first = min(found, key=_cost)
    if first.cost[0] == 0:
        return first, []
    all_but_one = ~alone.repeat(len(z[:2]), 0)
    found += rigidly(np.tile(P[:2], (n, 1, 1)), np.tile(z[:2], (n, 1)), all_but_one)
    if n > 2:
        found += _one_joint(pair, poses)
    found += _links(pair, poses[1])
    # Where several axes differ, those that most starts agree on; one bad axis is looked for above.
    found += [
        as_it_starts for as_it_starts in make_hypotheses(pair, P, z) if as_it_starts.moved.sum() > 1
    ]
    miss = aligned_deviations(pair, P, z)
    agree = np.concatenate([miss <= 10.0, miss <= 1.0])
    found += rigidly(np.tile(P, (2, 1, 1)), np.tile(z, (2, 1)), agree)
    if min(found, key=_cost).cost[0] > COSTS.one_change:
        found += _conventions(pair)
    # The reading of the models as they stand holds, and so there is one that does.
    found.sort(key=_cost)
    holding = (r for r in found if r.moved.any() or poses_agree(pair, a, b, r))
    first = next(holding)
    return _simpler(first, found), _others(first, holding)


def agreeing(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> Hypothesis | None:
    """The best reading of two chains at rest under which all axes agree, or None: `search` without
    what differs.
    """
    pair = sides(a, b, tol_m, tol_rad)
    none = np.zeros(pair.n, bool)
    every = np.ones(pair.n, bool)
    poses = rigid_poses(pair)[1]
    nothing = np.zeros((len(poses), pair.n))
    found = make_hypotheses(pair, poses[:1], nothing[:1])
    found += make_hypotheses(pair, *fit(pair, *best(pair, poses, nothing), none, every))
    if min(found, key=_cost).cost[0]:
        found += _simplest(pair, *_other_zeros(pair)[2:])
    holding = (
        r for r in sorted(found, key=_cost) if not r.moved.any() and poses_agree(pair, a, b, r)
    )
    return next(holding, None)


def _one_joint(pair: Sides, poses: tuple[NDArray[np.intp], Array]) -> list[Hypothesis]:
    """Readings in which one inner joint alone has a zero offset, its axis agreeing, or held to be
    wrong.
    """
    alone = np.eye(pair.n, dtype=bool)
    every = np.ones(pair.n, bool)
    starts = [(one_turn(pair, poses, k), alone[k]) for k in range(1, pair.n - 1)]
    # Of each joint all the starts with its axis, then the two best without it, then the two with
    # what agrees alone.
    tries = [
        (P[i], z[i], own, used)
        for (P, z), own in starts
        for most, used in ((4, every), (2, ~own))
        for i in range(len(z[:most]))
    ]
    for (P, z), own in starts:
        agree = aligned_deviations(pair, P[:2], z[:2]) <= 1.0
        tries += [(P[i], z[i], own, used) for i, used in enumerate(agree)]
    P, z, free, used = (np.array(column) for column in zip(*tries, strict=True))
    return make_hypotheses(pair, *fit(pair, P, z, free, used))


def _simpler(first: Hypothesis, found: list[Hypothesis]) -> Hypothesis:
    """The best reading, or one that blames fewer joints and leaves base and tool where they are,
    which it does not.
    """
    fewer = (
        r
        for r in found
        if not r.frames and r.moved.any() and r.implicated.sum() < first.implicated.sum()
    )
    if not first.frames or first.link:
        return first
    return next(fewer, first)


def _links(pair: Sides, poses: Array) -> list[Hypothesis]:
    """Readings in which one link is another: the axes before it agree under one pose, those behind
    under another.
    """
    nothing = np.zeros((len(poses), pair.n))
    found = []
    axes = transformed(pair, poses, nothing)[1]
    agree = (deviations(pair, axes) <= 1.0) & (signs(pair, axes) > 0)
    for k in range(2, pair.n - 1):
        before = agree[:, :k].all(1)
        behind = agree[:, k:].all(1)
        if before.any() and behind.any():
            P = poses[before][:1]
            last = off_centre(pair, poses[behind][0])
            (reading,) = make_hypotheses(pair, P, nothing[:1])
            if reading.implicated.sum() < 2:
                continue
            tool = se3.inverse(last @ pair.b.home) @ pair.a.home
            frames = sum(not still(T, pair.tol_m, pair.tol_rad) for T in (reading.base, tool))
            found.append(replace(reading, tool=tool, frames=frames, link=k))
    return found


def _conventions(pair: Sides) -> list[Hypothesis]:
    """Readings in which every zero offset is free: with no bad axis, with each one, and with those
    that then miss.
    """
    n = pair.n
    inner = _inner(pair)
    P, z, P_fitted, z_fitted = _other_zeros(pair)
    found = _simplest(pair, P_fitted, z_fitted)
    if min(found, key=_cost).moved.any():
        tried = best(pair, np.concatenate([P, P_fitted]), np.concatenate([z, z_fitted]), 2)
        P = np.concatenate([P[:4], tried[0]])
        z = np.concatenate([z[:4], tried[1]])
        suspects = pair.alike if pair.alike.all() else ~pair.alike
        for k in np.flatnonzero(suspects):
            used = np.arange(n) != k
            for held in (pair, replace(pair, suspect_joint=int(k))):
                trial = fit(held, P, z, inner, used)
                fits = ~(aligned_deviations(held, *trial)[:, used] > 1.0).any(1)
                readings = _simplest(held, trial[0][fits], trial[1][fits])
                # Zero offsets about a's axis k say nothing of b's, unless that is another one.
                found += [
                    reading for reading in readings if held.suspect_joint < 0 or reading.moved[k]
                ]
    return found


def _inner(pair: Sides) -> Marks:
    """The joints (n,) whose zero offsets are no turn of the base or the tool."""
    return (np.arange(pair.n) > 0) & (np.arange(pair.n) < pair.n - 1)


def _other_zeros(pair: Sides) -> tuple[Array, Array, Array, Array]:
    """Alignments (P, z) with zero offsets found joint after joint, and the same fitted to all axes
    with them free.
    """
    P, z = (rows[:8] for rows in one_by_one(pair))
    return P, z, *fit(pair, P, z, _inner(pair), np.ones(pair.n, bool))


def _simplest(pair: Sides, P: Array, z: Array) -> list[Hypothesis]:
    """The readings of alignments with as many zero offsets put back to 0, least first, as the
    agreeing axes allow.
    """
    kinds = np.array(pair.b.kinds)
    z = np.where(kinds == "revolute", np.arctan2(np.sin(z), np.cos(z)), z)
    P = P.copy()
    agree = aligned_deviations(pair, P, z) <= 1.0
    free = abs(z) > 0
    for ks in np.argsort(abs(z), axis=1).T:
        (row,) = np.nonzero(free[np.arange(len(z)), ks])
        k = ks[row]
        rest = free[row]
        without = z[row]
        rest[np.arange(len(row)), k] = False
        without[np.arange(len(row)), k] = 0.0
        trial = fit(pair, P[row], without, rest, agree[row])
        fits = ~((aligned_deviations(pair, *trial) > 1.0) & agree[row]).any(1)
        P[row[fits]] = trial[0][fits]
        z[row[fits]] = trial[1][fits]
        free[row[fits]] = rest[fits]
    return make_hypotheses(pair, P, z)


def _cost(reading: Hypothesis) -> tuple[float, ...]:
    return reading.cost


def _others(first: Hypothesis, behind: Iterable[Hypothesis]) -> list[Hypothesis]:
    """The readings behind the first that are as short and blame another joint, or it for something
    else; each once.
    """
    kept: list[Hypothesis] = []
    if first.implicated.sum() != 1:
        return kept
    seen = {first.changes.tobytes()}
    for reading in behind:
        signature = reading.changes.tobytes()
        if reading.changes.sum() == 1 and signature not in seen:
            seen.add(signature)
            kept.append(reading)
    return kept
