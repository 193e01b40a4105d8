"""How far measurements scatter: covariances as given, or spreads of angles and lengths estimated from the residuals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from .measurement import Measurement

_NORMAL = 0.6744897501960817  # the median of the absolute value of a normal number
LEAST = 1e-15
"""Spreads below it, of angles in rad and of lengths in reaches, are rounding."""


class Spread(NamedTuple):
    """Standard deviations of one set of measurements: of its angles (rad; None without any) and its lengths (m)."""

    angle: float | None
    length: float


class Noise:
    """What whitens the errors of each set: e -> L^-1 e with C = L L^T.

    `spreads` holds, for each set without covariances, what they are estimated to be, and None for the others.
    """

    def __init__(self, sets: Sequence[Measurement], spreads: Sequence[Spread | None]):
        self.spreads = tuple(spreads)
        self._whiten: list[Array] = []
        for s, spread in zip(sets, spreads, strict=True):
            if s.covariance is not None:
                self._whiten.append(np.linalg.inv(np.linalg.cholesky(s.covariance)))
            elif spread is not None:
                deviations = [spread.angle or 1.0] * s.angular + [spread.length] * (s.width - s.angular)
                self._whiten.append(1.0 / np.array(deviations)[:, None])

    def whitened(self, k: int, errors: Array) -> Array:
        """L^-1 times errors or slopes (N, d, ...) of set k, given as (N, d, P)."""
        W = self._whiten[k]
        return W @ errors if W.ndim == 3 else W * errors

    @property
    def estimated(self) -> bool:
        """Whether a spread was estimated."""
        return any(spread is not None for spread in self.spreads)


def spreads(
    sets: Sequence[Measurement], errors: Sequence[Array], free: int, robust: bool, reach: float
) -> list[Spread | None]:
    """The spread of each set without covariances, from its errors (N, d) with `free` parameters fitted to all of them.

    Root mean square, or, robust, the median of absolute values made to agree with it for normal errors.
    """
    numbers = sum(e.size for e in errors)
    more = (numbers / max(numbers - free, 1)) ** 0.5
    found: list[Spread | None] = []
    for s, e in zip(sets, errors, strict=True):
        if s.covariance is not None:
            found.append(None)
            continue
        angles, lengths = e[:, : s.angular], e[:, s.angular :]
        angle = more * _size(angles, robust) if s.angular else None
        found.append(
            Spread(None if angle is None else max(angle, LEAST), max(more * _size(lengths, robust), LEAST * reach))
        )
    return found


def _size(errors: Array, robust: bool) -> float:
    if not errors.size:
        return 0.0
    return float(np.median(np.abs(errors))) / _NORMAL if robust else float(np.sqrt(np.mean(errors**2)))
