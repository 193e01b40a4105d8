"""Calibration: measurements in, the arm's true screws out, with what can be known and how well."""

from .calibrate import calibrate
from .calibration import Calibration, Outlier
from .choice import Choice, Figures
from .choose import choose_poses
from .data import read, write
from .files import load
from .folds import HeldOut
from .identification import Identification, identify
from .indices import Indices, indices
from .measurement import Measurement
from .noise import Spread
from .parameters import Parameter
from .points import Distances, Points
from .poses import EyeInHand, EyeToHand, Poses
from .residuals import Residuals
from .simulated import Simulated, simulated

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
