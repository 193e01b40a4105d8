"""Checks of a calibration's file: parameters, frames and residuals have to fit together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ....errors import ModelError, PoekinError, PoseError, quote
from ....formats.chain_toml import CALIBRATED
from ....formats.text.toml_text import Keys
from ....groups.arrays import Array, poses
from ....model.chain import Chain
from ....model.checks import read_only
from ..model.error_model import ErrorModel
from ..model.parameters import Parameter
from ..result import CalibrationData
from ..terms.conditions import MEANS
from ..terms.term import Term

# reaches: how near the calibrated chain is to what its parameters make of the nominal one
_AGREE = 1e-9
_SAME = ("joint_names", "q_names", "base", "tip")
_NEAR = ("screws", "home", "coupling")


class Named(NamedTuple):
    """Parameters, their values (P,) and covariance (P, P)."""

    parameters: tuple[Parameter, ...]
    values: Array
    covariance: Array


def error_model(keys: Keys, nominal: Chain, terms: Sequence[Term]) -> ErrorModel:
    """The error model of the nominal chain, with the user's own terms. Raises: ModelError."""
    own = {term.name: term for term in terms}
    kinds = [own.get(kind, kind) for kind in keys.texts("kinds")]
    joints = keys.texts("joints")
    try:
        return ErrorModel(nominal, kinds, joints, _reference(keys))
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: {fault}") from fault


def _reference(keys: Keys) -> dict[str, Any]:
    """Means of the conditions that were given. Raises: ModelError."""
    if "conditions" not in keys.data:
        return {}
    own = keys.table("conditions", (*MEANS, "gravity"))
    found: dict[str, Any] = {name: own.number(name) for name in MEANS if name in own.data}
    if "gravity" in own.data:
        found["gravity"] = own.array("gravity", (3,)).tolist()
    return found


def frames(keys: Keys) -> dict[str, Array]:
    """Frames (4, 4) and points (3,) by name. Raises: ModelError."""
    return {name: _frame(keys, name) for name in keys.data}


def _frame(keys: Keys, name: str) -> Array:
    value = keys.value(name)
    if not isinstance(value, list) or len(value) != 4:
        return read_only(keys.array(name, (3,)))
    try:
        return read_only(poses(keys.array(name, (4, 4))))
    except PoseError as fault:
        raise keys.fault(name, str(fault)) from fault


def parameters(
    keys: Keys,
    model: ErrorModel,
    frames: dict[str, Array],
) -> Named:
    """Parameters with values and covariance, those of arm and frames. Raises: ModelError."""
    rows = keys.tables("parameter", (*Parameter._fields, "value", "deviation"))
    found = tuple(map(_parameter, rows))
    own = model.parameters
    count = len(own)
    of_each = (6 if T.ndim == 2 else 3 for T in frames.values())
    size = count + sum(of_each)
    if len(found) != size:
        raise keys.fault(
            "parameter",
            f"expected {size} of them, as arm and frames have, got {len(found)}",
        )
    for k, expected in enumerate(own):
        if _key(expected) != _key(found[k]):
            name = quote(expected.name)
            got = quote(found[k].name)
            raise rows[k].fault("what", f"expected {name}, the arm's parameter {k + 1}, got {got}")
    of_frames = zip(rows[count:], found[count:], strict=True)
    for row, given in of_frames:
        if given.owner not in frames:
            raise row.fault("owner", f"expected a name in frames, got {quote(given.owner)}")
    values = np.array([row.number("value") for row in rows], float)
    return Named(found, values, _covariance(keys, rows))


def _parameter(row: Keys) -> Parameter:
    unit: Any = row.text("unit")  # compared with the arm's own below
    return Parameter(row.text("owner"), row.text("what"), unit)


def _key(parameter: Parameter) -> tuple[str, str, str]:
    """A parameter without the directions in its name, numbers that another machine may round
    otherwise.
    """
    what, _, _ = parameter.what.partition(" (")
    return parameter.owner, what, parameter.unit


def _covariance(keys: Keys, rows: list[Keys]) -> Array:
    """Covariance (P, P), with the deviations of the parameters. Raises: ModelError."""
    count = len(rows)
    covariance = keys.array("covariance", (count, count))
    variances = np.diag(covariance)
    sizes = np.sqrt(np.abs(variances))
    with np.errstate(over="ignore"):
        apart = np.abs(covariance - covariance.T)
        uneven = apart > 1e-9 * np.outer(sizes, sizes)
    if (variances < 0).any() or uneven.any():
        raise keys.fault(
            "covariance",
            "expected a symmetric matrix with a diagonal that is not negative",
        )
    for row, variance in zip(rows, variances, strict=True):
        expected = variance**0.5
        if abs(row.number("deviation") - expected) > 1e-12 * expected:
            raise row.fault("deviation", f"expected {float(expected)!r}, as the covariance says")
    return covariance


def check_chain(
    keys: Keys,
    model: ErrorModel,
    values: Array,
    chain: Chain,
) -> None:
    """Refuse a calibrated chain that is not what the parameters make of the nominal one."""
    try:
        own = model.chain(values[: len(model.parameters)])
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: parameter: {fault}") from fault
    same = all(getattr(own, name) == getattr(chain, name) for name in _SAME)
    off = [np.abs(getattr(own, name) - getattr(chain, name)).max(initial=0.0) for name in _NEAR]
    if not same or not max(off) <= _AGREE * own.reach:
        raise keys.fault(CALIBRATED, "the chain is not what the parameters make of the nominal one")


def check_sets(keys: Keys, found: CalibrationData) -> None:
    """Refuse residuals of sets that there are not, and outliers that are no measurement."""
    count = len(found.noise_std)
    most = found.after.set.max(initial=-1)
    if most >= count:
        raise keys.fault(
            "after",
            f"expected sets below {count}, as there is a [[noise_std]] for each, got {most}",
        )
    for o in found.outliers:
        rows = found.after.of_set(o.set).row
        if o.index >= len(rows) or rows[o.index] != o.row:
            raise keys.fault(
                "outliers",
                f"expected set, index and row of a measurement, got {list(o)}",
            )
