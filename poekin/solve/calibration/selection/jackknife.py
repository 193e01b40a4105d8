"""Jackknife of clusters: what a fit without a cluster of numbers would leave of its errors."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ....groups.vectors import applied

_LEAST = 1e-6
"""Part of an error below which a fit left nothing of it: only its cluster knows of it."""


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
        # of clusters of one size m: their rows (G, m), the inverses (G, m, m) of I - Q_g Q_g^T, and
        # errors (G, m) along what a cluster alone tells
        self._alike: list[tuple[NDArray[np.intp], Array, Array]] = []
        order = np.argsort(clusters, kind="stable")
        sizes = np.bincount(clusters)
        begins = np.cumsum(sizes) - sizes
        self.count = int(np.count_nonzero(sizes))
        for size in np.unique(sizes).tolist():
            firsts = begins[sizes == size]
            rows = order[firsts[:, None] + np.arange(size)]
            Q_g = Q[rows]
            left = np.eye(size) - Q_g @ np.swapaxes(Q_g, 1, 2)
            self._alike.append((rows, *_inverse(left)))

    def meat(self, e: Array) -> Array:
        """M (P, P) = sum over g of Q_g^T a_g a_g^T Q_g, with the prior's rows as they are."""
        total = self._prior.T @ self._prior
        for rows, inverse, alone in self._alike:
            a = applied(inverse, e[rows]) + alone
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
        for rows, inverse, _ in self._alike:  # U has no part along what a cluster alone tells of Q
            back = np.swapaxes(inverse @ U[rows], 1, 2)
            own, alone = _inverse(np.eye(d) - back @ U[rows])
            u = applied(own, applied(back, e[rows])) + alone
            total += u.T @ u
        return total


def _inverse(A: Array) -> tuple[Array, Array]:
    """Inverses of symmetric A (G, n, n) but along directions where nothing is left, and sums (G, n) of
    these.
    """
    squares = np.square(np.eye(A.shape[1]) - A).sum(axis=(1, 2))
    if squares.max(initial=0.0) < 0.25:
        # no eigenvalue is below a half: to invert is many times quicker than to find them
        inverses: Any = np.linalg.inv(A)
        return inverses, np.zeros(A.shape[:2])
    values, V = np.linalg.eigh(A)
    known = (values > _LEAST)[:, None, :]
    scaled = np.where(known, V / np.maximum(values, _LEAST)[:, None, :], 0.0)
    return scaled @ np.swapaxes(V, 1, 2), np.sum(V, axis=2, where=~known)
