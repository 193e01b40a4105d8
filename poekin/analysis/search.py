"""The reading of two models' difference that blames the fewest joints.

Each hypothesis, nothing differs, one zero offset, one axis, one joint, one link, all zero offsets, all of them and one
axis, is fitted by least squares over the axes that it holds to agree. What is then beyond tolerance is blamed; the
fewest blamed joints win, then the base and tool that stay where they are, then the fewest changes. So one bad joint is
not smeared over its neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..groups import se3, so3
from ..groups.arrays import Array
from ..model.chain import Chain
from .fit import fit
from .lines import Marks, Sides, carried, carriers, cross, misses, sides, signs
from .starts import best, one_by_one, one_turn, rigid_poses


@dataclass(frozen=True, eq=False)
class Reading:
    """One way to read the difference: f_a(x) = base f_b(direction x + zeros) tool, but for the axes that moved.

    Attributes: base (4, 4), b's base in a's; tool (4, 4), a's tool in b's; zeros (n), rad or m, where b stands when a
    is at 0; directions (n), +1 or -1; moved (n, bool), axes beyond tolerance; offset (n, bool), zeros beyond it;
    axes (n, 6), b's screws without pitch as they then stand in a's base; misses (n), of each, in tolerances;
    frames, how many of base and tool moved; link, k > 0 where the axes behind joint k moved together, by a link that is
    another one: then the tool is the one behind them.
    """

    base: Array
    tool: Array
    zeros: Array
    directions: Array
    moved: Marks
    offset: Marks
    axes: Array
    misses: Array
    frames: int
    link: int = 0

    @property
    def blamed(self) -> Marks:
        """Joints (n, bool) that differ in anything."""
        return self.moved | self.offset | (self.directions < 0)

    @property
    def cost(self) -> tuple[float, ...]:
        """What makes one reading better than another: the smaller, the better.

        One change in one joint comes first, whatever it is: base and tool that stay where they are decide, then a zero
        offset rather than a moved axis. One moved axis is likelier than two zero offsets; but where conventions differ
        they differ in many joints, and each more says little: where base and tool both moved, other zeros and
        directions alone come before one moved axis. One other link, which moves all axes behind it, is likelier than a
        moved axis that zero offsets help. Of several moved axes it counts how far they are: the few that agree by
        chance under a wild alignment prove nothing.
        """
        conventions = int((self.offset | (self.directions < 0)).sum())
        moved, changes = int(self.moved.sum()), int(self.offset.sum() + (self.directions < 0).sum())
        near = float(np.minimum(self.misses, 10.0).sum())
        if moved + changes <= 1:
            alone = 4.9 if moved and self.frames == 2 else 2.5 * (moved + changes)
            return (alone, self.frames, moved, near)
        if self.link:
            return (5.25, self.frames, moved, near)
        weight = (0.0, 2.5, 3.5)[conventions] if conventions < 3 else 3.25 + 0.25 * conventions
        far = float((self.misses[self.moved] ** 0.25).sum()) * (1.0 if moved > 1 else 0.05)
        return (3.0 * moved + far + weight, self.frames, changes, near)


def read(pair: Sides, a: Chain, b: Chain, P: Array, z: Array) -> list[Reading]:
    """The readings that alignments (P, z) of a's and b's axes (both at rest), (m, 4, 4) and (m, n), stand for."""
    axes = carried(pair, P, z)[1]
    miss, s = misses(pair, axes), signs(pair, axes)
    base, last = _unhubbed(pair, P), _unhubbed(pair, carriers(pair, P, z)[:, -1])
    tool = se3.inverse(last @ b.home) @ a.home
    axes[..., 3:] -= cross(axes[..., :3], pair.a.hub)
    frames = (~still(np.stack([base, tool]), pair.tol_m, pair.tol_rad)).sum(0)
    moved, offset, far = miss > 1.0, abs(z) > pair.zero_tolerance, np.minimum(miss, 1e9)
    return [
        Reading(base[i], tool[i], z[i], s[i], moved[i], offset[i], axes[i], far[i], int(frames[i]))
        for i in range(len(z))
    ]


def search(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> tuple[Reading, list[Reading]]:
    """The best reading of the difference of two chains at rest, and the others that blame one joint only."""
    pair = sides(a, b, tol_m, tol_rad)
    n, alone = pair.n, np.eye(pair.n, dtype=bool)
    every, none = np.ones(n, bool), np.zeros(n, bool)
    poses = rigid_poses(pair)
    rigid = poses[1], np.zeros((len(poses[1]), n))

    def readings(P: Array, z: Array, free: Marks, used: Marks) -> list[Reading]:
        return read(pair, a, b, *fit(pair, P, z, free, used))

    found = read(pair, a, b, rigid[0][:1], rigid[1][:1])
    if not found[0].cost[0] and not found[0].frames:  # the same as they stand: nothing is to be aligned
        return found[0], []
    P, z = best(pair, *rigid)
    found += readings(P, z, none, every)
    first = min(found, key=_cost)
    if first.cost[0] == 0:
        return first, []
    two = len(z[:2])
    found += readings(np.tile(P[:2], (n, 1, 1)), np.tile(z[:2], (n, 1)), none, ~alone.repeat(two, 0))
    if n > 2:
        found += _one_joint(pair, a, b, poses)
    found += _links(pair, a, b, poses[1])
    # Where several axes differ, those that most starts agree on; one bad axis is looked for above.
    found += [as_it_starts for as_it_starts in read(pair, a, b, P, z) if as_it_starts.moved.sum() > 1]
    miss = misses(pair, carried(pair, P, z)[1])
    agree = np.concatenate([miss <= 10.0, miss <= 1.0])
    enough = agree.sum(1) >= 3  # of three, any two can be made to agree
    found += readings(np.tile(P, (2, 1, 1))[enough], np.tile(z, (2, 1))[enough], none, agree[enough])
    first = min(found, key=_cost)
    if first.blamed.sum() > 1:
        found += _conventions(pair, a, b)
        first = min(found, key=_cost)
    return first, _others(first, found)


def _one_joint(pair: Sides, a: Chain, b: Chain, poses: tuple[NDArray[np.intp], Array]) -> list[Reading]:
    """Readings in which one inner joint alone has a zero offset, its axis agreeing, or held to be wrong."""
    alone = np.eye(pair.n, dtype=bool)
    starts = [(one_turn(pair, poses, k), alone[k]) for k in range(1, pair.n - 1)]
    # Of each joint all the starts with its axis, then the two best without it.
    tries = [(P[i], z[i], own, used) for (P, z), own in starts for most, used in ((4, own | True), (2, ~own))
             for i in range(len(z[:most]))]  # fmt: skip
    P, z, free, used = (np.array(column) for column in zip(*tries, strict=True))
    return read(pair, a, b, *fit(pair, P, z, free, used))


def _links(pair: Sides, a: Chain, b: Chain, poses: Array) -> list[Reading]:
    """Readings in which one link is another: the axes before it agree under one pose, those behind under another."""
    nothing, found = np.zeros((len(poses), pair.n)), []
    axes = carried(pair, poses, nothing)[1]
    agree = (misses(pair, axes) <= 1.0) & (signs(pair, axes) > 0)
    for k in range(2, pair.n - 1):
        before, behind = agree[:, :k].all(1), agree[:, k:].all(1)
        if before.any() and behind.any():
            P, last = poses[before][:1], _unhubbed(pair, poses[behind][0])
            (reading,) = read(pair, a, b, P, nothing[:1])
            if reading.blamed.sum() < 2:
                continue
            tool = se3.inverse(last @ b.home) @ a.home
            frames = sum(not still(T, pair.tol_m, pair.tol_rad) for T in (reading.base, tool))
            found.append(replace(reading, tool=tool, frames=frames, link=k))
    return found


def _conventions(pair: Sides, a: Chain, b: Chain) -> list[Reading]:
    """Readings in which every zero offset is free: with no bad axis, with each one, and with those that then miss."""
    n = pair.n
    inner = (np.arange(n) > 0) & (np.arange(n) < n - 1)
    P, z = (rows[:8] for rows in one_by_one(pair))
    fitted = fit(pair, P, z, inner, np.ones(n, bool))
    found = _simplest(pair, a, b, *fitted)
    if min(found, key=_cost).moved.any():
        tried = best(pair, np.concatenate([P, fitted[0]]), np.concatenate([z, fitted[1]]), 2)
        P, z = np.concatenate([P[:4], tried[0]]), np.concatenate([z[:4], tried[1]])
        for k in np.flatnonzero(pair.alike) if pair.alike.all() else np.flatnonzero(~pair.alike):
            used = np.arange(n) != k
            for held in (pair, replace(pair, hinge=int(k))):
                trial = fit(held, P, z, inner, used)
                fits = ~(misses(held, carried(held, *trial)[1])[:, used] > 1.0).any(1)
                found += _simplest(held, a, b, trial[0][fits], trial[1][fits])
    return found


def _simplest(pair: Sides, a: Chain, b: Chain, P: Array, z: Array) -> list[Reading]:
    """The readings of alignments with as many zero offsets put back to 0, least first, as the agreeing axes allow."""
    kinds = np.array(pair.b.kinds)
    z = np.where(kinds == "revolute", np.arctan2(np.sin(z), np.cos(z)), z)
    P = P.copy()
    agree = misses(pair, carried(pair, P, z)[1]) <= 1.0
    free, rows = abs(z) > 0, np.flatnonzero(agree.sum(1) >= 2)
    for ks in np.argsort(abs(z[rows]), axis=1).T:
        now = free[rows, ks]
        row, k = rows[now], ks[now]
        rest, without = free[row], z[row]
        rest[np.arange(len(row)), k], without[np.arange(len(row)), k] = False, 0.0
        trial = fit(pair, P[row], without, rest, agree[row])
        fits = ~((misses(pair, carried(pair, *trial)[1]) > 1.0) & agree[row]).any(1)
        P[row[fits]], z[row[fits]], free[row[fits]] = trial[0][fits], trial[1][fits], rest[fits]
    return read(pair, a, b, P, z)


def still(T: Array, tol_m: float, tol_rad: float) -> Marks:
    """Whether poses (..., 4, 4) are the identity within tolerance (...)."""
    moved, turned = np.linalg.norm(T[..., :3, 3], axis=-1), np.linalg.norm(so3.log(T[..., :3, :3]), axis=-1)
    return (moved <= tol_m) & (turned <= tol_rad)


def _cost(reading: Reading) -> tuple[float, ...]:
    return reading.cost


def _others(first: Reading, found: list[Reading]) -> list[Reading]:
    """Readings as short as the first that blame another joint, or the same one for something else; each once."""
    kept: list[Reading] = []
    if first.blamed.sum() != 1:
        return kept
    seen = {_signature(first)}
    single = [r for r in found if r.moved.sum() + r.offset.sum() + (r.directions < 0).sum() == 1]
    for reading in sorted(single, key=_cost):
        if _signature(reading) not in seen:
            seen.add(_signature(reading))
            kept.append(reading)
    return kept


def _signature(reading: Reading) -> bytes:
    return np.stack([reading.moved, reading.offset, reading.directions < 0]).tobytes()


def _unhubbed(pair: Sides, P: Array) -> Array:
    """The poses (..., 4, 4) between the arms' own bases, of those between their hubs."""
    T = P.copy()
    T[..., :3, 3] += pair.a.hub - P[..., :3, :3] @ pair.b.hub
    return T
