"""Choice of configurations to measure at, and by how much it beats random choices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....results import Result
from .exchange import Criterion

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
    """Metrics of a set of configurations, as of `observability_indices` and by predicted errors.

    Parameters
    ----------
    O1, condition, smallest, amplification : float
        Observability indices.
    prediction : float
        Rms error that noise leaves in what the calibrated model predicts, over the workspace, ÷ the
        noise of a measured number; smaller is better.
    """

    O1: float
    condition: float
    smallest: float
    amplification: float
    prediction: float


@dataclass(frozen=True, eq=False, repr=False)
class Choice(Result):
    """Configurations to measure at, and by how much they beat random choices.

    Attributes
    ----------
    q : (n, m) ndarray
        The configurations, rad or m.
    rows : (n,) ndarray of int
        Their rows of the candidates, ascending.
    criterion : {"prediction", "O1", "amplification", "condition", "smallest"}
        Criterion that was optimised.
    metrics : DesignMetrics
        Metrics of the choice.
    random_median, random_best : DesignMetrics
        Median and best of each metric over random choices of n candidates.
    rank : int
        Number of parameters that the candidates identify.
    identifiable : int
        Number that such measurements can identify anywhere.
    unobserved : tuple of str
        Parameters that the candidates do not identify, in words.
    candidates : int
        Number of candidates that are allowed.
    n_random : int
        Number of random choices.
    measured : int
        Number of configurations that were measured before.
    """

    derived: ClassVar = ("improvement", "criterion_improvement")

    q: Array
    rows: np.ndarray
    criterion: Criterion
    metrics: DesignMetrics
    random_median: DesignMetrics
    random_best: DesignMetrics
    rank: int
    identifiable: int
    unobserved: tuple[str, ...]
    candidates: int
    n_random: int
    measured: int = 0

    @property
    def improvement(self) -> DesignMetrics:
        """Factor by which the choice is better in each metric than the median random choice."""
        return DesignMetrics(*map(self._factor, DesignMetrics._fields))

    @property
    def criterion_improvement(self) -> float:
        """Factor by which the choice is better in its criterion."""
        return self._factor(self.criterion)

    def _factor(self, name: str) -> float:
        own = getattr(self.metrics, name)
        median = getattr(self.random_median, name)
        if name in SMALLER_IS_BETTER:
            return _ratio(median, own)
        return _ratio(own, median)

    def summary(self) -> str:
        """The criterion of the choice and of random choices, and what is unobserved, as text."""
        own, median, best = (
            f"{getattr(metrics, self.criterion):.3g}"
            for metrics in (self.metrics, self.random_median, self.random_best)
        )
        beside = f" beside {self.measured} measured ones" * bool(self.measured)
        words = (
            f"{len(self.q)} of {self.candidates} configurations{beside} for {self.rank} parameters: "
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


def _ratio(a: float, b: float) -> float:
    """a / b, of metrics that are 0 or infinite where random choices leave something unobserved."""
    if a == b:
        return 1.0
    with np.errstate(divide="ignore"):
        return float(np.divide(a, b))
