"""Noise of the measurements: covariances as given, or standard deviations of angles and lengths
estimated from the residuals.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ..measurements.measurement import Measurement, per_error

_NORMAL = 0.6744897501960817  # the median of the absolute value of a normal number
LEAST = 1e-15
"""Standard deviations below it, of angles in rad and of lengths in reaches, are rounding."""


EVEN = 1e-6
"""Least ratio of the standard deviations of angles (rad) and lengths (reaches), and of its inverse:
angles that fit without error, such as those of an arm that does not turn, would leave the lengths
no weight.
"""


class NoiseEstimate(NamedTuple):
    """Standard deviations of one set of measurements, estimated from the residuals.

    Parameters
    ----------
    angle : float or None
        Of its angles, rad; None where no angle is measured.
    length : float
        Of its lengths, m.
    """

    angle: float | None
    length: float


class Noise:
    """Whitening of the errors of each set: e -> L^-1 e with C = L L^T.

    `noise_std` holds, for each set without covariances, the estimated standard deviations, and None
    for the others.
    """

    def __init__(
        self,
        sets: Sequence[Measurement],
        noise_std: Sequence[NoiseEstimate | None],
    ) -> None:
        self.noise_std = tuple(noise_std)
        self._whiten: list[Array] = []
        for s, estimate in zip(sets, noise_std, strict=True):
            if s.covariance is not None:
                self._whiten.append(np.linalg.inv(np.linalg.cholesky(s.covariance)))
            elif estimate is not None:
                sigma = per_error(s, estimate.angle, estimate.length)
                self._whiten.append(1.0 / sigma[:, None])

    def whitened(self, k: int, errors: Array) -> Array:
        """L^-1 times errors or a Jacobian (N, d, ...) of set k, given as (N, d, P)."""
        W = self._whiten[k]
        if W.ndim == 3:
            return W @ errors
        return W * errors

    def whitened_errors(self, k: int, errors: Array) -> Array:
        """L^-1 times the errors (N, d) of set k."""
        columns = errors[..., None]
        return self.whitened(k, columns)[..., 0]

    def stacked(self, errors: Sequence[Array]) -> Array:
        """L^-1 times the errors (N, d) of each set, one set behind the other (M,)."""
        of_sets = [self.whitened_errors(k, e).ravel() for k, e in enumerate(errors)]
        return np.concatenate(of_sets)

    def unwhitened(self, k: int, errors: Array) -> Array:
        """L times whitened errors (N, d) of set k."""
        W = self._whiten[k]
        if W.ndim == 3:
            solved: Any = np.linalg.solve(W, errors[..., None])
            return np.asarray(solved[..., 0], float)
        return errors / W[:, 0]

    def squares(self, errors: Sequence[Array]) -> list[Array]:
        """s = e^T C^-1 e of each measurement, of the errors (N, d) of each set."""
        whitened = (self.whitened(k, e[..., None]) for k, e in enumerate(errors))
        return [np.sum(e**2, axis=(1, 2)) for e in whitened]


def check(sets: Sequence[Measurement], n_equations: int, free: int) -> None:
    """Refuse to estimate the noise from residuals that the fit brings to zero: all would seem known
    without error.

    Raises: InputError.
    """
    if n_equations <= free and any(s.covariance is None for s in sets):
        raise InputError(
            f"{n_equations} equations for {free} parameters leave no residuals to estimate the "
            "noise from: measure more, or give covariance="
        )


def estimate_noise(
    sets: Sequence[Measurement],
    errors: Sequence[Array],
    free: int,
    robust: bool,
    reach: float,
    even: float = EVEN,
) -> list[NoiseEstimate | None]:
    """Noise of each set without covariances, from its errors (N, d) with `free` parameters fitted to
    all of them.

    Root mean square, or, robust, the median of absolute values made to agree with it for normal
    errors. That of angles in rad is at least `even` times that of lengths in reaches, and the other
    way round.
    """
    n_equations = sum(e.size for e in errors)
    inflation = (n_equations / max(n_equations - free, 1)) ** 0.5
    found: list[NoiseEstimate | None] = []
    for s, e in zip(sets, errors, strict=True):
        if s.covariance is not None:
            found.append(None)
            continue
        angle = inflation * _size(e[:, : s.angular], robust)
        length = inflation * _size(e[:, s.angular :], robust) / reach
        even_length = max(length, even * angle * bool(s.angular), LEAST)
        even_angle = max(angle, even * length, LEAST)
        found.append(NoiseEstimate(even_angle if s.angular else None, even_length * reach))
    return found


def _size(errors: Array, robust: bool) -> float:
    if not errors.size:
        return 0.0
    if robust:
        return float(np.median(np.abs(errors))) / _NORMAL
    return float(np.sqrt(np.mean(errors**2)))
