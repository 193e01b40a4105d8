"""Starts of an alignment: poses that bring two of b's axes onto a's, and turns that bring one more.

All alignments are weighed at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import (
    angular_part,
    directions,
    dots,
    linear_part,
    rotation_part,
    translation_part,
)
from ...axis_lines import Marks, cross, place
from .alignments import Alignments, Rows
from .lines import Lines, Sides

# An axis within about a degree of parallel counts as parallel, as the common normal flies about
# there.
PARALLEL = 0.02
BEAM = 24
MOST = 600
"""Beyond so many alignments, each pose is tried with one turn only."""


@dataclass(frozen=True, eq=False)
class PairPoses(Rows):
    """Alignments without a zero offset that carry two of b's axes to a's, those of `joints` (m, 2)."""

    joints: NDArray[np.intp]
    at: Alignments


@dataclass(frozen=True, eq=False)
class _Beam(Rows):
    """Alignments, the poses D (m, 4, 4) of their next joint, and what they have lost (m)."""

    at: Alignments
    D: Array
    loss: Array


class _Frame(NamedTuple):
    """The frame T (4, 4) of two axes, z along the first and x along the common normal; the cosine
    of their angle, and whether they are parallel.
    """

    T: Array
    cosine: float
    parallel: bool


class _Line(NamedTuple):
    """Axes as lines: directions and places (..., 3), and whether they have a place (..., 1)."""

    way: Array
    place: Array
    placed: Marks


def pair_poses(
    pair: Sides,
    joints: Iterable[tuple[int, int]],
) -> PairPoses:
    """Poses that carry b's two axes to a's, of those pairs i < j of joints that are asked for.

    There is a pose for each way round that the axes can be taken.
    Two axes that are not parallel fix it up to that; parallel ones leave a slide along them, which
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
        for s, t in product((1.0, -1.0), repeat=2):
            # Axes taken s and t times their way: z turns with the one, a common normal with both.
            both = s * t
            if abs(both * other.cosine - one.cosine) < 2 * PARALLEL:
                found.append((i, j))
                ours.append(one.T)
                x = 1.0 if other.parallel else both
                theirs.append(other.T * [x, s * x, s, 1.0])
    numbers = np.array(found, np.intp).reshape(-1, 2)
    T_a = np.array(ours).reshape(-1, 4, 4)
    T_b = np.array(theirs).reshape(-1, 4, 4)
    P = T_a @ se3.inverse(T_b)
    return PairPoses(numbers, Alignments.rigid(P, pair.n))


def rigid_poses(pair: Sides) -> PairPoses:
    """Poses of all pairs of joints of the same kinds; first, of (-1, -1), the base as it is."""
    alike = np.flatnonzero(pair.alike).tolist()
    of_none = np.array([[-1, -1]])
    as_it_is = PairPoses(of_none, pair.as_they_stand)
    of_two = pair_poses(pair, combinations(alike, 2))
    return as_it_is.joined(of_two)


def turns(screw: Array, axis: Array, target: Array) -> Array:
    """Motions z (..., 2) of a joint (its screw (..., 6)) that bring an axis (..., 6) nearest to a
    target (..., 6).

    The second is NaN where there is but one; 0 where none is better.
    """
    w = angular_part(screw)
    v = linear_part(screw)
    line = _line(axis)
    goal = _line(target)
    placed = line.placed & goal.placed
    if not w.any():
        slide = v - line.way * dots(line.way, v)
        long = dots(slide, slide)
        moves = placed & (long >= PARALLEL**2)
        ahead = dots(slide, goal.place - line.place)
        divisor = np.where(moves, long, 1.0)
        first = np.where(moves, ahead / divisor, 0.0)
        second = np.full_like(first, np.nan)
    else:
        p = place(screw)
        z, size = _angle(w, line.way, goal.way)
        lever = line.place - p
        about, radius = _angle(w, lever, goal.place - p)
        turned = size > PARALLEL**2
        beside = np.where(placed & (radius >= 1e-8), about, 0.0)
        half_back = np.where(z > 0, -np.pi, np.pi)
        opposite = z + half_back
        first = np.where(turned, z, beside)
        second = np.where(turned, opposite, np.nan)
    return np.concatenate([first, second], axis=-1)


def one_turn(pair: Sides, rigid: PairPoses, k: int) -> Alignments:
    """Alignments in which joint k alone has a zero offset, best first, from the `rigid_poses` of
    both.
    """
    i, j = rigid.joints.T
    # The pose is the base's, or stands behind joint k
    front = j <= k
    back = i >= k
    own = pair.b.screws[k]
    Ad = se3.adjoint(rigid.at.P)
    axes = pair.b.axes @ Ad.swapaxes(1, 2)
    carried = Ad @ own
    turn = turns(carried[:, None], axes, pair.a.axes)
    # The next axis on the other side of k that is not k's own line tells the offset.
    others = np.arange(pair.n)
    behind_k = front[:, None] & (others > k)
    before_k = back[:, None] & (others < k)
    beyond = behind_k | before_k
    good = ~np.isnan(turn) & beyond[..., None]
    each = good.sum(-1)
    earlier = np.cumsum(each) - each.ravel()
    before = earlier.reshape(each.shape)
    one_axis = np.where(back, 0, k + 1)
    first = others == one_axis[:, None]
    tried = (before <= MOST) | first
    good &= tried[..., None]
    which = np.nonzero(good)[0]
    turn = turn[good]
    behind = back[which]
    at = rigid.at[which]
    at.z[:, k] = np.where(behind, -turn, turn)
    undone = se3.exp(own * turn[behind, None])
    at.P[behind] @= undone
    return best(pair, at)


