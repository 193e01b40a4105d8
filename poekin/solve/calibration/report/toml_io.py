"""Calibrations as files: TOML with everything in it, and back to the last bit."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ....formats import chain_toml
from ....formats.chain_toml import CALIBRATED, FORMAT, VERSION
from ....formats.text import toml_text
from ....formats.text.atomic_write import write_whole
from ....formats.text.toml_text import Keys
from ..diagnostics.cross_validation import CrossValidation
from ..diagnostics.identification import Identification
from ..fit.losses import LOSSES
from ..fit.minimise import Step
from ..fit.noise import NoiseEstimate
from ..model.residuals import Residuals
from ..result import CalibrationData, Outlier
from . import document, toml_checks

_OPTIONAL = ("warnings", "remarks")  # written where there are any
_TOP = (
    "format",
    "version",
    "success",
    "loss",
    "kinds",
    "joints",
    "outliers",
    "covariance",
    "nominal",
    CALIBRATED,
    "identification",
    "frames",
    "steps",
    "before",
    "after",
    "cross_validation",
    "parameter",
    "noise_std",
    *_OPTIONAL,
)
_COUNTS = ("size", "identifiable", "rank", "n_equations")
_INDICES = ("condition", "smallest", "O1", "amplification")
_WORDS = ("unidentifiable", "unobserved")
_RESIDUALS = ("length", "angle", "set", "row")


def save(found: CalibrationData, path: str | os.PathLike[str]) -> None:
    """Write a calibration, whole or not at all; see `Calibration.save`."""
    model = found.error_model
    data: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "success": bool(found.success),
        "loss": found.loss,
        "kinds": list(model.kinds),
        "joints": list(model.moving),
        "outliers": [list(map(int, o)) for o in found.outliers],
        "covariance": found.covariance.tolist(),
        "nominal": chain_toml.to_data(found.nominal),
        CALIBRATED: chain_toml.to_data(found.chain),
        "identification": _identification_data(found.identification),
        "frames": {name: frame.tolist() for name, frame in found.frames.items()},
        "steps": {name: [float(getattr(s, name)) for s in found.steps] for name in Step._fields},
        "before": _residuals_data(found.before),
        "after": _residuals_data(found.after),
    }
    held_out = found.cross_validation
    if held_out is not None:
        data["cross_validation"] = {
            "folds": int(held_out.folds),
            "before": _residuals_data(held_out.before),
            "after": _residuals_data(held_out.after),
        }
    data |= {name: list(getattr(found, name)) for name in _OPTIONAL if getattr(found, name)}
    data["parameter"] = document.parameters(found)
    data["noise_std"] = [_noise_data(estimate) for estimate in found.noise_std]
    write_whole(path, toml_text.make_text(data).encode())


def load(path: str | os.PathLike[str]) -> CalibrationData:
    """Read what `save` wrote; see `calibration.load`. Raises: FileError, ModelError."""
    opened = chain_toml.opened(path)
    keys = Keys(opened.data, opened.place, _TOP)
    nominal = chain_toml.to_chain(keys.table("nominal"))
    chain = chain_toml.to_chain(keys.table(CALIBRATED))
    model = toml_checks.error_model(keys, nominal)
    frames = toml_checks.frames(keys.table("frames"))
    named = toml_checks.parameters(keys, model, frames)
    toml_checks.check_chain(keys, model, named.values, chain)
    found = CalibrationData(
        nominal=nominal,
        chain=chain,
        parameters=named.parameters,
        values=named.values,
        covariance=named.covariance,
        frames=frames,
        identification=_identification(keys),
        success=keys.truth("success"),
        steps=_steps(keys.table("steps", Step._fields)),
        before=_residuals(keys, "before"),
        after=_residuals(keys, "after"),
        cross_validation=_cross_validation(keys),
        outliers=tuple(Outlier(*map(int, o)) for o in keys.wholes("outliers", (None, 3))),
        noise_std=tuple(map(_noise, keys.tables("noise_std", ("length", "angle")))),
        loss=keys.text("loss", LOSSES),  # type: ignore[arg-type]  # one of these
        error_model=model,
        **{name: keys.texts(name) for name in _OPTIONAL if name in keys.data},
    )
    toml_checks.check_sets(keys, found)
    return found


def _identification_data(found: Identification) -> dict[str, Any]:
    names = (*_COUNTS, *_INDICES, *_WORDS)
    data: dict[str, Any] = {name: getattr(found, name) for name in names}
    return data | {"singular_values": found.singular_values.tolist()}


def _identification(keys: Keys) -> Identification:
    own = keys.table("identification", (*_COUNTS, *_INDICES, *_WORDS, "singular_values"))
    values: dict[str, Any] = {name: own.whole(name) for name in _COUNTS}
    values |= {name: own.number(name, finite=False) for name in _INDICES}
    values |= {name: own.texts(name) for name in _WORDS}
    return Identification(**values, singular_values=own.array("singular_values", (None,)))


def _noise_data(found: NoiseEstimate | None) -> dict[str, float]:
    if found is None:
        return {}
    angle = {} if found.angle is None else {"angle": float(found.angle)}
    return {"length": float(found.length)} | angle


def _noise(keys: Keys) -> NoiseEstimate | None:
    if "length" not in keys.data:
        return None
    angle = keys.number("angle") if "angle" in keys.data else None
    return NoiseEstimate(angle, keys.number("length"))


def _steps(keys: Keys) -> tuple[Step, ...]:
    cost = keys.array("cost", (None,))
    others = (keys.array(name, cost.shape) for name in Step._fields[1:])
    return tuple(Step(*row) for row in np.column_stack([cost, *others]).tolist())


def _residuals_data(found: Residuals) -> dict[str, Any]:
    return {name: getattr(found, name).tolist() for name in _RESIDUALS}


def _residuals(keys: Keys, name: str) -> Residuals:
    own = keys.table(name, _RESIDUALS)
    length = own.array("length", (None,))
    angle = own.array("angle", length.shape, finite=False)
    return Residuals(
        length,
        angle,
        own.wholes("set", length.shape),
        own.wholes("row", length.shape),
    )


def _cross_validation(keys: Keys) -> CrossValidation | None:
    if "cross_validation" not in keys.data:
        return None
    own = keys.table("cross_validation", ("folds", "before", "after"))
    before = _residuals(own, "before")
    after = _residuals(own, "after")
    return CrossValidation(before, after, own.whole("folds"))
