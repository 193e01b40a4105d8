"""Loose reflectors: points of the tool that move against the others, whatever the arm does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

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

    def tests(
        self,
        whitened: Array,
        gone: Sequence[int],
    ) -> dict[int, EffectTest]:
        """Test of each point but those that are loose, by whitened errors (M,); none where fewer than
        three tell.

        Source: F-test of two variances, exact for normal errors.
        """
        if self.count - len(gone) < _LEAST:
            return {}
        e = whitened.reshape(len(self.errors), -1)
        before, rank_before = self._left(e, gone)
        found = {}
        for j in range(self.count):
            after, rank = self._left(e, [*gone, j])
            d = rank - rank_before
            freedom = e.size - rank
            if j in gone or d == 0 or freedom == 0:
                continue
            variance = max(after / freedom, np.finfo(float).tiny)
            F = (before - after) / d / variance
            size = rms(norms(self.errors[:, 3 * j : 3 * j + 3]))
            found[j] = EffectTest("loose", self.names[j], f_survival(F, d, freedom), size)
        return found

    def _left(
        self,
        e: Array,
        loose: Sequence[int],
    ) -> tuple[float, int]:
        """Sum of squares that motions of the tool and of these points leave of errors (N, d), and the
        rank of these motions.
        """
        own = [3 * j + axis for j in loose for axis in range(3)]
        columns = np.concatenate([self._rigid, self._shifts[..., own]], axis=2)
        U, s, _ = np.linalg.svd(columns, full_matrices=False)
        kept = s > _RANK * s[:, :1]
        along = np.einsum("ndk,nd->nk", U, e) * kept
        squares = float(np.sum(e**2) - np.sum(along**2))
        return squares, int(kept.sum())


def reflectors(
    problem: Problem,
    fit: Fit,
) -> dict[int, Reflectors]:
    """Reflectors of each set of three points or more."""
    return {
        k: Reflectors(problem, fit, k)
        for k, s in enumerate(problem.sets)
        if isinstance(s, Points) and len(s.points) >= _LEAST
    }
