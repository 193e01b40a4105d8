"""The reading of two models' difference that blames the fewest joints.

Each hypothesis, nothing differs, one zero offset, one axis, one joint, one link, all zero offsets, all of them and one
axis, is fitted by least squares over the axes that it holds to agree. What is then beyond tolerance is blamed; the
fewest blamed joints win, then the base and tool that stay where they are, then the fewest changes. So one bad joint is
not smeared over its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..groups import se3, so3
from ..groups.arrays import Array
from ..model.chain import Chain
from .fit import fit
from .lines import Marks, Sides, carried, carriers, misses, sides, signs
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

        One change in one joint comes first, whatever it is: base and tool that stay where they are decide, then
        a zero offset rather than a moved axis. One moved axis is likelier than two zero offsets; but where conventions
        differ they differ in many joints, and each more says little. One other link, which moves all axes behind it, is
        likelier than a moved axis that zero offsets help. Of several moved axes it counts how far they are: the few
        that agree by chance under a wild alignment prove nothing.
        """
        conventions = int((self.offset | (self.directions < 0)).sum())
        moved, changes = int(self.moved.sum()), int(self.offset.sum() + (self.directions < 0).sum())
        near = float(np.minimum(self.misses, 10.0).sum())
        if moved + changes <= 1:
            return (2.5 * (moved + changes), self.frames, moved, near)
        if self.link:
            return (5.25, self.frames, moved, near)
        weight = (0.0, 2.5, 3.5)[conventions] if conventions < 3 else 3.25 + 0.25 * conventions
        far = float((self.misses[self.moved] ** 0.25).sum()) * (1.0 if moved > 1 else 0.05)
        return (3.0 * moved + far + weight, self.frames, changes, near)


def read(pair: Sides, a: Chain, b: Chain, P: Array, z: Array) -> Reading:
    """The reading that an alignment of a's and b's axes (both at rest) stands for."""
    miss = misses(pair, P, z)
    axes = carried(pair, P, z)[1]
    base, last = _unhubbed(pair, P), _unhubbed(pair, carriers(pair, P, z)[-1])
    tool = se3.inverse(last @ b.home) @ a.home
    axes = axes.copy()
    axes[:, 3:] -= np.cross(axes[:, :3], pair.a.hub)
    s = signs(pair, axes)
    frames = sum(not still(T, pair.tol_m, pair.tol_rad) for T in (base, tool))
    return Reading(base, tool, z, s, miss > 1.0, abs(z) > pair.zero_tolerance, axes, np.minimum(miss, 1e9), frames)


