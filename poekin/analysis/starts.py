"""Where an alignment may start: poses that bring two of b's axes onto a's, and turns that bring one more."""

from __future__ import annotations

from itertools import product

import numpy as np

from ..groups import se3
from ..groups.arrays import Array
from .lines import Sides, cross, direction, misses

# An axis within about a degree of parallel counts as parallel, as the common normal flies about there.
PARALLEL = 0.02
BEAM = 24


def pair_poses(pair: Sides, i: int, j: int) -> list[Array]:
    """Poses D (4, 4) that carry b's axes i and j to a's, one for each way round that the axes can be taken.

    Two axes that are not parallel fix D up to that; parallel ones leave a slide along them, which stays near the hubs.
    Empty where the pairs differ by more than about a degree.
    """
    ours = _frame(pair, pair.a.axes, pair.a.kinds, i, j, 1.0, 1.0)
    if ours is None:
        return []
    poses = []
    for s, t in product((1.0, -1.0), repeat=2):
        theirs = _frame(pair, pair.b.axes, pair.b.kinds, i, j, s, t)
        if theirs is not None and abs(theirs[1] - ours[1]) < 2 * PARALLEL:
            poses.append(ours[0] @ se3.inverse(theirs[0]))
    return poses


def rigid_poses(pair: Sides) -> list[tuple[int, int, Array]]:
    """(i, j, D) of all pairs of joints of the same kinds, and the base as it is."""
    as_it_is = np.eye(4)
    as_it_is[:3, 3] = pair.b.hub - pair.a.hub
    found = [(-1, -1, as_it_is)]
    for i in range(pair.n):
        for j in range(i + 1, pair.n):
            if pair.alike[i] and pair.alike[j]:
                found += [(i, j, D) for D in pair_poses(pair, i, j)]
    return found


def turns(screw: Array, axis: Array, target: Array) -> list[float]:
    """Motions z of a joint (its screw (6,)) that bring an axis (6,) nearest to a target; [0] where none is better."""
    w, p = screw[:3], cross(screw[:3], screw[3:])
    slides_axis, slides_target = not axis[:3].any(), not target[:3].any()
    d = axis[3:] if slides_axis else axis[:3]
    e = target[3:] if slides_target else target[:3]
    gap = cross(target[:3], target[3:]) - cross(axis[:3], axis[3:])
    if not w.any():
        slide = screw[3:] - d * (d @ screw[3:])
        if slides_axis or slides_target or slide @ slide < PARALLEL**2:
            return [0.0]
        return [float(slide @ gap / (slide @ slide))]
    u, v = d - w * (w @ d), e - w * (w @ e)
    if min(u @ u, v @ v) > PARALLEL**2:
        z = float(np.arctan2(w @ cross(u, v), u @ v))
        return [z, z - np.pi if z > 0 else z + np.pi]
    if slides_axis or slides_target:
        return [0.0]
    u, v = cross(axis[:3], axis[3:]) - p, cross(target[:3], target[3:]) - p
    u, v = u - w * (w @ u), v - w * (w @ v)
    if min(u @ u, v @ v) < 1e-8:
        return [0.0]
    return [float(np.arctan2(w @ cross(u, v), u @ v))]


def one_turn(pair: Sides, rigid: list[tuple[int, int, Array]], k: int) -> list[tuple[Array, Array]]:
    """Alignments (P, z) in which joint k alone has a zero offset, best first, from the `rigid_poses` of both."""
    found = []
    for i, j, D in rigid:
        if i < 0 or j <= k:  # D is the base's pose; the next axis behind k that is not k's own line tells the offset
            others, back = range(k + 1, pair.n), False
        elif i >= k:  # D stands behind joint k
            others, back = range(k), True
        else:
            continue
        T, axes = se3.adjoint(D) @ pair.b.screws[k], pair.b.axes @ se3.adjoint(D).T
        for other in others:
            for turn in turns(T, axes[other], pair.a.axes[other]):
                z = np.zeros(pair.n)
                z[k] = -turn if back else turn
                found.append((D @ se3.exp(pair.b.screws[k] * turn) if back else D, z))
            if len(found) > 600:
                break
    return best(pair, found)


def one_by_one(pair: Sides) -> list[tuple[Array, Array]]:
    """Alignments (P, z) found joint after joint, each zero offset bringing the next axis into its place; best first."""
    starts = pair_poses(pair, 0, 1) if pair.n > 1 else []
    rows = [(D, D, np.zeros(pair.n), 0.0) for D in starts or [D for _, _, D in rigid_poses(pair)]]
    for k in range(1, pair.n - 1):
        grown = []
        for P, D, z, loss in rows:
            T, axis = se3.adjoint(D) @ pair.b.screws[k], pair.b.axes[k + 1]
            for turn in {0.0, *turns(T, se3.adjoint(D) @ axis, pair.a.axes[k + 1])}:
                moved, after = z.copy(), D @ se3.exp(pair.b.screws[k] * turn)
                moved[k] = turn
                miss = misses(pair, P, moved)[k + 1]
                grown.append((P, after, moved, loss + min(miss, 1e4) ** 0.5 + (abs(turn) > pair.zero_tolerance[k])))
        rows = sorted(grown, key=lambda row: row[3])[:BEAM]
    return [(P, z) for P, _, z, _ in rows]


def best(pair: Sides, alignments: list[tuple[Array, Array]], most: int = 4) -> list[tuple[Array, Array]]:
    """The alignments under which most axes agree best: a far miss counts little more than a near one."""
    loss = [
        float(np.log1p(np.minimum(misses(pair, P, z), 1e6)).sum() + 0.01 * (abs(z) > 0).sum()) for P, z in alignments
    ]
    return [alignments[i] for i in np.argsort(loss, kind="stable")[:most]]


def _frame(
    pair: Sides, axes: Array, kinds: tuple[str, ...], i: int, j: int, s: float, t: float
) -> tuple[Array, float] | None:
    """The frame of two axes, taken s and t times their way: z along i, x along the common normal; their cosine."""
    ways = direction(axes, kinds)
    z, other = s * ways[i], t * ways[j]
    x = cross(z, other)
    places = [None if kinds[k] == "prismatic" else cross(axes[k, :3], axes[k, 3:]) for k in (i, j)]
    p, r = places
    origin = p if p is not None else np.zeros(3)
    if np.linalg.norm(x) > PARALLEL:
        if p is not None and r is not None:
            # p + z h is the foot of the common normal: the gap's part across the normal and axis j vanishes.
            side = cross(x, other)
            origin = p + z * (side @ (r - p)) / (side @ z)
        elif r is not None:
            origin = r
    elif p is not None and r is not None and s == t * np.sign(ways[i] @ ways[j]) and np.linalg.norm(r - p) > 1e-5:
        x = r - p - z * (z @ (r - p))
    else:
        return None
    x = x - z * (z @ x)
    if np.linalg.norm(x) < 1e-6:
        return None
    x = x / np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, cross(z, x), z], axis=1)
    frame[:3, 3] = origin
    return frame, float(z @ other)
