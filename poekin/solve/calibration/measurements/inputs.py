"""Inputs of a calibration: joint readings and sets of measurements, checked against each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from ....errors import InputError, ShapeError, safe_repr
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import finite
from ....model.coordinates import coordinates
from .measurement import Measurement
from .points import Points
from .poses import Poses


def parse_readings(chain: Chain, q: object) -> Array:
    """q (N, m), finite, N > 0. Raises: ShapeError with the number of joints; InputError with the
    number not finite.
    """
    array = coordinates(q, chain.q_names)
    if array.ndim != 2:
        raise ShapeError(
            f"q: expected readings (N, {chain.dof}), one row a measurement, got shape {array.shape}"
        )
    if not len(array):
        raise InputError("q: expected readings, got none")
    return finite(array, "q")


def parse_measurements(measurements: Any, count: int) -> list[Measurement]:
    """Measurements as a list of sets; a bare array (N, 4, 4) is poses, (N, 3) points. Each fits the
    `count` rows of q.
    """
    sets = _listed(measurements)
    for k, s in enumerate(sets):
        _check_rows(s, count, f"measurements[{k}]" if len(sets) > 1 else "measurements")
    return sets


def _listed(measurements: Any) -> list[Any]:
    if isinstance(measurements, Measurement):
        return [measurements]
    several = isinstance(measurements, (list, tuple)) and len(measurements)
    if several and isinstance(measurements[0], Measurement):
        return list(measurements)
    shape = _shape(measurements)
    kind = {(4, 4): Poses, (3,): Points}.get(shape[1:])
    if kind is None:
        raise ShapeError(
            "measurements: expected Poses, Points, Distances, EyeInHand, EyeToHand, a list of them,"
            " or an array (N, 4, 4) of poses or (N, 3) of points, got "
            f"{type(measurements).__name__} of shape {shape}"
        )
    return [kind(measurements)]


def _check_rows(s: Any, count: int, where: str) -> None:
    if not isinstance(s, Measurement):
        raise InputError(
            f"{where}: expected Poses, Points, Distances, EyeInHand or EyeToHand, got {safe_repr(s)}"
        )
    if s.rows is None and len(s) != count:
        raise ShapeError(f"{where}: {len(s)} {s.what} for {count} rows of q; say which with rows=")
    if s.rows is not None and len(s) and s.rows.max() >= count:
        raise InputError(f"{where}: rows names row {int(s.rows.max())} of q, which has {count}")
    if not len(s):
        raise InputError(f"{where}: expected {s.what}, got none")


def _shape(values: Any) -> tuple[int, ...]:
    """The shape of an array; () for anything else, such as a ragged list."""
    try:
        return np.shape(values)
    except ValueError:
        return ()