def search(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> tuple[Reading, list[Reading]]:
    """The best reading of the difference of two chains at rest, and the others that blame one joint only."""
    pair = sides(a, b, tol_m, tol_rad)
    n, nothing = pair.n, np.zeros(pair.n)
    every, none = np.ones(n, bool), np.zeros(n, bool)
    poses = rigid_poses(pair)
    rigid = [(D, nothing) for _, _, D in poses]

    def readings(starts: Iterable[tuple[Array, Array]], free: Marks, used: Marks) -> list[Reading]:
        return [read(pair, a, b, *fit(pair, P, z, free, used)) for P, z in starts]

    found = [read(pair, a, b, rigid[0][0], nothing)]
    if not found[0].cost[0] and not found[0].frames:  # the same as they stand: nothing is to be aligned
        return found[0], []
    found += readings(best(pair, rigid), none, every)
    if min(found, key=_cost).cost[0] == 0:
        return min(found, key=_cost), []
    for k in range(n):
        found += readings(best(pair, rigid, 2), none, every & (np.arange(n) != k))
        if 0 < k < n - 1:
            starts = one_turn(pair, poses, k)
            alone = np.arange(n) == k
            found += readings(starts, alone, every)
            found += readings(starts[:2], alone, every & ~alone)
    found += _links(pair, a, b, [D for _, _, D in poses])
    # Where several axes differ, those that most starts agree on.
    for P, z in best(pair, rigid):
        as_it_starts = read(pair, a, b, P, z)
        if as_it_starts.moved.sum() > 1:  # one bad axis is looked for above; of three, any two can be made to agree
            found.append(as_it_starts)
        for near in (10.0, 1.0):
            agree = misses(pair, P, z) <= near
            if agree.sum() >= 3:
                found += readings([(P, z)], none, agree)
    if min(found, key=_cost).blamed.sum() > 1:
        found += _conventions(pair, a, b)
    first = min(found, key=_cost)
    return first, _others(first, found)


def _links(pair: Sides, a: Chain, b: Chain, poses: list[Array]) -> list[Reading]:
    """Readings in which one link is another: the axes before it agree under one pose, those behind under another."""
    nothing, found = np.zeros(pair.n), []
    agree = np.array([
        (misses(pair, D, nothing) <= 1.0) & (signs(pair, carried(pair, D, nothing)[1]) > 0) for D in poses
    ])  # fmt: skip
    for k in range(2, pair.n - 1):
        before, behind = agree[:, :k].all(1), agree[:, k:].all(1)
        if before.any() and behind.any():
            P, last = poses[int(before.argmax())], _unhubbed(pair, poses[int(behind.argmax())])
            reading = read(pair, a, b, P, nothing)
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
    found = []
    starts = one_by_one(pair)[:8]
    fitted = [fit(pair, P, z, inner, np.ones(n, bool)) for P, z in starts]
    for P, z in fitted:
        found.append(_simplest(pair, a, b, P, z))
    if min(found, key=_cost).moved.any():
        for P, z in [*starts[:4], *best(pair, starts + fitted, 2)]:
            for k in np.flatnonzero(pair.alike) if pair.alike.all() else np.flatnonzero(~pair.alike):
                used = np.arange(n) != k
                for held in (pair, replace(pair, hinge=int(k))):
                    trial = fit(held, P, z, inner, used)
                    if not (misses(held, *trial)[used] > 1.0).any():
                        found.append(_simplest(held, a, b, *trial))
    return found


def _simplest(pair: Sides, a: Chain, b: Chain, P: Array, z: Array) -> Reading:
    """The reading of an alignment with as many zero offsets put back to 0 as the agreeing axes allow."""
    z = np.array([x if kind == "prismatic" else np.arctan2(np.sin(x), np.cos(x)) if kind == "revolute" else x
                  for x, kind in zip(z, pair.b.kinds, strict=True)])  # fmt: skip
    agree = misses(pair, P, z) <= 1.0
    free = abs(z) > 0
    if agree.sum() >= 2:
        for k in np.argsort(abs(z)):
            if not free[k]:
                continue
            without = z.copy()
            without[k] = 0.0
            rest = free & (np.arange(pair.n) != k)
            trial = fit(pair, P, without, rest, agree)
            if not (misses(pair, *trial)[agree] > 1.0).any():
                P, z = trial
                free = rest
    return read(pair, a, b, P, z)


def still(T: Array, tol_m: float, tol_rad: float) -> bool:
    """Whether a pose is the identity within tolerance."""
    return bool(np.linalg.norm(T[:3, 3]) <= tol_m and np.linalg.norm(so3.log(T[:3, :3])) <= tol_rad)


def _cost(reading: Reading) -> tuple[float, ...]:
    return reading.cost


def _others(first: Reading, found: list[Reading]) -> list[Reading]:
    """Readings as short as the first that blame another joint, or the same one for something else; each once."""
    kept: list[Reading] = []
    if first.blamed.sum() != 1:
        return kept
    seen = {_signature(first)}
    for reading in sorted(found, key=_cost):
        changes = int(reading.moved.sum() + reading.offset.sum() + (reading.directions < 0).sum())
        if reading.blamed.sum() == 1 and changes == 1 and _signature(reading) not in seen:
            seen.add(_signature(reading))
            kept.append(reading)
    return kept


def _signature(reading: Reading) -> bytes:
    return np.stack([reading.moved, reading.offset, reading.directions < 0]).tobytes()


def _unhubbed(pair: Sides, P: Array) -> Array:
    """The pose between the arms' own bases, of the one between their hubs."""
    T = P.copy()
    T[:3, 3] += pair.a.hub - P[:3, :3] @ pair.b.hub
    return T
