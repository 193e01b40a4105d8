"""What a choice of configurations is worth, and by how much it beats random ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array

SMALLER = ("condition", "prediction")
"""Of these figures smaller is better."""


class Figures(NamedTuple):
    """How much a set of configurations shows: O1, condition, smallest and amplification, see
    `indices`.

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

    q (n, m), rad or m, and rows (n,), ascending: which of the candidates. by: what was bettered.
    figures: of the choice; random: the median of each figure over `compare` random choices of n
    candidates; best: the best of each. rank of expected: how many parameters the candidates show,
    and how many can be seen in this way anywhere; unseen: those that they do not, in words.
    candidates: how many there were.
    """

    q: Array
    rows: np.ndarray
    by: str
    figures: Figures
    random: Figures
    best: Figures
    rank: int
    expected: int
    unseen: tuple[str, ...]
    candidates: int
    compare: int

    @property
    def gains(self) -> Figures:
        """By what factor the choice is better in each figure than the median random choice."""
        pairs = zip(Figures._fields, self.figures, self.random, strict=True)
        return Figures(
            *(
                _over(theirs, own) if name in SMALLER else _over(own, theirs)
                for name, own, theirs in pairs
            )
        )

    @property
    def gain(self) -> float:
        """The gain in what was bettered."""
        return getattr(self.gains, self.by)

    def __str__(self) -> str:
        own, median, best = (
            f"{getattr(x, self.by):.3g}" for x in (self.figures, self.random, self.best)
        )
        said = (
            f"{len(self.q)} of {self.candidates} configurations for {self.rank} parameters: {_NAMES[self.by]} {own}, "
            f"{self.gain:.2f} times better than the median of {self.compare} random choices ({median}, the best of "
            f"them {best})"
        )
        if self.by != "prediction":
            left = _over(1.0, self.gains.prediction)
            said += f"; noise leaves {left:.2f} times the error in the calibrated arm that it leaves after those"
        return "; not seen from any of them: ".join([said, *self.unseen])


_NAMES = {
    "amplification": "noise amplification index", "O1": "observability index O1", "condition": "condition",
    "smallest": "smallest singular value", "prediction": "predicted error",
}  # fmt: skip


def _over(a: float, b: float) -> float:
    """a / b, of figures that are 0 or infinite where random choices leave something unseen."""
    if a == b:
        return 1.0
    return 0.0 if np.isinf(b) else float(np.inf) if b == 0 else a / b
