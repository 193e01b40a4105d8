"""Calibrations as files: TOML with everything in it, and back to the last bit."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ....errors import ModelError, PoekinError, quote
from ....formats import chain_toml
from ....formats.chain_toml import CALIBRATED, FORMAT, VERSION
from ....formats.text import toml_text
from ....formats.text.atomic_write import write_whole
from ....formats.text.toml_text import Keys
from ....groups.arrays import Array, poses
from ....model.chain import Chain
from ....model.checks import read_only
from ..diagnostics.cross_validation import HeldOut
from ..diagnostics.identification import Identification
from ..fit.losses import LOSSES
from ..fit.minimise import Step
from ..fit.noise import Spread
from ..model.parameters import Arm, Parameter
from ..model.residuals import Residuals
from ..result import CalibrationData, Outlier

_SAID = ("warnings", "remarks")  # where there are any
_TOP = (
    "format", "version", "success", "loss", "kinds", "joints", "outliers", "covariance", "nominal", CALIBRATED,
    "identification", "frames", "steps", "before", "after", "held_out", "parameter", "spread", *_SAID,
)  # fmt: skip
_COUNTS = ("size", "expected", "rank", "numbers")
_FIGURES = ("condition", "smallest", "O1", "amplification")
_WORDS = ("held", "unseen")
_PARTS = ("length", "angle", "set", "row")
_AGREE = (
    1e-9  # reaches: how near the calibrated chain is to what its parameters make of the nominal one
)


def save(found: CalibrationData, path: str | os.PathLike[str]) -> None:
    """Write a calibration, whole or not at all; see `Calibration.save`."""
    data: dict[str, Any] = {
        "format": FORMAT, "version": VERSION, "success": bool(found.success), "loss": found.loss,
        "kinds": list(found.arm.kinds), "joints": list(found.arm.moving),
        "outliers": [list(map(int, o)) for o in found.outliers],
        "covariance": found.covariance.tolist(),
        "nominal": chain_toml.to_data(found.nominal), CALIBRATED: chain_toml.to_data(found.chain),
        "identification": _identification(found.identification),
        "frames": {name: place.tolist() for name, place in found.frames.items()},
        "steps": {name: [float(getattr(s, name)) for s in found.steps] for name in Step._fields},
        "before": _residuals(found.before), "after": _residuals(found.after),
    }  # fmt: skip
    if found.held_out is not None:
        parts = {name: _residuals(getattr(found.held_out, name)) for name in ("before", "after")}
        data["held_out"] = {"folds": int(found.held_out.folds)} | parts
    data |= {name: list(getattr(found, name)) for name in _SAID if getattr(found, name)}
    data["parameter"] = [
        {"owner": p.owner, "what": p.what, "unit": p.unit, "value": value, "deviation": deviation}
        for p, value, deviation in zip(
            found.parameters, found.values.tolist(), found.deviations.tolist(), strict=True
        )
    ]  # fmt: skip
    data["spread"] = [
        {}
        if s is None
        else {"length": float(s.length)} | ({} if s.angle is None else {"angle": float(s.angle)})
        for s in found.spreads
    ]
    write_whole(path, toml_text.make_text(data).encode())


def load(path: str | os.PathLike[str]) -> CalibrationData:
    """Read what `save` wrote; see `calibration.load`. Raises: FileError, ModelError."""
    keys = chain_toml.opened(path)
    keys = Keys(keys.data, keys.place, _TOP)
    nominal, chain = (chain_toml.to_chain(keys.table(name)) for name in ("nominal", CALIBRATED))
    arm = _arm(keys, nominal)
    frames = {name: _place(keys.table("frames"), name) for name in keys.table("frames").data}
    parameters, values, covariance = _parameters(keys, arm, frames)
    _agree(keys, arm, values[: len(arm.parameters)], chain)
    found = CalibrationData(
        nominal=nominal, chain=chain, parameters=parameters, values=values, covariance=covariance, frames=frames,
        identification=_identified(keys.table("identification", (*_COUNTS, *_FIGURES, *_WORDS, "singular_values"))),
        success=keys.truth("success"), steps=_steps(keys.table("steps", Step._fields)),
        before=_residual(keys, "before"), after=_residual(keys, "after"), held_out=_held_out(keys),
        outliers=tuple(Outlier(*map(int, o)) for o in keys.wholes("outliers", (None, 3))),
        spreads=tuple(map(_spread, keys.tables("spread", ("length", "angle")))), loss=keys.text("loss", LOSSES),
        arm=arm, **{name: keys.texts(name) for name in _SAID if name in keys.data},
    )  # fmt: skip
    _check_sets(keys, found)
    return found


def _check_sets(keys: Keys, found: CalibrationData) -> None:
    """Refuse residuals of sets that there are not, and outliers that are no measurement."""
    count, after = len(found.spreads), found.after
    if (after.set >= count).any():
        raise keys.fault(
            "after",
            f"expected sets below {count}, as there is a [[spread]] for each, got {after.set.max()}",
        )
    for o in found.outliers:
        rows = after.row[after.set == o.set]
        if o.index >= len(rows) or rows[o.index] != o.row:
            raise keys.fault(
                "outliers", f"expected set, index and row of a measurement, got {list(o)}"
            )


def _arm(keys: Keys, nominal: Chain) -> Arm:
    try:
        return Arm(nominal, keys.texts("kinds"), keys.texts("joints"))
    except ModelError:
        raise
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: {fault}") from fault


def _place(frames: Keys, name: str) -> Array:
    """A frame (4, 4) or a point (3,)."""
    value = frames.value(name)
    place = frames.array(name, (4, 4) if isinstance(value, list) and len(value) == 4 else (3,))
    if place.ndim == 2:
        try:
            poses(place)
        except PoekinError as fault:
            raise frames.fault(name, str(fault)) from fault
    return read_only(place)


def _parameters(
    keys: Keys, arm: Arm, frames: dict[str, Array]
) -> tuple[tuple[Parameter, ...], Array, Array]:
    rows = keys.tables("parameter", ("owner", "what", "unit", "value", "deviation"))
    found = tuple(Parameter(*(row.text(part) for part in Parameter._fields)) for row in rows)
    size = len(arm.parameters) + sum(6 if T.ndim == 2 else 3 for T in frames.values())
    if len(found) != size:
        raise keys.fault(
            "parameter", f"expected {size} of them, as arm and frames have, got {len(found)}"
        )
    for k, (row, own, given) in enumerate(zip(rows, arm.parameters, found, strict=False)):
        # the directions in a name are rounded numbers, which another machine may round otherwise
        if (own.owner, _kind(own), own.unit) != (given.owner, _kind(given), given.unit):
            raise row.fault(
                "what",
                f"expected {quote(own.name)}, the arm's parameter {k + 1}, got {quote(given.name)}",
            )
    for row, given in zip(rows[len(arm.parameters) :], found[len(arm.parameters) :], strict=True):
        if given.owner not in frames:
            raise row.fault("owner", f"expected a name in frames, got {quote(given.owner)}")
    values = np.array([row.number("value") for row in rows], float)
    covariance = keys.array("covariance", (size, size))
    variances = np.diag(covariance)
    size_of = np.sqrt(np.abs(variances))
    with np.errstate(over="ignore"):
        uneven = np.abs(covariance - covariance.T) > 1e-9 * np.outer(size_of, size_of)
    if (variances < 0).any() or uneven.any():
        raise keys.fault(
            "covariance", "expected a symmetric matrix with a diagonal that is not negative"
        )
    for row, variance in zip(rows, variances, strict=True):
        if abs(row.number("deviation") - variance**0.5) > 1e-12 * variance**0.5:
            raise row.fault(
                "deviation", f"expected {float(variance**0.5)!r}, as the covariance says"
            )
    return found, values, covariance


def _kind(parameter: Parameter) -> str:
    return parameter.what.partition(" (")[0]


def _agree(keys: Keys, arm: Arm, p: Array, chain: Chain) -> None:
    """Refuse a calibrated chain that is not what the parameters make of the nominal one."""
    try:
        own = arm.chain(p)
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: parameter: {fault}") from fault
    names = ("joint_names", "q_names", "base", "tip")
    same = all(getattr(own, name) == getattr(chain, name) for name in names)
    off = np.inf if not same else max(
        np.abs(getattr(own, name) - getattr(chain, name)).max(initial=0.0) for name in ("screws", "home", "coupling")
    )  # fmt: skip
    if not off <= _AGREE * own.reach:
        raise keys.fault(CALIBRATED, "the chain is not what the parameters make of the nominal one")


def _identification(found: Identification) -> dict[str, Any]:
    data: dict[str, Any] = {name: int(getattr(found, name)) for name in _COUNTS}
    data |= {name: float(getattr(found, name)) for name in _FIGURES}
    data |= {name: list(getattr(found, name)) for name in _WORDS}
    return data | {"singular_values": np.asarray(found.singular_values).tolist()}


def _identified(keys: Keys) -> Identification:
    values: dict[str, Any] = {name: keys.whole(name) for name in _COUNTS}
    values |= {name: keys.number(name, finite=False) for name in _FIGURES}
    values |= {name: keys.texts(name) for name in _WORDS}
    return Identification(**values, singular_values=keys.array("singular_values", (None,)))


def _steps(keys: Keys) -> tuple[Step, ...]:
    cost = keys.array("cost", (None,))
    others = (keys.array(name, cost.shape) for name in Step._fields[1:])
    return tuple(Step(*row) for row in np.column_stack([cost, *others]).tolist())


def _residuals(found: Residuals) -> dict[str, Any]:
    return {name: getattr(found, name).tolist() for name in _PARTS}


def _residual(keys: Keys, name: str) -> Residuals:
    own = keys.table(name, _PARTS)
    length = own.array("length", (None,))
    angle = own.array("angle", length.shape, finite=False)
    return Residuals(length, angle, *(own.wholes(part, length.shape) for part in _PARTS[2:]))


def _held_out(keys: Keys) -> HeldOut | None:
    if "held_out" not in keys.data:
        return None
    own = keys.table("held_out", ("folds", "before", "after"))
    return HeldOut(_residual(own, "before"), _residual(own, "after"), own.whole("folds"))


def _spread(keys: Keys) -> Spread | None:
    if "length" not in keys.data:
        return None
    return Spread(keys.number("angle") if "angle" in keys.data else None, keys.number("length"))
