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
_OFTEN = 0.5  # of the poses asked
_TABLES = 4


class EliminatedRows(NamedTuple):
    """Solutions of targets, before they are tried down to rounding.

    Attributes: q (N, 16, 6), rad, NaN in rows that hold none; margin (N, 16), the slope of the
    polynomial at the root as a share of the largest, 0 at a double root and -1 without a root;
    count (N,); sure (N,), whether the number of roots is beyond doubt to rounding: all of them are
    solutions, simple, and even in number.
    """

    q: Array
    margin: Array
    count: np.ndarray
    sure: np.ndarray


@dataclass(frozen=True, eq=False)
class Elimination:
    """The elimination of one arm: which joint the loop is begun at, in the order of trial.

    Attributes: chain, the arm; tables (k, 9, 9), see `elimination_kernels`, the best first.
    Source: Raghavan and Roth 1993.
    """

    method: ClassVar[Literal["elimination"]] = "elimination"
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
        finite = np.isfinite(found.q).all(axis=2)
        taken = (found.margin >= 0.0) & finite
        counts = taken.sum(axis=1)
        return found.q[taken], counts, ~found.sure

    def rows(self, T: Array) -> EliminatedRows:
        """Solutions of targets (N, 4, 4), by the first table, and of those that it is not sure of by
        the next ones; what none is sure of, by all together.
        """
        found = _rows(self.tables[0], T)
        for table in self.tables[1:_TABLES]:
            unsure = np.flatnonzero(~found.sure)
            if not len(unsure):
                break
            other = _rows(table, T[unsure])
            for i, k in enumerate(unsure.tolist()):
                if other.sure[i]:
                    for whole, part in zip(found, other, strict=True):
                        whole[k] = part[i]
                else:
                    _join(found, k, other, i)
        return found


def _join(found: EliminatedRows, k: int, other: EliminatedRows, i: int) -> None:
    """Adds the solutions of a target that another table has found, as far as there is room."""
    q = found.q[k]
    margin = found.margin[k]
    for row in np.flatnonzero(other.margin[i] >= 0.0):
        solution = other.q[i, row]
        known = margin >= 0.0
        if known.all():
            break
        off = _apart(q[known], solution)
        if not (off < _FOUND).any():
            free = int(np.argmin(known))
            q[free] = solution
            margin[free] = other.margin[i, row]
            found.count[k] = known.sum() + 1


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
            found = _rows(table, T)
            failures, error = _tried(found, q)
            if failures < _OFTEN * _ASKED:
                tried.append((failures, error, table))
    if not tried:
        return None
    # a stable sort: of equal ones the first that was tried
    tried.sort(key=lambda one: one[:2])
    tables = np.array([table for _, _, table in tried])
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


def _rows(table: Array, T: Array) -> EliminatedRows:
    from ...engine.kernels.branches import elimination_kernels  # which imports Numba

    N = len(T)
    rows = np.full((N, elimination_kernels.MOST, 7), np.nan)
    counts = np.empty((N, 2))
    targets = np.ascontiguousarray(T)
    elimination_kernels.eliminated.call(table, targets, rows, counts)
    return EliminatedRows(
        rows[..., :6],
        rows[..., 6],
        counts[:, 0].astype(int),
        counts[:, 1] == 0.0,
    )
