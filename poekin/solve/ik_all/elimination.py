"""All solutions of six revolute joints of any geometry, by elimination."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.geometry.hp import HPForm

_ASKED = 48
_FOUND = 1e-6  # rad
_INEXACT = 0.1  # rad, of a root that is to be tried
_OFTEN = 0.5  # of the poses asked


class EliminatedRows(NamedTuple):
    """Solutions of targets, before they are tried down to rounding.

    Attributes: branches (N, 16, 7), coordinates q, rad, NaN in rows that hold none, and a margin,
    the slope of the polynomial at the root as a share of the largest, 0 at what may be a double root,
    which is to be tried, and -1 without a root; sure (N,), whether the number of roots is beyond doubt to rounding:
    all of them are solutions, simple, and even in number.
    """

    branches: Array
    sure: np.ndarray

    @property
    def q(self) -> Array:
        """Coordinates (N, 16, 6), rad."""
        return self.branches[:, :, :-1]

    @property
    def margin(self) -> Array:
        """Margins (N, 16)."""
        return self.branches[:, :, -1]


@dataclass(frozen=True, eq=False)
class Elimination:
    """The elimination of one arm: which joint the loop is begun at, in the order of trial.

    Attributes: chain, the arm; tables (k, 9, 9), see `elimination_kernels`, the best first.
    Source: Raghavan and Roth 1993.
    """

    method: ClassVar[Literal["elimination"]] = "elimination"
    most: ClassVar[int] = 16
    is_exact: ClassVar[bool] = True
    position_bound: ClassVar[float] = 0.0
    rotation_bound: ClassVar[float] = 0.0

    chain: Chain
    tables: Array

    def said(self) -> str:
        """The way to the solutions, in words."""
        return (
            "elimination of five joints, all real roots of a polynomial of degree 16 in the sixth"
        )

    def starts(self, T: Array) -> tuple[Array, np.ndarray, np.ndarray]:
        """Configurations (S, 6) for all of the targets (N, 4, 4), one target's after the other's,
        which the caller has to try and to check; how many each has (N,), and where there may be
        more solutions (N,).
        """
        found = self.rows(T)
        taken = found.margin >= 0.0
        return found.q[taken], taken.sum(axis=1), ~found.sure

    def branches(self, T: Array) -> Array:
        """Branches (N, 16, 7) of targets (N, 4, 4), each with its margin behind it, below 0 or NaN
        where there is none. A target that may have more solutions than it finds has a branch with
        the margin 0 of a double root.
        """
        found = self.rows(T)
        found.margin[~found.sure, -1] = 0.0
        return found.branches

    def rows(self, T: Array) -> EliminatedRows:
        """Solutions of targets (N, 4, 4), by the first table, and of those that it is not sure of by
        the next ones, then by quarters of the circle; what none is sure of, by all together.
        """
        first, *more = self.tables
        found = _rows(first, T)
        doubted = np.flatnonzero(~found.sure)
        others = [(doubted, EliminatedRows(found.branches[doubted], found.sure[doubted]))]
        for table in (*more, *map(_by_quarters, self.tables)):
            unsure = np.flatnonzero(~found.sure)
            if not len(unsure):
                break
            other = _rows(table, T[unsure])
            others.append((unsure, other))
            for whole, part in zip(found, other, strict=True):
                whole[unsure[other.sure]] = part[other.sure]
        for which, other in others:
            left = ~other.sure
            if left.any():
                _join(found, which[left], other, left)
        return found


def _join(found: EliminatedRows, which: np.ndarray, other: EliminatedRows, own: np.ndarray) -> None:
    """Adds the solutions of some targets that another table has found, as far as there is room; of
    targets whose number of solutions is sure those alone that are near to none.
    """
    one = EliminatedRows(found.branches[which], found.sure[which])
    others = EliminatedRows(other.branches[own], other.sure[own])
    for row in np.flatnonzero(_new(one, others).any(axis=0)).tolist():
        added = EliminatedRows(others.branches[:, row : row + 1], others.sure)
        target = np.flatnonzero(_new(one, added))
        free = np.argmin(one.margin[target], axis=1)
        has_room = one.margin[target, free] < 0.0
        target = target[has_room]
        one.branches[target, free[has_room]] = others.branches[target, row]
    found.branches[which] = one.branches


def _new(known: EliminatedRows, others: EliminatedRows) -> np.ndarray:
    """Which of the others' solutions are not known."""
    near = np.where(known.sure[:, None] | (others.margin == 0.0), _INEXACT, _FOUND)
    off = _apart(known.q[:, None], others.q[:, :, None])
    is_known = ((off < near[:, :, None]) & (known.margin >= 0.0)[:, None]).any(axis=2)
    return (others.margin >= 0.0) & ~is_known


