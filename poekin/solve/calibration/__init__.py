"""Calibration: measurements in, the arm's true screws out, with what can be known and how well."""

from .calibrate import calibrate
from .calibration import Calibration, load
from .design.choice import Choice, Figures
from .design.choose import choose_poses
from .design.indices import Indices, indices
from .diagnostics.cross_validation import HeldOut
from .diagnostics.identification import Identification, identify
from .fit.noise import Spread
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
    "Distances",
    "EyeInHand",
    "EyeToHand",
    "Figures",
    "HeldOut",
    "Identification",
    "Indices",
    "Measurement",
    "Outlier",
    "Parameter",
    "Points",
    "Poses",
    "Residuals",
    "Simulated",
    "Spread",
    "calibrate",
    "choose_poses",
    "identify",
    "indices",
    "load",
    "read",
    "simulated",
    "write",
]
