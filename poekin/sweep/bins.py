"""Cells that are none of space: bins of a measure, and a list of the best samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..groups.arrays import Array


@dataclass(frozen=True)
class Bins:
    """Equal parts of a range of the measure, in SI units."""

    lower: float
    upper: float
    count: int

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel."""
        return np.array([-1, self.count, 0, 0], np.int64)

    def place(self) -> Array:
        """Place of the bins, for the kernel."""
        return np.array([self.lower, 0.0, 0.0, self.count / (self.upper - self.lower)])

    def describe(self) -> dict[str, object]:
        """Plain data of the bins."""
        return {"lower": self.lower, "upper": self.upper, "bins": self.count}


@dataclass(frozen=True)
class TopList:
    """All samples in one cell, of which a number of the best is kept."""

    length: int

    count = 1

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel."""
        return np.array([-2, 1, 0, 0], np.int64)

    def place(self) -> Array:
        """It has none."""
        return np.zeros(4)

    def describe(self) -> dict[str, object]:
        """Plain data of the list."""
        return {"top": self.length}
