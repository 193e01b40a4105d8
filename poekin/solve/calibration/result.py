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
from .model.residual_vectors import ResidualVectors
from .model.residuals import Residuals
from .selection.term_gain import TermGain


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
    vectors: ResidualVectors | None = field(default=None, repr=False)
    terms: tuple[TermGain, ...] = ()

    @property
    def deviations(self) -> Array:
        """Standard deviations (P,) of the values."""
        return np.sqrt(np.diag(self.covariance))

    def pose_covariance(self, q: Any) -> Array:
        """Covariance of the calibrated arm's pose, C_T = D C_p Dᵀ.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.

        Returns
        -------
        C : (..., 6, 6) ndarray
            Covariance of the tip's rotation vector and position errors, both in base axes, rad² and
            m². It knows what was fitted only: neither what was fixed, nor joints that bend.

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q does not fit the arm.

        Notes
        -----
        Accuracy: first order in the errors of the parameters. Source: propagation of covariance
        through `Chain.screw_derivatives`.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> C = found.pose_covariance(np.zeros(6))
        >>> deviations = np.sqrt(np.diag(C)[3:])  # of the tip's position, m
        >>> bool((deviations < 1e-3).all())
        True
        """
        q = coordinates(q, self.nominal.q_names)
        rows = q.reshape(-1, self.nominal.dof)
        n = len(self.error_model.parameters)
        T, D = self.error_model.poses_and_twists(self.values[:n], rows)
        J = pose_error_jacobian(T, np.zeros((len(T), 6)), D)
        C = J @ self.covariance[:n, :n] @ np.swapaxes(J, 1, 2)
        return C.reshape(*q.shape[:-1], 6, 6)
