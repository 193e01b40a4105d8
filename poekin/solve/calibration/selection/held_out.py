"""Errors on held-out readings of many sets of terms, from one linearisation at a fit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ....groups.vectors import norms
from ..fit.losses import LossName, loss
from ..fit.noise import Noise
from ..model.problem import Problem
from ..model.tsqr import blocked_product

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
        return float(np.std(self.whitened, ddof=1) / np.sqrt(len(self.whitened)))

    @property
    def rms_length(self) -> float:
        """Root mean square error, m."""
        return float(np.sqrt(np.mean(self.lengths)))


class LinearFit:
    """Whitened, weighted errors b (M,) and Jacobian A (M, P) at p, with the folds of their rows.

    Any set of columns is fitted to all folds but one, and predicts this one: r_f = (I - Q_f
    Q_f^T)^-1 r^_f of the residuals r^ of the fit to all, with Q the columns' orthonormal basis.
    Source: the hat matrix' block form of leave-one-out, Cook and Weisberg 1982, section 2.2.
    """

    def __init__(
        self, problem: Problem, p: Array, noise: Noise, name: LossName, folds: int, seed: int
    ) -> None:
        label = _configurations(problem.q)
        order = np.random.default_rng(seed).permutation(label.max() + 1)
        fold_of = np.empty(len(order), np.intp)
        for k, drawn in enumerate(np.array_split(order, folds)):
            fold_of[drawn] = k
        self._groups: list[NDArray[np.intp]] = [label[rows] for rows in problem.rows]
        self._problem = problem
        self._noise = noise
        blocks = []
        errors = []
        weights = []
        for k, (e, J) in enumerate(problem.linearised(p)):
            b = noise.whitened(k, e[..., None])[..., 0]
            A = noise.whitened(k, J) * problem.scale
            weight = loss(name, np.sum(b * b, axis=1), b.shape[1]).weight
            roots = np.repeat(np.sqrt(weight), b.shape[1])
            weights.append(weight)
            blocks.append(A.reshape(-1, problem.size) * roots[:, None])
            errors.append(b.ravel() * roots)
        self.A = np.concatenate(blocks)
        self.b = np.concatenate(errors)
        self._weights = weights
        pairs = zip(self._groups, problem.sets, strict=True)
        self._fold = np.concatenate([np.repeat(fold_of[g], s.width) for g, s in pairs])
        self._folds = folds

    def basis(self, directions: Array, beside: Array) -> Array:
        """Orthonormal basis (M, k) of the columns A D, D (P, j), as far as they are not in the span of
        the basis `beside` (M, i).
        """
        columns = blocked_product(self.A, directions)
        lengths = np.linalg.norm(columns, axis=0)
        columns = columns[:, lengths > 0] / lengths[lengths > 0]
        for _ in range(2):  # twice is enough, Parlett
            columns = columns - beside @ (beside.T @ columns)
        U, s, _ = np.linalg.svd(columns, full_matrices=False)
        return U[:, s > _INDEPENDENT]

    def held_out(self, Q: Array) -> HeldOut | None:
        """Errors with the orthonormal columns Q (M, k) fitted; None where a fold has to itself what
        some of them are known by.
        """
        r = self.b - Q @ (Q.T @ self.b)
        for k in range(self._folds):
            rows = np.flatnonzero(self._fold == k)
            own = Q[rows]
            left = np.eye(Q.shape[1]) - own.T @ own
            if np.linalg.eigvalsh(left).min(initial=1.0) < _INDEPENDENT:
                return None
            r[rows] += own @ np.linalg.solve(left, own.T @ r[rows])
        return self._by_configuration(r)

    def _by_configuration(self, r: Array) -> HeldOut:
        count = 1 + max(int(g.max()) for g in self._groups)
        whitened = np.zeros(count)
        lengths = np.zeros(count)
        numbers = np.zeros(count)
        measured = np.zeros(count)
        begin = 0
        for k, (s, group) in enumerate(zip(self._problem.sets, self._groups, strict=True)):
            e = r[begin : begin + len(s) * s.width].reshape(len(s), s.width)
            begin += e.size
            weight = self._weights[k]
            known = weight > 0
            np.add.at(whitened, group, np.sum(e * e, axis=1))
            np.add.at(numbers, group, known * s.width)
            roots = np.sqrt(np.where(known, weight, 1.0))
            raw = self._noise.unwhitened(k, e / roots[:, None])[:, s.angular :]
            points = max(1, raw.shape[1] // 3)
            np.add.at(lengths, group, norms(raw) ** 2 / points * known)
            np.add.at(measured, group, known)
        seen = measured > 0
        return HeldOut(whitened[seen] / numbers[seen], lengths[seen] / measured[seen])


def _configurations(q: Array) -> NDArray[np.intp]:
    """Number (N,) of the configuration of each reading (N, m), in order of first appearance: equal to
    a thousandth of rad or m.
    """
    rounded = np.round(q, 3)
    _, first, label = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.intp)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[label.ravel()]


def joined(parts: Sequence[Array], rows: int) -> Array:
    """Bases (M, k) side by side."""
    return np.concatenate([np.empty((rows, 0)), *parts], axis=1)
