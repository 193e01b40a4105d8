"""Tolerances as a user gives them: positive numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import InputError, safe_repr

POSITION = 1e-5
"""Default of `tol_position`, m: 0.01 mm."""
ROTATION = math.radians(1e-3)
"""Default of `tol_rotation`, rad: 0.001 deg."""


def check_tolerances(**tolerances: Any) -> None:
    """Raises InputError, with its name, for a tolerance that is no positive finite number."""
    for what, tol in tolerances.items():
        real = isinstance(tol, (int, float, np.integer, np.floating)) and not isinstance(tol, bool)
        if not real or not 0 < tol < math.inf:
            raise InputError(f"{what}: a positive number expected, got {safe_repr(tol)}")
