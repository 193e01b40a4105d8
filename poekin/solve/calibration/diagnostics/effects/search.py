"""Search of effects in residuals: the surest first, the others beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from .....groups.arrays import Array
from ...fit.covariance import clusters_of
from ...fit.fitting import Fit
from ...fit.losses import OUTLIER, LossName, chi_square, loss
from ...model.problem import Problem
from ...terms.conditions import Conditions
from .columns import Effect, effects, parts
from .effect_test import EffectTest
from .f_test import Left, Tested, coefficients, f_test, left_of
from .loose import reflectors

LEVEL = 0.05
"""Chance of any false verdict, where nothing but noise is left."""
_ROUNDING = 1e-9  # m: residuals that are smaller show nothing


class EffectSearch:
    """Forward selection of effects in the whitened errors (M,) of a fit.

    `findings`: effects at `LEVEL`, each tested with those before it in the fit, as one that is there
    makes others seem to be. `tests`: each in the first round. Chances are corrected for the number
    of tests (Bonferroni).
    """

    def __init__(
        self,
        problem: Problem,
        fit: Fit,
        name: LossName,
        conditions: Conditions,
    ) -> None:
        self._problem = problem
        self._fit = fit
        self._parts = parts(problem)
        self._errors = fit.noise.stacked(problem.errors(fit.p))
        self._roots = self._weights(name)
        # Tukey's loss has no weight where a reflector moved far
        self._roots_of_loose = self._weights("linear" if name == "linear" else "cauchy")
        self._firm = np.ones(len(self._roots), bool)  # not of a loose reflector
        self._fitted = fit.jacobian
        self._explained = np.zeros_like(self._roots)
        self._clusters = clusters_of(problem)
        self._gone: dict[int, list[int]] = {}
        self.findings: list[EffectTest] = []
        self.tests: list[EffectTest] = []
        if self._length(self._weighted(self._errors)) > _ROUNDING:
            self._reflectors = reflectors(problem, fit)
            self._run(effects(problem, fit, conditions))

    def _weights(
        self,
        name: LossName,
    ) -> Array:
        """Roots (M,) of the weights that the loss gives."""
        found = []
        squares = self._fit.noise.squares(self._problem.errors(self._fit.p))
        for s, measured in zip(squares, self._problem.sets, strict=True):
            weight = loss(name, s, measured.width).weight
            found.append(np.repeat(np.sqrt(weight), measured.width))
        return np.concatenate(found)

    def _run(
        self,
        every: list[Effect],
    ) -> None:
        count = 0
        while True:
            round_ = list(self._tests(every))
            count = count or len(round_)
            found = [test._replace(p=min(count * test.p, 1.0)) for test, _ in round_]
            if not self.tests:
                self.tests = sorted(found, key=lambda test: test.p)
            best = min(range(len(found)), key=lambda i: found[i].p, default=None)
            if best is None or found[best].p > LEVEL:
                return
            self.findings.append(found[best])
            taken = round_[best][1]
            self._take(taken)
            every = [effect for effect in every if effect is not taken]

    def _take(
        self,
        effect: Effect | tuple[int, int],
    ) -> None:
        """Fit an effect, too; leave out a loose reflector, point j of set k."""
        if isinstance(effect, Effect):
            self._fitted = np.concatenate([self._fitted, effect.columns], axis=1)
            self._explained = self._by_effects()
            return
        k, j = effect
        self._gone.setdefault(k, []).append(j)
        part = self._parts[k]
        begin = part.start + 3 * j
        width = self._problem.sets[k].width
        for axis in range(3):
            self._firm[begin + axis : part.stop : width] = False

    def _by_effects(self) -> Array:
        """Part (M,) of the errors that the effects explain, fitted together with all else."""
        z = self._coefficients()
        z[: self._fit.jacobian.shape[1]] = 0.0
        return self._fitted @ z

    def _coefficients(self) -> Array:
        """Least squares (P,) of the errors, of all that was fitted."""
        return coefficients(self._weighted(self._fitted), self._weighted(self._errors))

    def _tests(
        self, every: Sequence[Effect]
    ) -> Iterator[tuple[EffectTest, Effect | tuple[int, int]]]:
        left = self._left()
        for effect in every:
            columns = self._weighted(effect.columns)
            found = f_test(left, columns)
            if found is not None:
                yield self._named(effect, columns, found), effect
        for k, points in self._reflectors.items():
            own = self._parts[k]
            e = (self._errors - self._explained)[own]
            for j, test in points.tests(
                e, self._roots_of_loose[own], self._gone.get(k, [])
            ).items():
                yield test, (k, j)

    def _named(
        self,
        effect: Effect,
        columns: Array,
        found: Tested,
    ) -> EffectTest:
        explained = found.U @ found.s
        # errors are model - measured: what is there has the other sign
        along = -explained @ columns
        against = effect.kind == "gravity" and bool(np.sum(along) < 0.0)
        return EffectTest(effect.kind, effect.whose, found.p, self._length(explained), against)

    @property
    def _kept(self) -> NDArray[np.bool_]:
        return self._firm & (self._roots > 0.0)

    def _weighted(
        self,
        numbers: Array,
    ) -> Array:
        """Numbers (M, ...) that count, with the roots of their weights."""
        roots = self._roots.reshape(-1, *[1] * (numbers.ndim - 1))
        return (numbers * roots)[self._kept]

    def _left(self) -> Left:
        clusters = self._clusters
        if clusters is not None:
            clusters = clusters[self._kept]
        return left_of(self._weighted(self._errors), self._weighted(self._fitted), clusters)

    def _length(
        self,
        weighted: Array,
    ) -> float:
        """Root mean square length of errors that count, m."""
        whitened = np.zeros(len(self._kept))
        whitened[self._kept] = weighted / self._roots[self._kept]
        squares = 0.0
        count = 0
        for k, s in enumerate(self._problem.sets):
            own = whitened[self._parts[k]].reshape(-1, s.width)
            lengths = self._fit.noise.unwhitened(k, own)[:, s.angular :]
            squares += float(np.sum(lengths * lengths))
            count += len(s) * max(1, lengths.shape[1] // 3)
        return float(np.sqrt(squares / count))

    def gross(self) -> list[Array]:
        """Mask (N,) of the outliers of each set beside the effects that were found: measurements that
        are off by more than one good one in 10^4 would be.
        """
        e = (self._errors - self._fitted @ self._coefficients()) * self._firm
        of_kept = e[self._kept] * self._roots[self._kept]
        variance = float(of_kept @ of_kept) / max(len(of_kept) - self._fitted.shape[1], 1)
        found = []
        for s, part in zip(self._problem.sets, self._parts, strict=True):
            rows = e[part].reshape(-1, s.width)
            squares = np.sum(rows**2, axis=1)
            width = np.count_nonzero(self._firm[part]) / len(s)
            scale = variance if s.covariance is None else 1.0
            found.append(squares > scale * chi_square(width, OUTLIER))
        return found
