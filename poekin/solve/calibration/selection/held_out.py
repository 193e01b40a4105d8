"""Errors on held-out readings of many sets of terms, from one linearisation at a fit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ....groups.vectors import norms
from ..fit.fitting import Fit
from ..fit.losses import LossName, loss
from ..model.problem import Problem
from ..model.tsqr import blocked_product, qr_r

_RANK = 1e-8  # of the largest singular value: directions below are rounding
_INDEPENDENT = 1e-6  # of a column's length: what of it is left beside the others is rounding below


class HeldOut(NamedTuple):
    """Squared errors of the configurations (G,), each predicted from other folds: whitened, and in m²."""

    whitened: Array
    lengths: Array

    @property
    def score(self) -> float:
        """Mean whitened square."""
        return float(np.mean(self.whitened))

    @property
    def deviation(self) -> float:
        """Standard error of the score."""
        count = len(self.whitened)
        return float(np.std(self.whitened, ddof=1) / np.sqrt(count))

    @property
    def rms_length(self) -> float:
        """Root mean square error, m."""
        return float(np.sqrt(np.mean(self.lengths)))


class Folds(NamedTuple):
    """Number of folds, and the seed by which configurations are drawn into them."""

    count: int
    seed: int

    def of(self, label: NDArray[np.intp]) -> NDArray[np.intp]:
        """Fold of each configuration; label (N,), the configuration of each reading."""
        order = np.random.default_rng(self.seed).permutation(label.max() + 1)
        found = np.empty(len(order), np.intp)
        for k, drawn in enumerate(np.array_split(order, self.count)):
            found[drawn] = k
        return found


class LinearFit:
    """Whitened, weighted errors b (M,) and Jacobian at p, by orthonormal columns Q (M, K) of groups of
    directions, with the folds of their rows.

    A subspace of them, Q W with orthonormal W (K, k), is fitted to all folds but one and predicts
    this one, f: z = (I - W^T Q_f^T Q_f W)^-1 W^T (Q^T b - Q_f^T b_f) leaves b_f - Q_f W z. So each
    set of terms costs products of K numbers, not of M.
    """

    def __init__(
        self,
        problem: Problem,
        fit: Fit,
        name: LossName,
        folds: Folds,
        directions: Mapping[str, Array],
    ) -> None:
        self._problem = problem
        self._noise = fit.noise
        label = _configurations(problem.q)
        self._groups = [label[rows] for rows in problem.rows]
        rows = self._weighted(fit.p, name)
        every = np.concatenate(list(directions.values()), axis=1)
        columns = blocked_product(rows[:, :-1], every)
        sizes = np.linalg.norm(columns, axis=0)
        columns /= np.where(sizes > 0.0, sizes, 1.0)
        _, s, Vt = np.linalg.svd(qr_r(columns), full_matrices=False)
        kept = s > _RANK * s[:1]
        self._Q = blocked_product(columns, Vt[kept].T / s[kept])
        ends = np.cumsum([D.shape[1] for D in directions.values()])
        parts = np.split(s[kept, None] * Vt[kept], ends[:-1], axis=1)
        self._columns = dict(zip(directions, parts, strict=True))
        self._b = rows[:, -1]
        pairs = zip(self._groups, problem.sets, strict=True)
        numbers = [np.repeat(folds.of(label)[group], s.width) for group, s in pairs]
        fold = np.concatenate(numbers)
        self._folds = [np.flatnonzero(fold == k) for k in range(folds.count)]

    def _weighted(self, p: Array, name: LossName) -> Array:
        """Jacobian and errors (M, P + 1), each row times the root of its weight."""
        self._weights: list[Array] = []
        found = []
        for k, (errors, jacobian) in enumerate(self._problem.linearised(p)):
            e = self._noise.whitened(k, errors[..., None])
            J = self._noise.whitened(k, jacobian) * self._problem.scale
            squares = np.sum(e * e, axis=(1, 2))
            weight = loss(name, squares, errors.shape[1]).weight
            self._weights.append(weight)
            roots = np.sqrt(weight)
            rows = np.concatenate([J, e], axis=2)
            rows *= roots[:, None, None]
            found.append(rows.reshape(-1, rows.shape[2]))
        return np.concatenate(found)

    @property
    def nothing(self) -> Array:
        """W of no columns."""
        return np.empty((self._Q.shape[1], 0))

    def with_group(self, W: Array, name: str) -> Array:
        """W and more columns: those of a group, as far as they are not in the span of W."""
        columns = self._columns[name]
        sizes = np.linalg.norm(columns, axis=0)
        columns = columns[:, sizes > 0.0] / sizes[sizes > 0.0]
        for _ in range(2):  # Gram-Schmidt is exact the second time
            columns = columns - W @ (W.T @ columns)
        U, s, _ = np.linalg.svd(columns, full_matrices=False)
        return np.concatenate([W, U[:, s > _INDEPENDENT]], axis=1)

    def held_out(self, W: Array) -> HeldOut | None:
        """Errors with these columns fitted; None where a fold has to itself what some are known by."""
        r = self._b.copy()
        total = self._Q.T @ r
        for rows in self._folds:
            own = self._Q[rows]
            QW = blocked_product(own, W)
            left = np.eye(W.shape[1]) - QW.T @ QW
            if np.linalg.eigvalsh(left).min(initial=1.0) < _INDEPENDENT:
                return None
            others = total - own.T @ r[rows]
            z = np.linalg.solve(left, W.T @ others)
            r[rows] -= QW @ z
        return self._by_configuration(r)

    def _by_configuration(self, r: Array) -> HeldOut:
        count = 1 + max(int(g.max()) for g in self._groups)
        whitened = np.zeros(count)
        lengths = np.zeros(count)
        numbers = np.zeros(count)
        measured = np.zeros(count)
        begin = 0
        for k, (s, group) in enumerate(zip(self._problem.sets, self._groups, strict=True)):
            end = begin + len(s) * s.width
            e = r[begin:end].reshape(-1, s.width)
            begin = end
            weight = self._weights[k]
            known = weight > 0
            np.add.at(whitened, group, np.sum(e * e, axis=1))
            np.add.at(numbers, group, known * s.width)
            weight = np.where(known, weight, 1.0)
            roots = np.sqrt(weight)
            raw = self._noise.unwhitened(k, e / roots[:, None])
            raw = raw[:, s.angular :]
            points = max(1, raw.shape[1] // 3)
            squares = norms(raw) ** 2 / points
            np.add.at(lengths, group, squares * known)
            np.add.at(measured, group, known)
        seen = measured > 0
        per_number = whitened[seen] / numbers[seen]
        per_measurement = lengths[seen] / measured[seen]
        return HeldOut(per_number, per_measurement)


def _configurations(q: Array) -> NDArray[np.intp]:
    """Number (N,) of the configuration of each reading (N, m), in order of first appearance: equal to
    a thousandth of rad or m.
    """
    rounded = np.round(q, 3)
    _, first, label = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    count = len(first)
    rank = np.empty(count, np.intp)
    order = np.argsort(first)
    rank[order] = np.arange(count)
    return rank[label.ravel()]
