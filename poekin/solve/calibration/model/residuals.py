"""Residuals: the difference of model and measurement, one by one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ....groups.arrays import Array
from ....groups.vectors import norms
from ....results import Result
from ..measurements.measurement import Measurement, Rows

FIELDS = ("length", "angle", "set", "row")


@dataclass(frozen=True, eq=False, repr=False)
class Residuals(Result):
    """Distances and turns of the model from the measurements, one by one.

    Attributes
    ----------
    length : (N,) ndarray
        Distance, m; of several points measured at once the root mean square.
    angle : (N,) ndarray
        Turn, rad; NaN where no angle is measured.
    set : (N,) ndarray of int
        Set of measurements that each belongs to.
    row : (N,) ndarray of int
        Row of q.
    """

    derived: ClassVar = ("rms_length", "median_length", "rms_angle", "median_angle")

    length: Array
    angle: Array
    set: Rows
    row: Rows

    @property
    def median_length(self) -> float:
        """Median distance, m."""
        return median(self.length)

    @property
    def rms_length(self) -> float:
        """Root mean square distance, m."""
        return rms(self.length)

    @property
    def median_angle(self) -> float:
        """Median turn, rad; NaN where no angle was measured."""
        return median(self.angle)

    @property
    def rms_angle(self) -> float:
        """Root mean square turn, rad; NaN where no angle was measured."""
        return rms(self.angle)

    def subset(self, chosen: NDArray[Any]) -> Residuals:
        """Residuals of some of the measurements.

        Parameters
        ----------
        chosen : (k,) ndarray of int or (N,) ndarray of bool
            Indices, or a mask.

        Returns
        -------
        residuals : Residuals
            Their residuals, m and rad.

        Raises
        ------
        IndexError
            If there is no measurement of such an index.

        Notes
        -----
        Source: none, it selects.
        """
        return Residuals(*(getattr(self, name)[chosen] for name in FIELDS))

    def of_set(self, k: int) -> Residuals:
        """Residuals of one set of measurements.

        Parameters
        ----------
        k : int
            Number of the set, from 0.

        Returns
        -------
        residuals : Residuals
            Their residuals, m and rad; none where there is no such set.

        Notes
        -----
        Raises: nothing. Source: none, it selects.
        """
        return self.subset(self.set == k)

    def __len__(self) -> int:
        return len(self.length)

    def summary(self) -> str:
        """Root mean squares and medians as text, in mm and mrad."""
        size = 1e3 * self.rms_length
        words = f"position {size:.3g} mm rms, median {1e3 * self.median_length:.3g} mm"
        if np.isnan(self.angle).all():
            return words
        size = 1e3 * self.rms_angle
        return f"{words}; rotation {size:.3g} mrad rms, median {1e3 * self.median_angle:.3g} mrad"


def residuals(
    sets: Sequence[Measurement],
    rows: Sequence[Rows],
    errors: Sequence[Array],
) -> Residuals:
    """Residuals of errors (N, d) of each set, at these rows of q."""
    parts = []
    for k, (s, e) in enumerate(zip(sets, errors, strict=True)):
        points = max(1, (s.width - s.angular) // 3)
        together = norms(e[:, s.angular :])
        length = together / np.sqrt(points)
        angle = np.full(len(e), np.nan)
        if s.angular:
            angle = norms(e[:, : s.angular])
        mine = np.full(len(e), k)
        parts.append(Residuals(length, angle, mine, rows[k]))
    return _stacked(parts)


def concatenate(parts: Sequence[Residuals]) -> Residuals:
    """All of these, in the order of set and row."""
    every = _stacked(parts)
    order = np.lexsort((every.row, every.set))
    return every.subset(order)


def _stacked(parts: Sequence[Residuals]) -> Residuals:
    columns = ([getattr(part, name) for part in parts] for name in FIELDS)
    return Residuals(*map(np.concatenate, columns))


def median(values: Array) -> float:
    """Median of the values that are not NaN; NaN without any."""
    return _known(np.median, values)


def rms(values: Array) -> float:
    """Root mean square of the values that are not NaN; NaN without any."""
    return math.sqrt(_known(np.mean, values**2))


def largest(values: Array) -> float:
    """Largest of the values that are not NaN; NaN without any."""
    return _known(np.max, values)


def _known(statistic: Callable[[Array], Any], values: Array) -> float:
    known = values[~np.isnan(values)]
    if len(known):
        return float(statistic(known))
    return np.nan
