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
from ..axis_lines import Tolerances
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
    front = _side(ours, range(run[0] - 1, -1, -1), gone)
    behind = _side(ours, range(run[-1] + 1, len(ours.kinds)), gone)
    both = front + behind
    wanted = theirs.axes[[j - sum(k < j for k in gone) for j in both]]
    starts = _starts(ours, run)
    tried: list[tuple[float, Array]] = []
    for signs in product((1.0, -1.0), repeat=len(both) - 1):
        signed = dict(zip(both, np.array([1.0, *signs])[:, None] * wanted, strict=True))
        relations = _relations(ours, front, behind, signed)
        x = starts
        for _ in range(STEPS):
            x = x + _step(*_misfit(ours, run, behind, relations, x))
        tried += zip(abs(_misfit(ours, run, behind, relations, x)[0]).max(1), x, strict=True)
    turning = np.array([ours.kinds[k] == "revolute" for k in run])
    units = np.array([size if ours.kinds[k] == "prismatic" else 1.0 for k in run])
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
        if ours.kinds[j] != "prismatic":
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
    relations = [
        _angle(
            ours.ways[f],
            _way(ours, f, wanted[f]),
            _way(ours, g, wanted[g]),
            place,
            _part(ours, g),
        )
        for f in front
        for place, g in enumerate(behind)
    ]
    if _placed(ours, front) and _placed(ours, behind):
        f = front[-1]
        g = behind[-1]
        relations.append(_apart(ours.axes[f], wanted[f], wanted[g], len(behind) - 1))
    return relations


def _placed(ours: Lines, side: list[int]) -> bool:
    """Whether the last of these axes has a place that no slide before it changes, as where they
    slide along it.
    """
    last = ours.ways[side[-1]]
    along = [np.linalg.norm(np.cross(ours.ways[j], last)) <= PARALLEL for j in side[:-1]]
    return ours.kinds[side[-1]] != "prismatic" and all(along)


def _part(ours: Lines, j: int) -> slice:
    """The part of an axis that is its direction."""
    if ours.kinds[j] == "prismatic":
        return slice(3, 6)
    return slice(0, 3)


def _way(ours: Lines, j: int, axis: Array) -> Array:
    return axis[_part(ours, j)]


def _angle(w: Array, way: Array, other: Array, place: int, part: slice) -> _Relation:
    """An axis behind makes the angle with direction w that `other` makes with `way`."""
    parallel = bool(np.linalg.norm(np.cross(way, other)) <= PARALLEL)
    if parallel:
        C = np.zeros((3, 6))
        C[:, part] = so3.hat(w)
        return _Relation(place, C, np.zeros(3))
    C = np.zeros((1, 6))
    C[:, part] = w
    return _Relation(place, C, np.array([way @ other]))


def _apart(axis: Array, first: Array, second: Array, place: int) -> _Relation:
    """An axis behind is as far from `axis` as `second` is from `first`."""
    sign = float(np.sign(first[:3] @ second[:3]))
    if np.linalg.norm(np.cross(first[:3], second[:3])) > PARALLEL:
        moment = np.concatenate([axis[3:], axis[:3]])
        return _Relation(
            place,
            moment[None],
            np.array([first[:3] @ second[3:] + first[3:] @ second[:3]]),
        )
    gap = second[3:] - sign * first[3:]
    return _Relation(place, np.zeros((0, 6)), np.zeros(0), (sign * axis[3:], float(gap @ gap)))


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
    axes = ours.axes[behind] @ np.swapaxes(se3.adjoint(T), 1, 2)
    # d Ad(e^{S x}) A = ad(S) A dx.
    changes = np.stack([axes @ np.swapaxes(se3.ad(S), 1, 2) for S in screws], axis=-1)
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
    normal = np.swapaxes(J, 1, 2) @ J
    damping = (r * r).sum(1) + 1e-14 * np.trace(normal, axis1=1, axis2=2) + 1e-30
    damped = normal + damping[:, None, None] * np.eye(J.shape[2])
    return np.linalg.solve(damped, np.swapaxes(J, 1, 2) @ -r[..., None])[..., 0]
