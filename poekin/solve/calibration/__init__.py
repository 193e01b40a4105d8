"""Calibration: measurements in, the arm's true screws out, with what can be known and how well."""

from .apply import apply
from .calibrate import calibrate
from .calibration import Calibration, load
from .circles.axis_fit import AxisFit
from .circles.from_circles import from_circles
from .circles.from_circles_result import FromCircles
from .circles.joint_sweep import JointSweep
from .compensation import Command
from .design.choice import Choice, DesignMetrics
from .design.choose import choose_poses
from .design.observability import ObservabilityIndices, observability_indices
from .design.visibility import ViewCone, WorkspaceBox
from .diagnostics.base_and_tool import FrameEstimate
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.effects.diagnosis import ResidualDiagnosis
from .diagnostics.effects.effect_test import EffectTest
from .diagnostics.identification import Identification, identify
from .diagnostics.uncertainty import Workspace
from .exact.from_fk import from_fk
from .exact.from_fk_result import FromFk, PoseErrors
from .fit.noise import NoiseEstimate
from .measurements.data import read, write
from .measurements.measurement import Measurement
from .measurements.points import Distances, Points
from .measurements.poses import EyeInHand, EyeToHand, Poses
from .measurements.separations import Separations
from .measurements.simulated import Simulated, simulated
from .model.configurations import average_repeats
from .model.parameters import Parameter
from .model.residual_vectors import ResidualVectors
from .model.residuals import Residuals
from .result import Outlier
from .selection.term_gain import TermGain
from .terms.conditions import Conditions
from .terms.term import Term

__all__ = [
    "AxisFit",
    "Calibration",
    "Choice",
    "Command",
    "Conditions",
    "CrossValidation",
    "DesignMetrics",
    "Distances",
    "EffectTest",
    "EyeInHand",
    "EyeToHand",
    "FrameEstimate",
    "FromCircles",
    "FromFk",
    "Identification",
    "JointSweep",
    "Measurement",
    "NoiseEstimate",
    "ObservabilityIndices",
    "Outlier",
    "Parameter",
    "Points",
    "PoseErrors",
    "Poses",
    "ResidualDiagnosis",
    "ResidualVectors",
    "Residuals",
    "Separations",
    "Simulated",
    "Term",
    "TermGain",
    "ViewCone",
    "Workspace",
    "WorkspaceBox",
    "apply",
    "average_repeats",
    "calibrate",
    "choose_poses",
    "from_circles",
    "from_fk",
    "identify",
    "load",
    "observability_indices",
    "read",
    "simulated",
    "write",
]
