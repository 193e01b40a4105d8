"""Data of a calibration: the arm that was found, how well it is known, what was left over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...results import Result
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.identification import Identification
from .fit.losses import LossName
from .fit.minimise import Step
from .fit.noise import NoiseEstimate
from .measurements.poses import pose_error_jacobian
from .model.error_model import ErrorModel
from .model.parameters import Parameter
from .model.residuals import Residuals


class Outlier(NamedTuple):
    """A measurement that is off by more than one good one in 10⁴ would be.

    Parameters
    ----------
    set : int
        Its set of measurements.
    index : int
        Its index there.
    row : int
        Its row of q.
    """

    set: int
    index: int
    row: int


@dataclass(frozen=True, eq=False)
class CalibrationData(Result):
    """Everything that a calibration found; `Calibration` says what each field holds."""

    nominal: Chain
    chain: Chain
    parameters: tuple[Parameter, ...]
    values: Array = field(repr=False)
    covariance: Array = field(repr=False)
    frames: Mapping[str, Array]
    identification: Identification
    success: bool
    steps: tuple[Step, ...] = field(repr=False)
    before: Residuals = field(repr=False)
    after: Residuals = field(repr=False)
    cross_validation: CrossValidation | None = field(repr=False)
    outliers: tuple[Outlier, ...]
    noise_std: tuple[NoiseEstimate | None, ...]
    loss: LossName
    error_model: ErrorModel = field(repr=False)
    warnings: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def deviations(self) -> Array:
        """Standard deviations (P,) of the values."""
        return np.sqrt(np.diag(self.covariance))


def pose_covariance(found: CalibrationData, q: Any) -> Array:
    """Covariance (..., 6, 6) of the calibrated arm's pose at q; see `Calibration.pose_covariance`."""
    q = coordinates(q, found.nominal.q_names)
    rows = q.reshape(-1, found.nominal.dof)
    n = len(found.error_model.parameters)
    T, D = found.error_model.poses_and_twists(found.values[:n], rows)
    J = pose_error_jacobian(T, np.zeros((len(T), 6)), D)
    C = J @ found.covariance[:n, :n] @ np.swapaxes(J, 1, 2)
    return C.reshape(*q.shape[:-1], 6, 6)
