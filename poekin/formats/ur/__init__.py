"""Factory calibrations of Universal Robots: the ROS driver's YAML, DH tables, and deltas."""

from .calibration import JOINTS, LINKS, FactoryCalibration, apply
from .conf import read_deltas
from .tables import add_deltas, from_dh
from .yaml_io import RpyAxes, read, write

__all__ = [
    "JOINTS",
    "LINKS",
    "FactoryCalibration",
    "RpyAxes",
    "add_deltas",
    "apply",
    "from_dh",
    "read",
    "read_deltas",
    "write",
]
