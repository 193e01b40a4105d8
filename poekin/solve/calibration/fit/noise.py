"""How far measurements scatter: covariances as given, or spreads of angles and lengths estimated
from the residuals.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ..measurements.measurement import Measurement

_NORMAL = 0.6744897501960817  # the median of the absolute value of a normal number
LEAST = 1e-15
"""Spreads below it, of angles in rad and of lengths in reaches, are rounding."""


EVEN = 1e-6
"""Angles that fit without error, such as those of an arm that does not turn, would leave the
lengths no weight.
"""


class Spread(NamedTuple):
    """Standard deviations of one set of measurements: of its angles (rad; None without any) and its
    lengths (m).
    """

    angle: float | None
    length: float


class Noise:
    """What whitens the errors of each set: e -> L^-1 e with C = L L^T.

    `spreads` holds, for each set without covariances, what they are estimated to be, and None for
    the others.
    """

    def __init__(self, sets: Sequence[Measurement], spreads: Sequence[Spread | None]):
        self.spreads = tuple(spreads)
        self._whiten: list[Array] = []
        for s, spread in zip(sets, spreads, strict=True):
            if s.covariance is not None:
                self._whiten.append(np.linalg.inv(np.linalg.cholesky(s.covariance)))
            elif spread is not None:
                deviations = [spread.angle or 1.0] * s.angular + [spread.length] * (
                    s.width - s.angular
                )
                self._whiten.append(1.0 / np.array(deviations)[:, None])

    def whitened(self, k: int, errors: Array) -> Array:
        """L^-1 times errors or slopes (N, d, ...) of set k, given as (N, d, P)."""
        W = self._whiten[k]
        return W @ errors if W.ndim == 3 else W * errors

    @property
    def estimated(self) -> bool:
        """Whether a spread was estimated."""
        return any(spread is not None for spread in self.spreads)


def check(sets: Sequence[Measurement], numbers: int, free: int) -> None:
    """Refuse to estimate spreads from residuals that the fit brings to zero: all would seem known
    without error.

    Raises: InputError.
    """
    if numbers <= free and any(s.covariance is None for s in sets):
        raise InputError(
            f"{numbers} numbers for {free} parameters leave nothing to tell from how far they scatter: measure more, "
            "or say it with covariance="
        )


def spreads(
    sets: Sequence[Measurement],
    errors: Sequence[Array],
    free: int,
    robust: bool,
    reach: float,
    even: float = EVEN,
) -> list[Spread | None]:
    """The spread of each set without covariances, from its errors (N, d) with `free` parameters
    fitted to all of them.

    Root mean square, or, robust, the median of absolute values made to agree with it for normal
    errors. That of angles in rad is at least `even` times that of lengths in reaches, and the other
    way round.
    """
    numbers = sum(e.size for e in errors)
    more = (numbers / max(numbers - free, 1)) ** 0.5
    found: list[Spread | None] = []
    for s, e in zip(sets, errors, strict=True):
        if s.covariance is not None:
            found.append(None)
            continue
        angles, lengths = e[:, : s.angular], e[:, s.angular :]
        angle = more * _size(angles, robust)
        length = more * _size(lengths, robust) / reach
        of_angles, of_lengths = (
            max(angle, even * length, LEAST),
            max(length, even * angle * bool(s.angular), LEAST),
        )
        found.append(Spread(of_angles if s.angular else None, of_lengths * reach))
    return found


def _size(errors: Array, robust: bool) -> float:
    if not errors.size:
        return 0.0
    return (
        float(np.median(np.abs(errors))) / _NORMAL if robust else float(np.sqrt(np.mean(errors**2)))
    )
