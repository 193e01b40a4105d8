"""Universal Robots' factory calibrations: the ROS driver's YAML, DH tables, and nominal tables with
deltas.
"""

from .calibration import JOINTS, LINKS, Calibration, apply
from .conf import read_deltas
from .tables import deltas, from_dh
from .yaml_io import read, write

__all__ = [
    "JOINTS",
    "LINKS",
    "Calibration",
    "apply",
    "deltas",
    "from_dh",
    "read",
    "read_deltas",
    "write",
]
