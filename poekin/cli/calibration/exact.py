"""`poekin calibrate --exact`: pairs that a controller's own forward kinematics printed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...errors import InputError
from ...model.chain import Chain
from ...solve.calibration.exact.from_fk import from_fk
from ...solve.calibration.exact.from_fk_result import FromFk
from ...solve.calibration.measurements.poses import Poses
from .measured import Measured, MeasurementOptions

_DEFAULTS: dict[str, object] = {
    "parameters": ("screws", "home"),
    "loss": "linear",
    "joints": None,
    "prior": None,
    "on_rank_deficiency": "raise",
    "gravity": None,
    "repeats": "keep",
}
"""The options about the fit, as they are without any."""
_NAMES = {"prior": "--prior-angle and --prior-length", "gravity": "--gravity"}


def check(said: MeasurementOptions, fit: Mapping[str, object]) -> None:
    """Refuse options that say something of noise, or of which parameters to fit."""
    given = {name: fit[name] != default for name, default in _DEFAULTS.items()}
    for name in ("sigma_angle", "sigma_length"):
        given[name] = getattr(said, name) is not None
    for name, is_given in given.items():
        if is_given:
            raise InputError(
                f"{_NAMES.get(name, name)}: expected without --exact, which takes poses that a controller "
                "calculated, without noise, and fits all axes and the home pose"
            )


def fit(chain: Chain, given: Measured) -> FromFk:
    """The arm of the pairs in the files. Raises: InputError."""
    for name in given.conditions:
        raise InputError(f"--exact: expected no column of {name}; --ignore {name} passes it over")
    for s in given.sets:
        if not isinstance(s, Poses):
            raise InputError(f"--exact: expected poses of the flange in the base, got {s.what}")
    T = np.concatenate([np.asarray(s.T) for s in given.sets if isinstance(s, Poses)])
    return from_fk(chain, given.q, T)
