"""Tolerances as a user gives them: a positive number of millimetres or degrees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import InputError, safe_repr


def check_tolerances(tol_mm: Any, tol_deg: Any) -> None:
    """Raises InputError for a tolerance that is no positive finite number."""
    for what, tol in (("tol_mm", tol_mm), ("tol_deg", tol_deg)):
        real = isinstance(tol, (int, float, np.integer, np.floating)) and not isinstance(tol, bool)
        if not real or not 0 < tol < math.inf:
            raise InputError(f"{what}: a positive number expected, got {safe_repr(tol)}")
