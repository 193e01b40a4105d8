"""How far a model is off the measurements, one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....groups.arrays import Array
from ..measurements.measurement import Indices, Measurement


@dataclass(frozen=True, eq=False)
class Residuals:
    """Distance `length` (N,) in m and turn `angle` (N,) in rad of model from measurement; NaN where
    none is measured.

    Of several points measured at once, `length` is the root mean square. set, row (N,): the set of
    measurements that each belongs to, and the row of q.
    """

    length: Array
    angle: Array
    set: Indices
    row: Indices

    @property
    def median_length(self) -> float:
        """Median distance, m."""
        return _of(np.median, self.length)

    @property
    def rms_length(self) -> float:
        """Root mean square distance, m."""
        return _of(_rms, self.length)

    @property
    def median_angle(self) -> float:
        """Median turn, rad; NaN where no angle was measured."""
        return _of(np.median, self.angle)

    @property
    def rms_angle(self) -> float:
        """Root mean square turn, rad; NaN where no angle was measured."""
        return _of(_rms, self.angle)

    def __len__(self) -> int:
        return len(self.length)

    def __str__(self) -> str:
        words = (
            f"position {1e3 * self.rms_length:.3g} mm rms, median {1e3 * self.median_length:.3g} mm"
        )
        if np.isnan(self.angle).all():
            return words
        return f"{words}; rotation {1e3 * self.rms_angle:.3g} mrad rms, median {1e3 * self.median_angle:.3g} mrad"


def residuals(
    sets: Sequence[Measurement], rows: Sequence[Indices], errors: Sequence[Array]
) -> Residuals:
    """Residuals of errors (N, d) of each set, at these rows of q."""
    lengths, angles, number = [], [], []
    for k, (s, e) in enumerate(zip(sets, errors, strict=True)):
        points = max(1, (s.width - s.angular) // 3)
        lengths.append(np.linalg.norm(e[:, s.angular :], axis=1) / np.sqrt(points))
        angles.append(
            np.linalg.norm(e[:, : s.angular], axis=1) if s.angular else np.full(len(e), np.nan)
        )
        number.append(np.full(len(e), k))
    return Residuals(
        np.concatenate(lengths), np.concatenate(angles), np.concatenate(number), np.concatenate(rows)
    )  # fmt: skip


def joined(parts: Sequence[Residuals]) -> Residuals:
    """All of these, in the order of set and row."""
    length, angle, number, row = (
        np.concatenate([getattr(p, name) for p in parts])
        for name in ("length", "angle", "set", "row")
    )
    order = np.lexsort((row, number))
    return Residuals(length[order], angle[order], number[order], row[order])


def _rms(values: Array) -> Array:
    return np.sqrt(np.mean(values**2))


def _of(what, values: Array) -> float:  # type: ignore[no-untyped-def]
    known = values[~np.isnan(values)]
    return float(what(known)) if len(known) else float("nan")