def one_by_one(pair: Sides) -> Alignments:
    """Alignments found joint after joint, each zero offset bringing the next axis into its place;
    best first.
    """
    first = [(0, 1)][: pair.n - 1]
    start = pair_poses(pair, first).at
    if not len(start):
        start = rigid_poses(pair).at
    P = _on_the_first_turning_axis(pair, start.P)
    at = Alignments(P, start.z)
    beam = _Beam(at, P, np.zeros(len(P)))
    for k in range(1, pair.n - 1):
        Ad = se3.adjoint(beam.D)
        own = pair.b.screws[k]
        following = Ad @ pair.b.axes[k + 1]
        target = pair.a.axes[k + 1]
        turn = turns(Ad @ own, following, target)
        turn = np.where(turn == 0, np.nan, turn)
        turn = np.pad(turn, [(0, 0), (1, 0)])  # none is tried as well
        good = ~np.isnan(turn)
        beam = beam[np.nonzero(good)[0]]
        turn = turn[good]
        beam.at.z[:, k] = turn
        miss = pair.deviations(beam.at)[:, k + 1]
        far = np.minimum(miss, 1e4) ** 0.5
        changed = abs(turn) > pair.zero_tolerance[k]
        loss = beam.loss + far + changed
        D = beam.D @ se3.exp(own * turn[:, None])
        order = np.argsort(loss, kind="stable")
        beam = _Beam(beam.at, D, loss)[order[:BEAM]]
    return beam.at


def _on_the_first_turning_axis(pair: Sides, P: Array) -> Array:
    """The poses P (m, 4, 4) moved along slides, which have no place, to where the first axis that
    turns has its own.

    That place is where a link that no zero offset changes has it, and not the point nearest the
    centre.
    """
    k = int(np.argmin(pair.a.slides))  # 0 where all of them slide
    if k == 0:
        return P
    ours = _anchor(pair.a, k)
    theirs = _anchor(pair.b, k)
    if ours is None or theirs is None:
        return P
    P = P.copy()
    R = rotation_part(P)
    carried = R @ theirs + translation_part(P)
    P[:, :3, 3] += ours - carried
    return P


def _anchor(lines: Lines, k: int) -> Array | None:
    """The point of axis k that is level with the foot of the next common normal of neighbours that
    are not parallel.
    """
    for m in range(k, len(lines.kinds) - 1):
        if lines.slides[m : m + 2].any():
            return None
        frame = _frame(lines, m, m + 1)
        if frame is not None and not frame.parallel:
            way = lines.ways[k]
            own = lines.places[k]
            foot = translation_part(frame.T)
            return own + way * (way @ (foot - own))
    return None


def best(pair: Sides, at: Alignments, most: int = 4) -> Alignments:
    """The alignments under which most axes agree best: a far miss counts little more than a near
    one.

    Of alignments that differ by rounding alone those with fewer zero offsets and fewer reversed
    axes come first.
    """
    b = pair.transformed(at)
    offsets = (abs(at.z) > 0).sum(1)
    turned_round = (b.signs < 0).sum(1)
    changes = offsets + turned_round
    miss = np.minimum(b.deviations, 1e6)
    loss = np.log1p(miss).sum(1) + 0.01 * changes
    order = np.argsort(loss, kind="stable")
    return at[order[:most]]


def _frame(lines: Lines, i: int, j: int) -> _Frame | None:
    """The frame of two axes.

    Of parallel axes x is the way from i to j. None where there is none: parallel axes on one line,
    or one without a place.
    """
    z = lines.ways[i]
    other = lines.ways[j]
    origin = lines.places[i]
    gap = lines.places[j] - origin
    placed = not lines.slides[[i, j]].any()
    if lines.slides[i]:
        origin = lines.places[j]
    x = cross(z, other)
    parallel = not x @ x > PARALLEL**2
    if parallel:
        if not placed or gap @ gap <= 1e-10:
            return None
        x = gap
    elif placed:
        # The foot of the common normal: the gap's part across the normal and axis j vanishes.
        side = cross(x, other)
        origin = origin + z * (side @ gap) / (side @ z)
    x = x - z * (z @ x)
    length = np.sqrt(x @ x)
    if length < 1e-6:
        return None
    x = x / length
    frame = np.eye(4)
    columns = [x, cross(z, x), z, origin]
    frame[:3] = np.stack(columns, axis=1)
    return _Frame(frame, float(z @ other), parallel)


def _line(axis: Array) -> _Line:
    placed = angular_part(axis).any(-1, keepdims=True)
    return _Line(directions(axis), place(axis), np.asarray(placed))


def _angle(
    w: Array,
    u: Array,
    v: Array,
) -> tuple[Array, Array]:
    """The angle (..., 1) about w from u to v (..., 3), and the lesser of their squared lengths
    across w.
    """
    u = u - w * dots(w, u)
    v = v - w * dots(w, v)
    sine = dots(w, cross(u, v))
    angle = np.arctan2(sine, dots(u, v))
    lesser = np.minimum(dots(u, u), dots(v, v))
    return angle, lesser
