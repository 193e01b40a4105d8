"""Calibration: measurements in, the arm's true screws out, with what can be known and how well."""

from .calibrate import calibrate
from .calibration import Calibration, load
from .design.choice import Choice, DesignMetrics
from .design.choose import choose_poses
from .design.observability import ObservabilityIndices, observability_indices
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.identification import Identification, identify
from .fit.noise import NoiseEstimate
from .measurements.data import read, write
from .measurements.measurement import Measurement
from .measurements.points import Distances, Points
from .measurements.poses import EyeInHand, EyeToHand, Poses
from .measurements.simulated import Simulated, simulated
from .model.parameters import Parameter
from .model.residuals import Residuals
from .result import Outlier

__all__ = [
    "Calibration",
    "Choice",
    "CrossValidation",
    "DesignMetrics",
    "Distances",
    "EyeInHand",
    "EyeToHand",
    "Identification",
    "Measurement",
    "NoiseEstimate",
    "ObservabilityIndices",
    "Outlier",
    "Parameter",
    "Points",
    "Poses",
    "Residuals",
    "Simulated",
    "calibrate",
    "choose_poses",
    "identify",
    "load",
    "observability_indices",
    "read",
    "simulated",
    "write",
]
