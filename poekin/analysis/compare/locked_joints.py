"""Positions at which joints can be held so that the axes on both sides of them lie to each other as
in another arm.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ...groups import se3, so3
from ...groups.arrays import Array
from ...groups.vectors import linear_part, norm
from ...model.chain import Chain
from ..axis_lines import Tolerances, sine, wrapped
from .alignment.lines import Lines, lines
from .length_unit import rescaled

STEPS = 30
"""Steps of Levenberg-Marquardt: where two solutions coincide each halves the distance, from 1 rad
to 1e-9.
"""
TURN = 8
"""Starts in a turn, in which the cosine of two axes' angle has two zeros and an extremum between
them.
"""
TURNS = 3
"""Turns of a helical joint in which starts lie, about the one where it is at 0: each leaves it
elsewhere.
"""
PARALLEL = 1e-6
"""Sine up to which axes are parallel: their mutual moment says nothing then, and their distance
does.
"""
MOST = 16
"""Positions tried where the axes leave a continuum of them, as parallel ones do."""


class _Linear(NamedTuple):
    """Required position of an axis A, one of those behind the joints: C A = goal, (k, 6) and (k)."""

    place: int
    C: Array
    goal: Array

    def misfit(self, A: Array, dA: Array) -> tuple[Array, Array]:
        """Residuals (m, k) of axes A (m, 6), and derivatives (m, k, r) from those of A."""
        residuals = A @ self.C.T - self.goal
        return residuals, self.C @ dA


class _Sphere(NamedTuple):
    """Required position of an axis A that is parallel to one before the joints: |A_v - centre|² =
    square.
    """

    place: int
    centre: Array
    square: float

    def misfit(self, A: Array, dA: Array) -> tuple[Array, Array]:
        """Residuals (m, 1) of axes A (m, 6), and derivatives (m, 1, r) from those of A."""
        apart = linear_part(A) - self.centre
        distances = (apart * apart).sum(1, keepdims=True)
        derivatives = 2.0 * apart[:, None] @ dA[:, 3:]
        return distances - self.square, derivatives


_Relation = _Linear | _Sphere


def held_positions(
    long: Chain,
    short: Chain,
    run: Sequence[int],
    gone: Sequence[int],
    tol: Tolerances,
) -> list[tuple[float, ...]]:
    """Positions (rad, m) of neighbouring joints at which the axes on both sides lie to each other
    as in the shorter chain; the best first.

    `run` are these joints, `gone` all that the shorter chain lacks.
    Least squares over what no zero position changes, and another direction by its sign alone: the
    cosine and the mutual moment w1 . v2 + w2 . v1 of the nearest axes on both sides, or the
    distance of parallel ones. A slide leaves directions as they are, so that those of the axes
    beyond it count as well.
    """
    places = lines(long).places
    size = max(norm(places), tol.position)
    # In units of the arm's own size, so that lengths and angles count alike.
    unit = 1.0 / size
    ours = lines(rescaled(long, unit))
    theirs = lines(rescaled(short, unit))
    before = reversed(range(run[0]))
    front = _side(ours, before, gone)
    beyond = range(run[-1] + 1, len(ours.kinds))
    behind = _side(ours, beyond, gone)
    both = front + behind
    wanted = {j: theirs.axes[index_without(gone, j)] for j in both}
    tried: list[tuple[float, Array]] = []
    others = product((1.0, -1.0), repeat=len(both) - 1)
    for signs in others:
        ways = zip(both, (1.0, *signs), strict=True)
        signed = {j: way * wanted[j] for j, way in ways}
        relations = _relations(ours, front, behind, signed)
        x = _starts(ours, run)
        for _ in range(STEPS):
            r, J = _misfit(ours, run, behind, relations, x)
            x = x + _step(r, J)
        r, _ = _misfit(ours, run, behind, relations, x)
        worst = abs(r).max(1)
        tried += zip(worst, x, strict=True)
    joints = list(run)
    units = np.where(ours.slides[joints], size, 1.0)
    most = 10.0 * (tol.rotation + tol.position / size)
    found: list[Array] = []
    for miss, values in sorted(tried, key=itemgetter(0)):
        if miss > most or len(found) == MOST:
            break
        x = wrapped(values, ours.revolute[joints])
        apart = (abs(x - other).max() for other in found)
        if all(size > tol.rotation for size in apart):
            found.append(x)
    return [tuple(map(float, units * x)) for x in found]


def index_without(gone: Sequence[int], j: int) -> int:
    """Number of joint j in the chain that lacks others."""
    return j - sum(k < j for k in gone)


def _side(
    ours: Lines,
    joints: Iterable[int],
    gone: Sequence[int],
) -> list[int]:
    """The first of these joints, and those beyond it as far as there are slides between, which
    leave directions.
    """
    side: list[int] = []
    for j in joints:
        if j in gone:
            break
        side.append(j)
        if not ours.slides[j]:
            break
    return side


def _starts(ours: Lines, run: Sequence[int]) -> Array:
    """Starts (m, r) of the joints' positions."""
    turn = 2.0 * np.pi * np.arange(TURN) / TURN
    middle = TURNS / 2.0
    first = 2.0 * np.pi * (np.arange(TURNS) - middle)
    values = {
        "revolute": turn,
        "helical": (turn + first[:, None]).ravel(),
        "prismatic": np.array([-0.5, 0.0, 0.5]),
    }
    starts = product(*(values[ours.kinds[k]] for k in run))
    return np.array(list(starts))


