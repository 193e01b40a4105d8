"""Starts of an alignment: poses that bring two of b's axes onto a's, and turns that bring one more.

Alignments come as arrays, P (m, 4, 4) and z (m, n), all of them weighed at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from ....groups import se3
from ....groups.arrays import Array
from ...axis_lines import cross
from .lines import Lines, Sides, aligned_deviations, deviations, signs, transformed

# An axis within about a degree of parallel counts as parallel, as the common normal flies about
# there.
PARALLEL = 0.02
BEAM = 24
MOST = 600
"""Beyond so many alignments, each pose is tried with one turn only."""


def pair_poses(pair: Sides, joints: Iterable[tuple[int, int]]) -> tuple[NDArray[np.intp], Array]:
    """Pairs i < j of joints (m, 2), of those asked for, and poses D (m, 4, 4) carrying b's two axes
    to a's.

    There is a pose for each way round that the axes can be taken.
    Two axes that are not parallel fix D up to that; parallel ones leave a slide along them, which
    stays near the centres. There is none where the pairs differ by more than about a degree.
    """
    found = []
    ours = []
    theirs = []
    for i, j in joints:
        one = _frame(pair.a, i, j)
        other = _frame(pair.b, i, j)
        if one is None or other is None:
            continue
        T_a, cosine_a, _ = one
        T_b, cosine_b, parallel_b = other
        for s, t in product((1.0, -1.0), repeat=2):
            if abs(s * t * cosine_b - cosine_a) < 2 * PARALLEL:
                found.append((i, j))
                ours.append(T_a)
                # Axes taken s and t times their way: z turns with the one, a common normal with
                # both.
                x = 1.0 if parallel_b else s * t
                theirs.append(T_b * [x, s * x, s, 1.0])
    if not found:
        return np.empty((0, 2), np.intp), np.empty((0, 4, 4))
    return np.array(found), np.array(ours) @ se3.inverse(np.array(theirs))


def rigid_poses(pair: Sides) -> tuple[NDArray[np.intp], Array]:
    """Pairs (i, j) and poses D of all pairs of joints of the same kinds; first, as (-1, -1), the
    base as it is.
    """
    as_it_is = np.eye(4)
    as_it_is[:3, 3] = pair.b.centre - pair.a.centre
    joints, poses = pair_poses(pair, combinations(np.flatnonzero(pair.alike).tolist(), 2))
    return np.concatenate([[[-1, -1]], joints]), np.concatenate([as_it_is[None], poses])


def turns(screw: Array, axis: Array, target: Array) -> Array:
    """Motions z (..., 2) of a joint (its screw (..., 6)) that bring an axis (..., 6) nearest to a
    target (..., 6).

    The second is NaN where there is but one; 0 where none is better.
    """
    w = screw[..., :3]
    p = _place(screw)
    turns_axis = axis[..., :3].any(-1, keepdims=True)
    turns_target = target[..., :3].any(-1, keepdims=True)
    d = np.where(turns_axis, axis[..., :3], axis[..., 3:])
    e = np.where(turns_target, target[..., :3], target[..., 3:])
    here = _place(axis)
    there = _place(target)
    placed = turns_axis & turns_target
    if not w.any():
        slide = screw[..., 3:] - d * _dot(d, screw[..., 3:])
        long = _dot(slide, slide)
        moves = placed & (long >= PARALLEL**2)
        z = np.where(moves, _dot(slide, there - here) / np.where(moves, long, 1.0), 0.0)
        return np.concatenate([z, np.full_like(z, np.nan)], axis=-1)
    z, size = _angle(w, d, e)
    about, radius = _angle(w, here - p, there - p)
    turned = size > PARALLEL**2
    other = np.where(turned, np.where(z > 0, z - np.pi, z + np.pi), np.nan)
    return np.concatenate(
        [np.where(turned, z, np.where(placed & (radius >= 1e-8), about, 0.0)), other],
        axis=-1,
    )


def one_turn(pair: Sides, rigid: tuple[NDArray[np.intp], Array], k: int) -> tuple[Array, Array]:
    """Alignments (P, z) in which joint k alone has a zero offset, best first, from the
    `rigid_poses` of both.
    """
    i, j = rigid[0].T
    D = rigid[1]
    # D is the base's pose, or stands behind joint k
    front = j <= k
    back = i >= k
    Ad = se3.adjoint(D)
    turn = turns((Ad @ pair.b.screws[k])[:, None], pair.b.axes @ np.swapaxes(Ad, 1, 2), pair.a.axes)
    # The next axis on the other side of k that is not k's own line tells the offset.
    others = np.arange(pair.n)
    good = (
        ~np.isnan(turn) & (front[:, None] & (others > k) | back[:, None] & (others < k))[..., None]
    )
    each = good.sum(-1)
    before = (np.cumsum(each) - each.ravel()).reshape(each.shape)
    good &= ((before <= MOST) | (others == np.where(back, 0, k + 1)[:, None]))[..., None]
    which = np.nonzero(good)[0]
    turn = turn[good]
    z = np.zeros((len(turn), pair.n))
    P = D[which]
    behind = back[which]
    z[:, k] = np.where(behind, -turn, turn)
    P[behind] @= se3.exp(pair.b.screws[k] * turn[behind, None])
    return best(pair, P, z)


def one_by_one(pair: Sides) -> tuple[Array, Array]:
    """Alignments (P, z) found joint after joint, each zero offset bringing the next axis into its
    place; best first.
    """
    P = np.empty((0, 4, 4))
    if pair.n > 1:
        P = pair_poses(pair, [(0, 1)])[1]
    if not len(P):
        P = rigid_poses(pair)[1]
    P = _on_the_first_turning_axis(pair, P)
    D = P
    z = np.zeros((len(P), pair.n))
    loss = np.zeros(len(P))
    for k in range(1, pair.n - 1):
        Ad = se3.adjoint(D)
        turn = turns(Ad @ pair.b.screws[k], Ad @ pair.b.axes[k + 1], pair.a.axes[k + 1])
        turn = np.concatenate([np.zeros((len(turn), 1)), np.where(turn == 0, np.nan, turn)], axis=1)
        good = ~np.isnan(turn)
        row = np.nonzero(good)[0]
        turn = turn[good]
        P = P[row]
        D = D[row] @ se3.exp(pair.b.screws[k] * turn[:, None])
        z = z[row]
        z[:, k] = turn
        miss = aligned_deviations(pair, P, z)[:, k + 1]
        loss = loss[row] + np.minimum(miss, 1e4) ** 0.5 + (abs(turn) > pair.zero_tolerance[k])
        kept = np.argsort(loss, kind="stable")[:BEAM]
        P = P[kept]
        D = D[kept]
        z = z[kept]
        loss = loss[kept]
    return P, z


def _on_the_first_turning_axis(pair: Sides, P: Array) -> Array:
    """The poses P (m, 4, 4) moved along slides, which have no place, to where the first axis that
    turns has its own.

    That place is where a link that no zero offset changes has it, and not the point nearest the
    centre.
    """
    turning = [k for k, kind in enumerate(pair.a.kinds) if kind != "prismatic"]
    if not turning or turning[0] == 0:
        return P
    ours, theirs = (_anchor(side, turning[0]) for side in (pair.a, pair.b))
    if ours is None or theirs is None:
        return P
    P = P.copy()
    P[:, :3, 3] += ours - (P[:, :3, :3] @ theirs + P[:, :3, 3])
    return P


def _anchor(lines: Lines, k: int) -> Array | None:
    """The point of axis k that is level with the foot of the next common normal of neighbours that
    are not parallel.
    """
    for m in range(k, len(lines.kinds) - 1):
        if "prismatic" in lines.kinds[m : m + 2]:
            return None
        frame = _frame(lines, m, m + 1)
        if frame is not None and not frame[2]:
            way = lines.ways[k]
            foot = frame[0][:3, 3]
            return lines.places[k] + way * (way @ (foot - lines.places[k]))
    return None


def best(pair: Sides, P: Array, z: Array, most: int = 4) -> tuple[Array, Array]:
    """The alignments under which most axes agree best: a far miss counts little more than a near
    one.

    Of alignments that differ by rounding alone those with fewer zero offsets and fewer reversed
    axes come first.
    """
    axes = transformed(pair, P, z)[1]
    changes = (abs(z) > 0).sum(1) + (signs(pair, axes) < 0).sum(1)
    loss = np.log1p(np.minimum(deviations(pair, axes), 1e6)).sum(1) + 0.01 * changes
    first = np.argsort(loss, kind="stable")[:most]
    return P[first], z[first]


def _frame(lines: Lines, i: int, j: int) -> tuple[Array, float, bool] | None:
    """The frame (4, 4) of two axes, z along i, x along the common normal; their cosine; and whether
    they are parallel.

    Of parallel axes x is the way from i to j. None where there is none: parallel axes on one line,
    or one without a place.
    """
    z = lines.ways[i]
    other = lines.ways[j]
    p = lines.places[i]
    r = lines.places[j]
    has_p = lines.kinds[i] != "prismatic"
    has_r = lines.kinds[j] != "prismatic"
    x = cross(z, other)
    origin = p if has_p else r
    parallel = not x @ x > PARALLEL**2
    if parallel:
        if not has_p or not has_r or (r - p) @ (r - p) <= 1e-10:
            return None
        x = r - p
    elif has_p and has_r:
        # p + z h is the foot of the common normal: the gap's part across the normal and axis j
        # vanishes.
        side = cross(x, other)
        origin = p + z * (side @ (r - p)) / (side @ z)
    x = x - z * (z @ x)
    length = np.sqrt(x @ x)
    if length < 1e-6:
        return None
    x = x / length
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, cross(z, x), z], axis=1)
    frame[:3, 3] = origin
    return frame, float(z @ other), parallel


def _angle(w: Array, u: Array, v: Array) -> tuple[Array, Array]:
    """The angle (..., 1) about w from u to v (..., 3), and the lesser of their squared lengths
    across w.
    """
    u = u - w * _dot(w, u)
    v = v - w * _dot(w, v)
    return np.arctan2(_dot(w, cross(u, v)), _dot(u, v)), np.minimum(_dot(u, u), _dot(v, v))


def _place(axis: Array) -> Array:
    return cross(axis[..., :3], axis[..., 3:])


def _dot(x: Array, y: Array) -> Array:
    """x . y over the last axis, which stays, of length 1."""
    return (x * y).sum(-1, keepdims=True)
