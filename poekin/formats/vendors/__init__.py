"""Factory calibrations in files of Universal Robots, UFACTORY and Flexiv: one reader for all."""

from . import ur
from .calibration import FactoryCalibration
from .naming import Naming
from .yaml_io import RpyAxes, read, write

__all__ = [
    "FactoryCalibration",
    "Naming",
    "RpyAxes",
    "read",
    "ur",
    "write",
]
