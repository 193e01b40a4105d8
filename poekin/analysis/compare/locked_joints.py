"""Positions at which joints can be held so that the axes on both sides of them lie to each other as
in another arm.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from ...groups import se3, so3
from ...groups.arrays import Array
from ...model.chain import Chain
from ..axis_lines import Tolerances, sine
from .alignment.lines import Lines, lines
from .length_unit import rescaled

__all__ = ["held_positions"]

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


class _Relation(NamedTuple):
    """Required position of an axis A behind the joints to one before them: C A = goal, and |A_v -
    centre|² = square.

    Attributes: place, of A in the axes behind; C (k, 6), goal (k,); sphere, centre (3,) and square,
    of parallel axes.
    """

    place: int
    C: Array
    goal: Array
    sphere: tuple[Array, float] | None = None


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
    size = max(float(np.linalg.norm(lines(long).places)), tol.position)
    # In units of the arm's own size, so that lengths and angles count alike.
    ours, theirs = (lines(rescaled(chain, 1.0 / size)) for chain in (long, short))
    front = _side(ours, reversed(range(run[0])), gone)
    behind = _side(ours, range(run[-1] + 1, len(ours.kinds)), gone)
    both = front + behind
    wanted = {j: theirs.axes[j - sum(k < j for k in gone)] for j in both}
    tried: list[tuple[float, Array]] = []
    for signs in product((1.0, -1.0), repeat=len(both) - 1):
        signed = {j: sign * wanted[j] for j, sign in zip(both, (1.0, *signs), strict=True)}
        relations = _relations(ours, front, behind, signed)
        x = _starts(ours, run)
        for _ in range(STEPS):
            x = x + _step(*_misfit(ours, run, behind, relations, x))
        r, _ = _misfit(ours, run, behind, relations, x)
        tried += zip(abs(r).max(1), x, strict=True)
    turning = np.array([ours.kinds[k] == "revolute" for k in run])
    units = np.where(ours.slides[list(run)], size, 1.0)
    found: list[Array] = []
    for miss, x in sorted(tried, key=lambda row: row[0]):
        x = np.where(turning, np.arctan2(np.sin(x), np.cos(x)), x)
        if miss > 10.0 * (tol.rotation + tol.position / size) or len(found) == MOST:
            break
        if all(abs(x - other).max() > tol.rotation for other in found):
            found.append(x)
    return [tuple(map(float, units * x)) for x in found]


def _side(ours: Lines, joints: Iterable[int], gone: Sequence[int]) -> list[int]:
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
    values = {
        "revolute": turn,
        "helical": np.concatenate([turn + 2.0 * np.pi * (k - TURNS / 2.0) for k in range(TURNS)]),
        "prismatic": np.array([-0.5, 0.0, 0.5]),
    }
    return np.array(list(product(*(values[ours.kinds[k]] for k in run))))


def _relations(
    ours: Lines,
    front: list[int],
    behind: list[int],
    wanted: dict[int, Array],
) -> list[_Relation]:
    """Relations of the axes on both sides, as those of the other arm (6,) have them."""
    relations = []
    for f, (place, g) in product(front, enumerate(behind)):
        part = ours.part(g)
        way = wanted[f][ours.part(f)]
        relations.append(_angle(ours.ways[f], way, wanted[g][part], place, part))
    if _placed(ours, front) and _placed(ours, behind):
        f = front[-1]
        g = behind[-1]
        relations.append(_apart(ours.axes[f], wanted[f], wanted[g], len(behind) - 1))
    return relations


def _placed(ours: Lines, side: list[int]) -> bool:
    """Whether the last of these axes has a place that no slide before it changes, as where they
    slide along it.
    """
    *slides, last = side
    along = [sine(ours.ways[j], ours.ways[last]) <= PARALLEL for j in slides]
    return not ours.slides[last] and all(along)


def _angle(w: Array, way: Array, other: Array, place: int, part: slice) -> _Relation:
    """An axis behind makes the angle with direction w that `other` makes with `way`."""
    rows = w[None]
    goal = np.array([way @ other])
    if sine(way, other) <= PARALLEL:
        rows = so3.hat(w)
        goal = np.zeros(3)
    C = np.zeros((len(rows), 6))
    C[:, part] = rows
    return _Relation(place, C, goal)


def _apart(axis: Array, first: Array, second: Array, place: int) -> _Relation:
    """An axis behind is as far from `axis` as `second` is from `first`."""
    w = first[:3]
    u = second[:3]
    if sine(w, u) > PARALLEL:
        moment = w @ second[3:] + first[3:] @ u
        return _Relation(place, np.roll(axis, 3)[None], np.array([moment]))
    sign = float(np.sign(w @ u))
    gap = second[3:] - sign * first[3:]
    sphere = sign * axis[3:], float(gap @ gap)
    return _Relation(place, np.zeros((0, 6)), np.zeros(0), sphere)


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
    T = np.tile(np.eye(4), (len(x), 1, 1))
    screws = []
    for k, own in zip(run, x.T, strict=True):
        screws.append(se3.adjoint(T) @ ours.screws[k])
        T = T @ se3.exp(ours.screws[k] * own[:, None])
    axes = ours.axes[behind] @ se3.adjoint(T).swapaxes(1, 2)
    # d Ad(e^{S x}) A = ad(S) A dx.
    changes = np.stack([axes @ se3.ad(S).swapaxes(1, 2) for S in screws], axis=-1)
    r = []
    J = []
    for relation in relations:
        A = axes[:, relation.place]
        dA = changes[:, relation.place]
        r.append(A @ relation.C.T - relation.goal)
        J.append(relation.C @ dA)
        if relation.sphere is not None:
            centre, square = relation.sphere
            apart = A[:, 3:] - centre
            r.append((apart * apart).sum(1, keepdims=True) - square)
            J.append(2.0 * apart[:, None] @ dA[:, 3:])
    return np.concatenate(r, 1), np.concatenate(J, 1)


def _step(r: Array, J: Array) -> Array:
    """The steps (m, r) of Levenberg-Marquardt, damped by |r|² (Fan and Yuan 2005), of 1/2 at most."""
    transposed = J.swapaxes(1, 2)
    normal = transposed @ J
    damping = (r * r).sum(1) + 1e-14 * np.trace(normal, axis1=1, axis2=2) + 1e-30
    damped = normal + damping[:, None, None] * np.eye(J.shape[2])
    return np.linalg.solve(damped, transposed @ -r[..., None])[..., 0]
