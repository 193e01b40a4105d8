"""Checks of arguments: chains and tolerances."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import InputError, safe_repr
from ..model.chain import Chain

POSITION = 1e-5
"""Default of `tol_position`, m: 0.01 mm."""
ROTATION = math.radians(1e-3)
"""Default of `tol_rotation`, rad: 0.001 deg."""


def check_chain(chain: object, what: str = "") -> None:
    """Raises InputError for what is no Chain; `what` begins the message."""
    if not isinstance(chain, Chain):
        raise InputError(
            f"{what}expected a Chain, as Robot.chain(tip=...) makes it, got {safe_repr(chain)}"
        )


def check_tolerances(**tolerances: Any) -> None:
    """Raises InputError, with its name, for a tolerance that is no positive finite number."""
    for what, tol in tolerances.items():
        real = isinstance(tol, (int, float, np.integer, np.floating)) and not isinstance(tol, bool)
        if not real or not 0 < tol < math.inf:
            raise InputError(f"{what}: a positive number expected, got {safe_repr(tol)}")
