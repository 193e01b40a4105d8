"""Calibrations as files: TOML with everything in it, and back to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import starmap
from typing import Any

import numpy as np

from ....formats import chain_toml
from ....formats.chain_toml import CALIBRATED, FORMAT, NOMINAL, VERSION
from ....formats.text import toml_text, xml
from ....formats.text.atomic_write import FilePath, write_whole
from ....formats.text.toml_text import Keys
from ....results import Result
from ..diagnostics.cross_validation import CrossValidation
from ..diagnostics.effects import toml_evidence
from ..diagnostics.identification import Identification
from ..fit.losses import LOSSES
from ..fit.minimise import Step
from ..fit.noise import NoiseEstimate
from ..model.residuals import FIELDS, Residuals
from ..result import CalibrationData, Outlier
from ..selection.term_gain import TermGain
from ..terms.term import Term, name_of
from . import document, toml_checks

_TOP = (
    "format",
    "version",
    "success",
    "loss",
    "kinds",
    "joints",
    "outliers",
    "covariance",
    NOMINAL,
    CALIBRATED,
    "identification",
    "frames",
    "steps",
    "before",
    "after",
    "cross_validation",
    "parameter",
    "noise_std",
    "verdict",
    "warnings",
    "remarks",
    "conditions",
    "term",
    "diagnosis",
)
_COUNTS = ("size", "identifiable", "rank", "n_equations")
_INDICES = ("condition", "smallest", "O1", "amplification")
_SAID = ("verdict", "warnings", "remarks")
_WORDS = ("unidentifiable", "unobserved")


def save(found: CalibrationData, path: FilePath) -> None:
    """Write a calibration, whole or not at all; see `Calibration.save`."""
    data: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "success": found.success,
        "loss": found.loss,
        "kinds": list(map(name_of, found.error_model.kinds)),
        "joints": found.error_model.moving,
        "outliers": found.outliers,
        "covariance": found.covariance,
        NOMINAL: chain_toml.to_data(found.nominal),
        CALIBRATED: chain_toml.to_data(found.chain),
        "identification": found.identification,
        "frames": found.frames,
        "steps": {name: [getattr(s, name) for s in found.steps] for name in Step._fields},
        "before": found.before,
        "after": found.after,
        "cross_validation": found.cross_validation,
        **{name: getattr(found, name) or None for name in _SAID},
        "conditions": dict(found.error_model.reference) or None,
        "term": [term._asdict() for term in found.terms] or None,
        "parameter": document.parameters(found),
        "diagnosis": toml_evidence.to_data(found.evidence),
        "noise_std": [_data(noise._asdict()) if noise else {} for noise in found.noise_std],
    }
    write_whole(path, toml_text.make_text(_data(data)).encode())


def load(path: FilePath, terms: Sequence[Term] = ()) -> CalibrationData:
    """Read what `save` wrote; see `calibration.load`. Raises: FileError, ModelError."""
    return read_text(*xml.read_text(path), terms)


def read_text(text: str, place: str, terms: Sequence[Term] = ()) -> CalibrationData:
    """The calibration in the text of what `save` wrote; see `calibration.load`. Raises: ModelError."""
    opened = chain_toml.opened_text(text, place)
    keys = Keys(opened.data, opened.place, _TOP)
    nominal = chain_toml.to_chain(keys.table(NOMINAL))
    chain = chain_toml.to_chain(keys.table(CALIBRATED))
    model = toml_checks.error_model(keys, nominal, terms)
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
        outliers=tuple(starmap(Outlier, keys.wholes("outliers", (None, 3)).tolist())),
        noise_std=tuple(map(_noise, keys.tables("noise_std", ("length", "angle")))),
        loss=keys.text("loss", LOSSES),  # type: ignore[arg-type]  # one of these
        error_model=model,
        residuals=None,
        terms=tuple(map(_term, keys.tables("term", TermGain._fields))),
        evidence=toml_evidence.from_keys(keys),
        **{name: keys.texts(name) for name in _SAID if name in keys.data},
    )
    toml_checks.check_sets(keys, found)
    return found


def _data(value: Any) -> Any:
    """A value as TOML has it: arrays are lists, results tables, and what is None is left out."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Result):
        return _data(vars(value))
    if isinstance(value, dict):
        return {name: _data(item) for name, item in value.items() if item is not None}
    return value


def _identification(keys: Keys) -> Identification:
    own = keys.table("identification", (*_COUNTS, *_INDICES, *_WORDS, "singular_values"))
    values: dict[str, Any] = {name: own.whole(name) for name in _COUNTS}
    values |= {name: own.number(name, finite=False) for name in _INDICES}
    values |= {name: own.texts(name) for name in _WORDS}
    return Identification(**values, singular_values=own.array("singular_values", (None,)))


def _noise(keys: Keys) -> NoiseEstimate | None:
    if "length" not in keys.data:
        return None
    angle = keys.number("angle") if "angle" in keys.data else None
    return NoiseEstimate(angle, keys.number("length"))


def _term(keys: Keys) -> TermGain:
    return TermGain(
        keys.text("name"),
        keys.truth("chosen"),
        keys.whole("coefficients"),
        keys.number("gain", finite=False),
        keys.number("deviation", finite=False),
    )


def _steps(keys: Keys) -> tuple[Step, ...]:
    cost = keys.array("cost", (None,))
    columns = [keys.array(name, cost.shape).tolist() for name in Step._fields]
    return tuple(map(Step, *columns))


def _residuals(keys: Keys, name: str) -> Residuals:
    own = keys.table(name, FIELDS)
    length = own.array("length", (None,))
    return Residuals(
        length,
        own.array("angle", length.shape, finite=False),
        own.wholes("set", length.shape),
        own.wholes("row", length.shape),
    )


def _cross_validation(keys: Keys) -> CrossValidation | None:
    if "cross_validation" not in keys.data:
        return None
    own = keys.table("cross_validation", ("folds", "before", "after"))
    return CrossValidation(
        _residuals(own, "before"),
        _residuals(own, "after"),
        own.whole("folds"),
    )
