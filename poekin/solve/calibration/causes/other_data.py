"""Measurements taken otherwise: other rows, points or quaternions in another order, inverse poses,
another base or tool.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import norms, rotation_part, translation_part
from ..diagnostics.explanation import size_of
from ..fit import initial_guess
from ..measurements.measurement import Measurement, rows_of
from ..measurements.points import Distances, Points, points_at
from ..measurements.poses import Poses

_SHIFTS = (1, -1, 2, -2)
_MOST_ORDERS = 4  # points of which all orders are tried; of more, exchanges of two
_QUATERNIONS = {"x y z w": (3, 0, 1, 2), "w x y z": (1, 2, 3, 0)}


class Other(NamedTuple):
    """Data taken otherwise, in words; `handicap` is the factor of their errors in a comparison."""

    words: str
    q: Array
    sets: Sequence[Measurement]
    handicap: float = 1.0


Named = tuple[str, Measurement]


def other_rows(q: Array, sets: Sequence[Measurement]) -> Iterator[Other]:
    """The measurements at other rows of q: some rows before or behind, or in reverse order."""
    count = len(q)
    for by in _SHIFTS:
        moved = []
        for s in sets:
            if not s.sees_arm:
                moved.append(s)
                continue
            rows = rows_of(s, count) + by
            kept = np.flatnonzero((rows >= 0) & (rows < count))
            moved.append(s.subset(kept).with_rows(rows[kept]))
        if all(map(len, moved)):
            yield Other(f"each measurement {by:+d} rows of q further on", q, moved)
    turned = [s.with_rows(count - 1 - rows_of(s, count)) for s in sets]
    yield Other("the rows of q in reverse order", q, turned)


def other_numbers(s: Measurement) -> Iterator[Named]:
    """The set's own numbers taken otherwise."""
    if isinstance(s, Points):
        for order in _orders(s.p.shape[1]):
            named = ", ".join(str(i + 1) for i in order)
            yield f"the points in the order {named}", s.with_measured(s.p[:, order])
    if not s.angular:
        return
    T = np.asarray(s.T)  # type: ignore[attr-defined]  # poses of either kind
    yield "the poses inverted", s.with_measured(se3.inverse(T))
    for words, order in _QUATERNIONS.items():
        R = _reordered(rotation_part(T), order)
        yield f"quaternions in the order {words}", s.with_measured(se3.pose(R, translation_part(T)))


def other_frames(s: Measurement, T: Array) -> Iterator[Named]:
    """The set in another base, or of another tool, each fitted to the nominal poses T."""
    T = T[rows_of(s, len(T))]
    if s.unknown_frames:
        return
    if isinstance(s, Poses):
        X = initial_guess.mean_pose(T @ se3.inverse(s.T))
        yield f"the base moved by {size_of(X)}", s.with_measured(X @ s.T)
        Z = initial_guess.mean_pose(se3.inverse(T) @ s.T)
        words = f"the tool moved by {size_of(Z)}: another tip, or a tool that is to be put on"
        yield f"{words} (retooled)", s.with_measured(s.T @ se3.inverse(Z))
    elif isinstance(s, Points):
        yield from _other_points(s, T)
    elif isinstance(s, Distances):
        yield "the centre not known: centre=None", dataclasses.replace(s, centre=None)


def _other_points(s: Points, T: Array) -> Iterator[Named]:
    nominal = points_at(T, s.points)
    try:
        X = initial_guess.registration(nominal.reshape(-1, 3), s.p.reshape(-1, 3))
    except InputError:
        X = None
    if X is not None:
        moved = s.p @ rotation_part(X).T + translation_part(X)
        yield f"frame='unknown', a device moved by {size_of(X)}", s.with_measured(moved)
    off = (s.p - nominal) @ rotation_part(T)
    shift = np.median(off.reshape(-1, 3), axis=0)
    points = s.points + shift
    named = ", ".join(f"{x:.4g}" for x in points[0])
    yield f"points=({named}) m", dataclasses.replace(s, points=points)


def _orders(count: int) -> Iterator[list[int]]:
    """Orders of so many points but for their own."""
    if count <= _MOST_ORDERS:
        orders = itertools.permutations(range(count))
        next(orders)
        yield from map(list, orders)
        return
    for i, j in itertools.combinations(range(count), 2):
        order = list(range(count))
        order[i] = j
        order[j] = i
        yield order


def _reordered(R: Array, order: tuple[int, ...]) -> Array:
    """Rotations (N, 3, 3) whose quaternion w x y z has these elements of the ones of R."""
    w = so3.log(R)
    half = 0.5 * norms(w)
    vector = 0.5 * w * np.sinc(half / np.pi)[:, None]
    quaternion = np.column_stack([np.cos(half), vector])[:, order]
    sine = norms(quaternion[:, 1:])
    angle = 2.0 * np.arctan2(sine, quaternion[:, 0])
    scale = angle / np.maximum(sine, np.finfo(float).tiny)
    return so3.exp(quaternion[:, 1:] * scale[:, None])
