"""Conditions of readings: payload, gravity, the move before, time and temperature of each row."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ....checks import alternatives
from ....errors import InputError, ShapeError, UnknownName, quote, safe_repr
from ....groups.arrays import Array, numbers
from ....groups.vectors import normalised, norms
from ....model.checks import finite
from ....results import brief

NAMES = ("payload", "gravity", "approach", "previous", "time", "temperature")
_DRIFTS = ("temperature", "time")  # the first that is given is what a drift follows
MEANS = ("payload", *_DRIFTS)
_DOWN = (0.0, 0.0, -1.0)
_STILL = 1e-6  # rad or m: a coordinate that changes by less has not moved

Reference = Mapping[str, Any]
"""Means of the conditions that were given: those that hold where none are given."""


class Conditions(NamedTuple):
    """Conditions of N readings.

    Parameters
    ----------
    payload : (N,) ndarray
        Mass at the tip, kg.
    gravity : (N, 3) ndarray
        Direction of gravity in the base frame, a unit vector.
    approach : (N, m) ndarray
        Sign of each coordinate's last move, 0 where it is not known.
    previous : (N, m) ndarray
        Reading before the last move, rad or m.
    drift : (N,) ndarray
        Temperature (K) or time (s) beyond their means, or the part of the run from -1/2 to 1/2.
    """

    payload: Array
    gravity: Array
    approach: Array
    previous: Array
    drift: Array

    def __repr__(self) -> str:
        least, most = self.payload.min(initial=np.inf), self.payload.max(initial=-np.inf)
        return brief(self, f"{len(self.payload)} readings, payload {least:g} to {most:g} kg")


def parse_conditions(given: Mapping[str, Any] | None, q: Array) -> tuple[Conditions, Reference]:
    """Conditions of readings q (N, m) in the order in which they were taken, and their means.

    Raises: UnknownName, ShapeError, InputError.
    """
    columns = _columns(given, q)
    reference: dict[str, Any] = {}
    for name in (*MEANS, "gravity"):
        if name in columns:
            reference[name] = np.mean(columns[name], axis=0).tolist()
    return _changed(in_order(q, reference), columns, q, reference), reference


def later_conditions(given: Mapping[str, Any] | None, q: Array, reference: Reference) -> Conditions:
    """Conditions of readings q (N, m) taken after the calibration, at rest where nothing is said.

    Raises: as `parse_conditions`, and InputError for what the calibration does not know of.
    """
    columns = _columns(given, q)
    for name in MEANS:
        if name in columns and name not in reference:
            raise InputError(f"conditions: the calibration was not told its {name}")
    return _changed(at_rest(q, reference), columns, q, reference)


def _changed(
    found: Conditions, columns: Mapping[str, Array], q: Array, reference: Reference
) -> Conditions:
    """The conditions with those that are given in their place."""
    if "previous" in columns:
        moves = q - columns["previous"]
        moved = np.abs(moves) > _STILL
        signs = np.where(moved, np.sign(moves), 0.0)
        found = found._replace(previous=columns["previous"], approach=signs)
    given = {name: columns[name] for name in ("payload", "gravity", "approach") if name in columns}
    source = drift_source(reference)
    if source is not None and source in columns:
        given["drift"] = columns[source] - reference[source]
    return found._replace(**given)


def _columns(given: Mapping[str, Any] | None, q: Array) -> dict[str, Array]:
    """The conditions that are given, as arrays with a row for each of q."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError(
            f"conditions: expected columns by name, such as {{'payload': [...]}}, got {safe_repr(given)}"
        )
    count = len(q)
    shapes = {"gravity": (count, 3), "approach": q.shape, "previous": q.shape}
    columns = {}
    for name, values in given.items():
        if name not in NAMES:
            raise UnknownName(f"conditions: expected {alternatives(NAMES)}, got {quote(str(name))}")
        what = f"conditions[{name!r}]"
        array = finite(numbers(values, what), what)
        shape = shapes.get(name, (count,))
        if array.shape not in (shape, shape[1:]):
            raise ShapeError(f"{what}: expected shape {shape}, got {array.shape}")
        columns[name] = np.broadcast_to(array, shape)
    if "gravity" in columns:
        columns["gravity"] = _directions(columns["gravity"])
    return columns


def _directions(gravity: Array) -> Array:
    if not norms(gravity).all():
        raise InputError("conditions['gravity']: expected directions in the base frame, got zero")
    return normalised(gravity)


def in_order(q: Array, reference: Reference) -> Conditions:
    """Conditions of readings that were taken one after the other, and under the reference."""
    found = at_rest(q, reference)
    previous = np.concatenate([q[:1], q[:-1]])
    run = np.linspace(-0.5, 0.5, len(q))
    return found._replace(previous=previous, approach=_signs(q - previous), drift=run)


def at_rest(q: Array, reference: Reference) -> Conditions:
    """Conditions of readings of which nothing but the reference is known."""
    count = len(q)
    payload = np.full(count, float(reference.get("payload", 0.0)))
    mean = reference.get("gravity", _DOWN)
    down = normalised(np.asarray(mean, float))
    return Conditions(
        payload=payload,
        gravity=np.tile(down, (count, 1)),
        approach=np.zeros_like(q),
        previous=q,
        drift=np.zeros(count),
    )


def drift_source(reference: Reference) -> str | None:
    """Name of the condition that a drift follows; None for the order of rows."""
    return next((name for name in _DRIFTS if name in reference), None)


def _signs(moves: Array) -> Array:
    """Sign (N, m) of the last move of each coordinate, in this row or before; 0 before the first."""
    moved = np.abs(moves) > _STILL
    rows = np.arange(len(moves))[:, None]
    own = np.where(moved, rows, -1)
    last = np.maximum.accumulate(own, axis=0)
    chosen = np.maximum(last, 0)
    signs = np.take_along_axis(np.sign(moves), chosen, axis=0)
    return np.where(last < 0, 0.0, signs)
