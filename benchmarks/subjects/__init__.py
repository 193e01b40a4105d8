"""Subjects of `poekin.testing.conform`: poekin, the libraries beside it, one without fault, and
eight with one each.

poekin conform benchmarks.subjects:SciPy
"""

from __future__ import annotations

from .backed_by_mpmath import Angular, Linear
from .faulty import FAULTS
from .libraries import (
    LIBRARIES,
    Jaxlie,
    ModernRobotics,
    MuJoCo,
    Pinocchio,
    PinocchioMimic,
    Pytransform3d,
    Pytransform3dBatches,
    RoboticsToolbox,
    SciPy,
)
from .own import Poekin

__all__ = ["FAULTS", "LIBRARIES", "Angular", "Jaxlie", "Linear", "ModernRobotics", "MuJoCo", "Pinocchio",
           "PinocchioMimic", "Poekin", "Pytransform3d", "Pytransform3dBatches", "RoboticsToolbox", "SciPy"]  # fmt: skip