def _relations(
    ours: Lines,
    front: list[int],
    behind: list[int],
    wanted: dict[int, Array],
) -> list[_Relation]:
    """Relations of the axes on both sides, as those of the other arm (6,) have them."""
    relations: list[_Relation] = []
    for f, (place, g) in product(front, enumerate(behind)):
        part = ours.part(g)
        way = wanted[f][ours.part(f)]
        other = wanted[g][part]
        relations.append(_angle(ours.ways[f], way, other, place, part))
    if _placed(ours, front) and _placed(ours, behind):
        f = front[-1]
        g = behind[-1]
        last = len(behind) - 1
        apart = _apart(ours.axes[f], wanted[f], wanted[g], last)
        relations.append(apart)
    return relations


def _placed(ours: Lines, side: list[int]) -> bool:
    """Whether the last of these axes has a place that no slide before it changes, as where they
    slide along it.
    """
    *slides, last = side
    way = ours.ways[last]
    along = [sine(ours.ways[j], way) <= PARALLEL for j in slides]
    return not ours.slides[last] and all(along)


def _angle(
    w: Array,
    way: Array,
    other: Array,
    place: int,
    part: slice,
) -> _Relation:
    """An axis behind makes the angle with direction w that `other` makes with `way`."""
    rows = w[None]
    goal = np.array([way @ other])
    if sine(way, other) <= PARALLEL:
        rows = so3.hat(w)
        goal = np.zeros(3)
    C = np.zeros((len(rows), 6))
    C[:, part] = rows
    return _Linear(place, C, goal)


def _apart(
    axis: Array,
    first: Array,
    second: Array,
    place: int,
) -> _Relation:
    """An axis behind is as far from `axis` as `second` is from `first`."""
    w = first[:3]
    u = second[:3]
    if sine(w, u) > PARALLEL:
        moment = w @ second[3:] + first[3:] @ u
        row = np.roll(axis, 3)
        return _Linear(place, row[None], np.array([moment]))
    sign = float(np.sign(w @ u))
    gap = second[3:] - sign * first[3:]
    return _Sphere(place, sign * axis[3:], float(gap @ gap))


def _misfit(
    ours: Lines,
    run: Sequence[int],
    behind: Sequence[int],
    relations: list[_Relation],
    x: Array,
) -> tuple[Array, Array]:
    """Residuals (m, k) of the relations at positions x (m, r) of the joints, and their Jacobian (m,
    k, r).
    """
    T = np.eye(4)[None]
    screws = []
    moving = ours.screws[list(run)]
    for S, own in zip(moving, x.T, strict=True):
        screws.append(se3.adjoint(T) @ S)
        T = T @ se3.exp(S * own[:, None])
    Ad = se3.adjoint(T)
    axes = ours.axes[behind] @ Ad.swapaxes(1, 2)
    # d Ad(e^{S x}) A = ad(S) A dx.
    brackets = [se3.ad(S) for S in screws]
    by_joint = [axes @ bracket.swapaxes(1, 2) for bracket in brackets]
    changes = np.stack(by_joint, axis=-1)
    r = []
    J = []
    for relation in relations:
        k = relation.place
        own = axes[:, k]
        residuals, derivatives = relation.misfit(own, changes[:, k])
        r.append(residuals)
        J.append(derivatives)
    return np.concatenate(r, 1), np.concatenate(J, 1)


def _step(r: Array, J: Array) -> Array:
    """The steps (m, r) of Levenberg-Marquardt, damped by |r|² (Fan and Yuan 2005), of 1/2 at most."""
    transposed = J.swapaxes(1, 2)
    normal = transposed @ J
    size = np.trace(normal, axis1=1, axis2=2)
    damping = (r * r).sum(1) + 1e-14 * size + 1e-30
    identity = np.eye(J.shape[2])
    damped = normal + damping[:, None, None] * identity
    downhill = transposed @ -r[..., None]
    return np.linalg.solve(damped, downhill)[..., 0]