def elimination(chain: Chain) -> Elimination | None:
    """The elimination of an arm of six revolute joints, or None where every loop degenerates.

    A loop degenerates where its first two axes meet or are parallel, or others are so placed that
    the determinant is 0 throughout: each of the twelve loops is tried on poses of which a solution
    is known.

    Raises: InputError, as `Chain.to_hp`, for joints that are not revolute or are coupled.
    """
    form = chain.to_hp()
    if len(form.H) != 6:
        return None
    rng = np.random.default_rng(0)
    q = rng.uniform(-np.pi, np.pi, (_ASKED, 6))
    T = chain.fk(q)
    tried = []
    for reverse in (0, 1):
        for begin in range(6):
            table = _table(form, reverse, begin)
            failures, error = _tried(_rows(table, T), q)
            at_most, _ = _tried(_rows(_by_quarters(table), T), q)
            if at_most < _OFTEN * _ASKED:
                # at these joints nothing but the line is to be computed anew for each target
                is_slow = begin not in (0, 5)
                tried.append((failures, is_slow, error, table))
    if not tried:
        return None
    # a stable sort: of equal ones the first that was tried
    tried.sort(key=lambda one: one[:3])
    tables = np.array([one[3] for one in tried])
    return Elimination(chain, tables)


def _tried(found: EliminatedRows, q: Array) -> tuple[int, float]:
    """Number of poses whose configurations q (N, 6) are not found, or not for sure, and the error
    (rad) that nine tenths of the poses stay within.
    """
    off = _apart(found.q, q[:, None])
    nearest = np.fmin.reduce(off, axis=1, initial=np.pi)
    failed = (nearest > _FOUND) | ~found.sure
    error = np.quantile(nearest, 0.9)
    return int(failed.sum()), float(error)


def _apart(q: Array, other: Array) -> Array:
    """Largest difference (rad) of configurations' angles, whole turns left out."""
    turn = 2.0 * np.pi
    off = q - other
    off -= turn * np.round(off / turn)
    return np.abs(off).max(axis=-1)


def _table(form: HPForm, reverse: int, begin: int) -> Array:
    table = np.zeros((9, 9))
    table[:6, :3] = form.H
    table[:7, 3:6] = form.P
    table[7] = form.R_nt.ravel()
    points = np.cumsum(form.P[:6], axis=0)
    size = np.ptp(points, axis=0).max()
    if size == 0.0:
        size = 1.0
    table[8, 0] = size
    table[8, 1] = reverse
    table[8, 2] = begin
    return table


def _by_quarters(table: Array) -> Array:
    """A table that has the determinant looked at by quarters of the circle where it is flat."""
    other = table.copy()
    other[8, 3] = 1.0
    return other


def _rows(table: Array, T: Array) -> EliminatedRows:
    from ...engine.kernels.branches import elimination_kernels  # which imports Numba

    N = len(T)
    rows = np.full((N, elimination_kernels.MOST, 7), np.nan)
    counts = np.empty((N, 2))
    targets = np.ascontiguousarray(T)
    elimination_kernels.eliminated.call(table, targets, rows, counts)
    return EliminatedRows(rows, counts[:, 1] == 0.0)
