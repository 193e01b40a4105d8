"""Errors on held-out readings of many sets of terms, from one linearisation at a fit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms
from ..fit.fitting import Fit
from ..fit.losses import LossName, loss
from ..model.configurations import Folds, configurations
from ..model.problem import Problem
from ..model.tsqr import blocked_product
from .spans import INDEPENDENT, directions_beside, spanned


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
        scatter = np.std(self.whitened, ddof=1)
        return float(scatter / np.sqrt(len(self.whitened)))

    @property
    def rms_length(self) -> float:
        """Root mean square error, m."""
        mean = np.mean(self.lengths)
        return float(np.sqrt(mean))


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
        label = configurations(problem.q)
        self._groups = [label[rows] for rows in problem.rows]
        rows = self._weighted(fit.p, name)
        groups = list(directions.values())
        every = np.concatenate(groups, axis=1)
        columns = blocked_product(rows[:, :-1], every)
        self._Q, in_Q = spanned(columns)
        widths = [D.shape[1] for D in groups]
        *inner, _ = np.cumsum(widths)
        parts = np.split(in_Q, inner, axis=1)
        self._columns = dict(zip(directions, parts, strict=True))
        self._b = rows[:, -1]
        of_readings = folds.of(label)
        numbers = []
        for own, measured in zip(problem.rows, problem.sets, strict=True):
            numbers.append(np.repeat(of_readings[own], measured.width))
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
            root = np.sqrt(weight)
            stacked = np.concatenate([J, e], axis=2)
            rows = stacked * root[:, None, None]
            width = rows.shape[2]
            found.append(rows.reshape(-1, width))
        return np.concatenate(found)

    @property
    def nothing(self) -> Array:
        """W of no columns."""
        return np.empty((self._Q.shape[1], 0))

    def with_group(self, W: Array, name: str) -> Array:
        """W and more columns: those of a group, as far as they are not in the span of W."""
        independent = directions_beside(W, self._columns[name])
        return np.concatenate([W, independent], axis=1)

    def held_out(self, W: Array) -> HeldOut | None:
        """Errors with these columns fitted; None where a fold has to itself what some are known by."""
        r = self._b.copy()
        total = self._Q.T @ r
        for rows in self._folds:
            own = self._Q[rows]
            QW = blocked_product(own, W)
            left = np.eye(W.shape[1]) - QW.T @ QW
            values = np.linalg.eigvalsh(left)
            least = values.min(initial=1.0)
            if least < INDEPENDENT:
                return None
            of_others = total - own.T @ r[rows]
            z = np.linalg.solve(left, W.T @ of_others)
            r[rows] -= QW @ z
        return self._by_configuration(r)

    def _by_configuration(self, r: Array) -> HeldOut:
        last = max(int(g.max()) for g in self._groups)
        count = last + 1
        whitened = np.zeros(count)
        lengths = np.zeros(count)
        numbers = np.zeros(count)
        measured = np.zeros(count)
        begin = 0
        for k, s in enumerate(self._problem.sets):
            group = self._groups[k]
            weight = self._weights[k]
            end = begin + len(s) * s.width
            own = r[begin:end]
            e = own.reshape(len(s), s.width)
            begin = end
            known = weight > 0
            squares = np.sum(e * e, axis=1)
            np.add.at(whitened, group, squares)
            np.add.at(numbers, group, known * s.width)
            weights = np.where(known, weight, 1.0)
            roots = np.sqrt(weights)
            unweighted = e / roots[:, None]
            raw = self._noise.unwhitened(k, unweighted)
            linear = raw[:, s.angular :]
            points = max(1, linear.shape[1] // 3)
            of_points = norms(linear) ** 2 / points
            np.add.at(lengths, group, of_points * known)
            np.add.at(measured, group, known)
        seen = measured > 0
        whitened = whitened[seen] / numbers[seen]
        lengths = lengths[seen] / measured[seen]
        return HeldOut(whitened, lengths)
