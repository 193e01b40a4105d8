"""Universal Robots' factory calibrations: the ROS driver's YAML, DH tables, and nominal tables with
deltas.
"""

from .calibration import JOINTS, LINKS, FactoryCalibration, apply
from .conf import read_deltas
from .tables import add_deltas, from_dh
from .yaml_io import read, write

__all__ = [
    "JOINTS",
    "LINKS",
    "FactoryCalibration",
    "add_deltas",
    "apply",
    "from_dh",
    "read",
    "read_deltas",
    "write",
]
