"""Jackknife of clusters: what a fit without a cluster of numbers would leave of its errors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ....groups.vectors import applied

_LEAST = 1e-6
"""Part of an error below which a fit left nothing of it: only its cluster knows of it."""


class _Alike(NamedTuple):
    """Clusters of one size m: the rows (G, m) of each, W (G, m, m) with W^T W = (I - Q_g Q_g^T)^-1, and
    errors (G, m) of the size of the noise along what a cluster alone tells.
    """

    rows: NDArray[np.intp]
    W: Array
    alone: Array


class Jackknife:
    """Errors e_g of each cluster g as a fit without it would leave them, a_g = (I - Q_g Q_g^T)^-1 e_g.

    Q (M + k, P): orthonormal columns, behind the measured rows those of a prior. Of what a cluster
    alone tells, the noise is what it is for the others. Source: Bell and McCaffrey 2002 (Survey
    Methodology 28), the jackknife CR3.
    """

    def __init__(
        self,
        Q: Array,
        clusters: NDArray[np.intp],
    ) -> None:
        self._Q = Q
        self._prior = Q[len(clusters) :]
        self._alike: list[_Alike] = []
        order = np.argsort(clusters, kind="stable")
        sizes = np.bincount(clusters)
        begins = np.cumsum(sizes) - sizes
        self.count = int(np.count_nonzero(sizes))
        for size in np.unique(sizes[sizes > 0]).tolist():
            firsts = begins[sizes == size]
            rows = order[firsts[:, None] + np.arange(size)]
            Q_g = Q[rows]
            left = np.eye(size) - Q_g @ np.swapaxes(Q_g, 1, 2)
            values, V = np.linalg.eigh(left)
            known = values > _LEAST
            roots = np.where(known, 1.0 / np.sqrt(np.maximum(values, _LEAST)), 0.0)
            W = np.swapaxes(V, 1, 2) * roots[..., None]
            self._alike.append(_Alike(rows, W, np.sum(V, axis=2, where=~known[:, None, :])))

    def meat(self, e: Array) -> Array:
        """M (P, P) = sum over g of Q_g^T a_g a_g^T Q_g, with the prior's rows as they are."""
        total = self._prior.T @ self._prior
        for rows, W, alone in self._alike:
            a = applied(np.swapaxes(W, 1, 2), applied(W, e[rows])) + alone
            u = applied(np.swapaxes(self._Q[rows], 1, 2), a)
            total += u.T @ u
        return total

    def meat_beside(
        self,
        U: Array,
        e: Array,
    ) -> Array:
        """The block (d, d) of `meat` that is of orthonormal columns U (M, d), fitted beside Q, by the
        errors e (M,) that both leave.

        u_g = U_g^T a_g = (I - U_g^T L^-1 U_g)^-1 U_g^T L^-1 e_g, with L = I - Q_g Q_g^T. Source:
        Woodbury 1950.
        """
        d = U.shape[1]
        total = np.zeros((d, d))
        for rows, W, _ in self._alike:  # U has no part along what a cluster alone tells of Q
            X = W @ U[rows]
            left, T = np.linalg.eigh(np.eye(d) - np.swapaxes(X, 1, 2) @ X)
            X = X @ T
            own = applied(np.swapaxes(X, 1, 2), applied(W, e[rows]))
            # of what a cluster alone tells of U, a unit error
            lengths = np.linalg.norm(np.swapaxes(W, 1, 2) @ X, axis=1)
            alone = 1.0 / np.maximum(lengths, 1.0)
            b = np.where(left > _LEAST, own / np.maximum(left, _LEAST), alone)
            u = applied(T, b)
            total += u.T @ u
        return total
