"""Residuals: the difference of model and measurement, one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ..measurements.measurement import Measurement, Rows


@dataclass(frozen=True, eq=False)
class Residuals:
    """Distance `length` (N,) in m and turn `angle` (N,) in rad of model from measurement; NaN where
    none is measured.

    Of several points measured at once, `length` is the root mean square. set, row (N,): the set of
    measurements that each belongs to, and the row of q.
    """

    length: Array
    angle: Array
    set: Rows
    row: Rows

    @property
    def median_length(self) -> float:
        """Median distance, m."""
        return _median(self.length)

    @property
    def rms_length(self) -> float:
        """Root mean square distance, m."""
        return _rms(self.length)

    @property
    def median_angle(self) -> float:
        """Median turn, rad; NaN where no angle was measured."""
        return _median(self.angle)

    @property
    def rms_angle(self) -> float:
        """Root mean square turn, rad; NaN where no angle was measured."""
        return _rms(self.angle)

    def subset(self, chosen: NDArray[Any]) -> Residuals:
        """Residuals of the measurements `chosen`, indices (k,) or a mask. Raises: nothing of its own.

        Source: none, it selects.
        """
        return Residuals(
            self.length[chosen], self.angle[chosen], self.set[chosen], self.row[chosen]
        )

    def __len__(self) -> int:
        return len(self.length)

    def __str__(self) -> str:
        rms = 1e3 * self.rms_length
        words = f"position {rms:.3g} mm rms, median {1e3 * self.median_length:.3g} mm"
        if np.isnan(self.angle).all():
            return words
        rms = 1e3 * self.rms_angle
        return f"{words}; rotation {rms:.3g} mrad rms, median {1e3 * self.median_angle:.3g} mrad"


def residuals(
    sets: Sequence[Measurement], rows: Sequence[Rows], errors: Sequence[Array]
) -> Residuals:
    """Residuals of errors (N, d) of each set, at these rows of q."""
    parts = []
    for k, (s, e) in enumerate(zip(sets, errors, strict=True)):
        points = max(1, (s.width - s.angular) // 3)
        length = np.linalg.norm(e[:, s.angular :], axis=1) / np.sqrt(points)
        angle = np.full(len(e), np.nan)
        if s.angular:
            angle = np.linalg.norm(e[:, : s.angular], axis=1)
        parts.append(Residuals(length, angle, np.full(len(e), k), rows[k]))
    return _stacked(parts)


def concatenate(parts: Sequence[Residuals]) -> Residuals:
    """All of these, in the order of set and row."""
    every = _stacked(parts)
    return every.subset(np.lexsort((every.row, every.set)))


def _stacked(parts: Sequence[Residuals]) -> Residuals:
    names = ("length", "angle", "set", "row")
    return Residuals(*(np.concatenate([getattr(p, name) for p in parts]) for name in names))


def _median(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(np.median(known)) if len(known) else np.nan


def _rms(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else np.nan
