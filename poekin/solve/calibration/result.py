"""Data of a calibration: the arm that was found, how well it is known, what was left over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...checks import whole
from ...errors import ShapeError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...results import Result
from .diagnostics import uncertainty
from .diagnostics.base_and_tool import FrameEstimate, frame_estimates
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.effects.diagnosis import FitEvidence, ResidualDiagnosis, SavedEvidence
from .diagnostics.identification import Identification
from .diagnostics.uncertainty import CONFIGURATIONS, Workspace
from .fit.losses import LossName
from .fit.minimise import Step
from .fit.noise import NoiseEstimate
from .measurements.measurement import Measurement
from .measurements.points import parse_points
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
    values: Array
    covariance: Array
    frames: Mapping[str, Array]
    identification: Identification
    success: bool
    steps: tuple[Step, ...]
    before: Residuals
    after: Residuals
    cross_validation: CrossValidation | None
    outliers: tuple[Outlier, ...]
    noise_std: tuple[NoiseEstimate | None, ...]
    loss: LossName
    error_model: ErrorModel
    warnings: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    verdict: tuple[str, ...] = ()
    residuals: ResidualVectors | None = None
    terms: tuple[TermGain, ...] = ()
    evidence: FitEvidence | SavedEvidence | None = None

    @property
    def diagnosis(self) -> ResidualDiagnosis | None:
        """Effects that the residuals show; None where neither measurements nor a file tell."""
        if self.evidence is None:
            return None
        return self.evidence.diagnosis

    @property
    def tool_and_base(self) -> tuple[FrameEstimate, ...]:
        """Frames that a controller with the nominal arm is told; none where `diagnosis` is None.

        The base in the frame that was measured in and the tool in its tip frame, with which the
        nominal arm is nearest to the calibrated one; and the unknown frames.
        """
        if self.evidence is None:
            return ()
        return tuple(frame_estimates(self.estimate, self.evidence.points))

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
            m². It knows what was fitted only: neither what was fixed, nor what no parameter describes.

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
        C = uncertainty.pose_covariance(self.estimate, rows)
        return C.reshape(*q.shape[:-1], 6, 6)

    def relative_covariance(self, q_a: Any, q_b: Any) -> Array:
        """Covariance of the motion from one configuration to another, T_ab = T_a⁻¹ T_b.

        Where the base stands is not in it, nor what the frames of devices take up.

        Parameters
        ----------
        q_a, q_b : (..., m) array_like or dict
            Configurations, rad or m.

        Returns
        -------
        C : (..., 6, 6) ndarray
            Covariance of the rotation vector and position errors of the tool at q_b, seen from the
            tool at q_a, in its axes, rad² and m².

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q_a or q_b do not fit the arm, or each other.

        Notes
        -----
        Accuracy: first order in the errors of the parameters. Source: propagation of covariance.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> bool(found.relative_covariance(np.zeros(6), np.zeros(6)).max() < 1e-20)
        True
        """
        a, b, shape = self._pairs(q_a, q_b)
        C = uncertainty.relative_covariance(self.estimate, a, b)
        return C.reshape(*shape, 6, 6)

    def distance_deviation(self, q_a: Any, q_b: Any, point: Any = (0.0, 0.0, 0.0)) -> Array:
        """Standard deviation of the distance between two places of a point of the tool.

        Parameters
        ----------
        q_a, q_b : (..., m) array_like or dict
            Configurations, rad or m.
        point : (3,) array_like, default (0, 0, 0)
            The point in the tip frame, m.

        Returns
        -------
        deviation : (...) ndarray
            Standard deviation, m.

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q_a, q_b or point have another shape.

        Notes
        -----
        Accuracy: first order in the errors of the parameters. Source: propagation of covariance.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> bool(found.distance_deviation(np.zeros(6), np.ones(6)) < 1e-3)
        True
        """
        a, b, shape = self._pairs(q_a, q_b)
        place = parse_points(point)
        if len(place) != 1:
            raise ShapeError(f"point: expected one point (3,), got {len(place)}")
        variances = uncertainty.distance_variance(self.estimate, a, b, place[0])
        return np.sqrt(np.maximum(variances, 0.0)).reshape(shape)

    def measurement_covariance(self, q: Any, measurement: Measurement, of_set: int = 0) -> Array:
        """Covariance of measurements as the calibrated arm predicts them.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        measurement : Measurement
            A set of the kind, points and frames of one that was calibrated from.
        of_set : int, default 0
            Number of that set: its unknown frames are meant.

        Returns
        -------
        C : (..., d, d) ndarray
            Covariance of the d errors of each, in their order, rad² and m²; a measurement scatters
            about that by its own noise.

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q does not fit the arm, or a frame of the measurement was not estimated.

        Notes
        -----
        Accuracy: first order in the errors of the parameters. Source: propagation of covariance.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 40, kind="eye-in-hand", seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> found.measurement_covariance(made.q, made.measurements).shape
        (40, 6, 6)
        """
        q = coordinates(q, self.nominal.q_names)
        rows = q.reshape(-1, self.nominal.dof)
        C = uncertainty.measurement_covariance(self.estimate, rows, measurement, of_set)
        return C.reshape(*q.shape[:-1], *C.shape[1:])

    def workspace(self, count: int = CONFIGURATIONS, seed: int = 0) -> Workspace:
        """Standard deviations of the tool's pose at random configurations within the limits.

        Parameters
        ----------
        count : int, default 1000
            Number of configurations.
        seed : int, default 0
            Seed of their drawing.

        Returns
        -------
        workspace : Workspace
            Standard deviations of position and rotation, and the configurations.

        Raises
        ------
        InputError
            If count or seed are no whole numbers from 1 and 0 on.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> known = found.workspace(100)
        >>> known.length.shape, known.worst.shape
        ((100,), (6,))
        """
        whole(count, "count", 1)
        whole(seed, "seed", 0)
        return uncertainty.workspace(self.estimate, count, seed)

    @property
    def estimate(self) -> uncertainty.Estimate:
        """Error model, parameters, covariance and frames."""
        return uncertainty.Estimate(
            self.error_model, self.parameters, self.values, self.covariance, self.frames
        )

    def _pairs(self, q_a: Any, q_b: Any) -> tuple[Array, Array, tuple[int, ...]]:
        """Pairs of configurations (N, m), and their leading shape."""
        a = coordinates(q_a, self.nominal.q_names, "q_a")
        b = coordinates(q_b, self.nominal.q_names, "q_b")
        if a.shape != b.shape:
            raise ShapeError(f"q_b: expected the shape of q_a, {a.shape}, got {b.shape}")
        dof = self.nominal.dof
        return a.reshape(-1, dof), b.reshape(-1, dof), a.shape[:-1]
