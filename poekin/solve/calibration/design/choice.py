"""Choice of configurations to measure at, and by how much it beats random choices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array

SMALLER_IS_BETTER = ("condition", "prediction")
"""Those of the design metrics of which smaller is better."""
_NAMES = {
    "amplification": "noise amplification index",
    "O1": "observability index O1",
    "condition": "condition",
    "smallest": "smallest singular value",
    "prediction": "predicted error",
}


class DesignMetrics(NamedTuple):
    """Metrics of a set of configurations: O1, condition, smallest and amplification, see
    `observability_indices`.

    prediction: the rms error that noise leaves in the calibrated model, over all candidates, ÷ that
    of one measurement.
    """

    O1: float
    condition: float
    smallest: float
    amplification: float
    prediction: float


@dataclass(frozen=True, eq=False)
class Choice:
    """Configurations to measure at.

    q (n, m), rad or m, and rows (n,), ascending: which of the candidates. criterion: what was
    optimised. metrics: of the choice; random_median: the median of each metric over `n_random`
    random choices of n candidates; random_best: the best of each. rank of identifiable: how many
    parameters the candidates identify, and how many can be identified in this way anywhere;
    unobserved: those that they do not, in words. candidates: how many there were.
    """

    q: Array
    rows: np.ndarray
    criterion: str
    metrics: DesignMetrics
    random_median: DesignMetrics
    random_best: DesignMetrics
    rank: int
    identifiable: int
    unobserved: tuple[str, ...]
    candidates: int
    n_random: int

    @property
    def improvement(self) -> DesignMetrics:
        """Factor by which the choice is better in each metric than the median random choice."""
        return DesignMetrics(*map(self._factor, DesignMetrics._fields))

    @property
    def criterion_improvement(self) -> float:
        """The improvement in the criterion."""
        return self._factor(self.criterion)

    def _factor(self, name: str) -> float:
        own = getattr(self.metrics, name)
        median = getattr(self.random_median, name)
        return _ratio(median, own) if name in SMALLER_IS_BETTER else _ratio(own, median)

    def summary(self) -> str:
        """The criterion of the choice and of random choices, and what is unobserved, as text."""
        own, median, best = (
            f"{getattr(metrics, self.criterion):.3g}"
            for metrics in (self.metrics, self.random_median, self.random_best)
        )
        words = (
            f"{len(self.q)} of {self.candidates} configurations for {self.rank} parameters: "
            f"{_NAMES[self.criterion]} {own}, {self.criterion_improvement:.2f} times better than "
            f"the median of {self.n_random} random choices ({median}, the best of them {best})"
        )
        if self.criterion != "prediction":
            left = _ratio(1.0, self.improvement.prediction)
            words += (
                f"; noise leaves {left:.2f} times the error in the calibrated arm that it leaves "
                "after those"
            )
        return "; unobserved from any of them: ".join([words, *self.unobserved])

    def __str__(self) -> str:
        return self.summary()


def _ratio(a: float, b: float) -> float:
    """a / b, of metrics that are 0 or infinite where random choices leave something unobserved."""
    if a == b:
        return 1.0
    if np.isinf(b):
        return 0.0
    return float(np.inf) if b == 0 else a / b
