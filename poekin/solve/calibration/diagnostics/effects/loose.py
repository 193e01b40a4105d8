"""Loose reflectors: points of the tool that move against the others, whatever the arm does."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .....groups.arrays import Array
from .....groups.vectors import norms
from ...fit.fitting import Fit
from ...measurements.points import Points
from ...model.problem import Problem
from ...model.residuals import rms
from .columns import point_shifts, reflector_name
from .effect_test import EffectTest
from .f_test import f_survival

_LEAST = 3  # points whose distances say which of them moved
_RANK = 1e-6


class Reflectors:
    """Points of one set; `numbers` (M,) are its errors among all.

    Of each configuration's errors, what no motion of the tool makes is looked at: what a point's
    own motion explains of it, and what it does not.
    """

    def __init__(
        self,
        problem: Problem,
        fit: Fit,
        k: int,
    ) -> None:
        base = np.tile(np.eye(6), (len(problem.q), 1, 1))
        rigid = problem.along_twists(fit.p, base)[k]
        self.errors = problem.errors(fit.p)[k]
        self.count = self.errors.shape[1] // 3
        self.names = [reflector_name(problem, k, j) for j in range(self.count)]
        self._rigid = fit.noise.whitened(k, rigid)
        self._shifts = fit.noise.whitened(k, point_shifts(problem, fit.p, k))
        self._motions = functools.cache(self._motions_of)  # each round of a search asks again

    def tests(
        self,
        whitened: Array,
        roots: Array,
        gone: Sequence[int],
    ) -> dict[int, EffectTest]:
        """Test of each point but those that are loose, by whitened errors (M,) and the roots (M,) of
        their weights; none where fewer than three tell.

        Source: F-test of two variances, exact for normal errors; where these scatter more at some
        configurations than at others, by the effective degrees of freedom of Satterthwaite 1946.
        """
        if self.count - len(gone) < _LEAST:
            return {}
        e = whitened.reshape(len(self.errors), -1)
        weights = roots.reshape(e.shape)[:, 0] ** 2
        counting = np.count_nonzero(weights)
        firm = np.delete(e.reshape(len(e), -1, 3), gone, axis=1)
        share = _effective(weights * np.sum(firm**2, axis=(1, 2)), firm[0].size)
        before, rank_before = self._left(e, weights, gone)
        found = {}
        for j in range(self.count):
            after, rank = self._left(e, weights, [*gone, j])
            d = rank - rank_before
            freedom = e.shape[1] * counting - rank
            if j in gone or d == 0 or freedom == 0:
                continue
            variance = max(after / freedom, np.finfo(float).tiny)
            F = (before - after) / d / variance
            p = f_survival(F, share * d, share * freedom)
            size = rms(norms(self.errors[:, 3 * j : 3 * j + 3]))
            found[j] = EffectTest("loose", self.names[j], p, size)
        return found

    def _left(
        self,
        e: Array,
        weights: Array,
        loose: Sequence[int],
    ) -> tuple[float, int]:
        """Weighted sum of squares that motions of the tool and of these points leave of errors (N, d),
        and the rank of these motions where there is a weight.
        """
        U, kept = self._motions(tuple(loose))
        along = np.einsum("ndk,nd->nk", U, e) * kept
        squares = np.sum(e**2, axis=1) - np.sum(along**2, axis=1)
        return float(weights @ squares), int(kept[weights > 0.0].sum())

    def _motions_of(
        self,
        loose: tuple[int, ...],
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Orthonormal directions U (N, d, k) of motions of the tool and of these points, and which of
        them (N, k) there are.
        """
        own = [3 * j + axis for j in loose for axis in range(3)]
        columns = np.concatenate([self._rigid, self._shifts[..., own]], axis=2)
        U, s, _ = np.linalg.svd(columns, full_matrices=False)
        return U, s > _RANK * s[:, :1]


def _effective(squares: Array, width: int) -> float:
    """Part of the configurations that count, by their weighted squares (N,) of so many numbers: 1 where
    all scatter alike, some 1 / N where nearly all is in one.

    The mean of the squares' squares is 1 + 2 / width times that of their scales, for normal errors.
    """
    most = np.count_nonzero(squares)
    alike = (
        (1.0 + 2.0 / width) * np.sum(squares) ** 2 / max(np.sum(squares**2), np.finfo(float).tiny)
    )
    return min(float(alike) / max(most, 1), 1.0)


def reflectors(
    problem: Problem,
    fit: Fit,
) -> dict[int, Reflectors]:
    """Reflectors of each set of three points or more."""
    return {
        k: Reflectors(problem, fit, k)
        for k, s in enumerate(problem.sets)
        if isinstance(s, Points) and s.width >= 3 * _LEAST
    }
