"""Poses, rotations and tables of other libraries as arrays, known by their attributes: nothing is
imported.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError, join_names

_PLAIN = (float, int, list, tuple, np.ndarray, np.generic)
_NUMBERS = {float, int, list, tuple, np.ndarray, np.float64}
_POSES = ((3, 3), (4, 4))


def labels(values: Any) -> tuple[Any, ...] | None:
    """Labels of the last axis of a table: the columns of a pandas DataFrame, the index of a Series.

    None for what is no table, and for a Series or DataFrame that only numbers them, 0, 1, 2, ....
    """
    kind = type(values)
    if not hasattr(kind, "to_numpy"):
        return None
    axis = next((name for name in ("columns", "index") if hasattr(kind, name)), None)
    if axis is None:
        return None
    given = getattr(values, axis)
    if callable(given):  # a method of another meaning, as list.index
        return None
    return None if tuple(given) == tuple(range(len(given))) else tuple(given)


def plain(values: Any, what: str) -> Any:
    """What other libraries call a pose or a rotation as an array, or a list of them; else `values`
    itself.

    - Pinocchio: SE3 (`homogeneous`)
    - SciPy: Rotation and RigidTransform; and all else that has `as_matrix()`
    - spatialmath: SO3 and SE3 (`A`, a list where they hold several, of which `np.asarray` would
      take the first)
    - pandas: Series and DataFrame whose last axis has no labels

    Raises: InputError for what `np.asarray` would take for something else than it is: a twist in
    the other order,
    (v; omega), as Pinocchio's Motion and spatialmath's Twist3 have it, and a planar SE2, which is
    3x3 like a rotation; a masked array of which something is masked; labels, which an array has
    not.
    """
    if isinstance(values, (list, tuple)):
        if set(map(type, values)) <= _NUMBERS:
            return values
        for value in values:
            _unmasked(value, what)
        return values if isinstance(values[0], _PLAIN) else [plain(value, what) for value in values]
    _unmasked(values, what)
    if hasattr(type(values), "to_numpy"):
        marks = labels(values)
        if marks is not None:
            raise InputError(
                f"{what}: expected an array, got a {type(values).__name__} with the labels"
                f" {join_names(map(str, marks))}, which are not looked at here: hand over its to_numpy()"
            )
        return values.to_numpy()
    spatial = hasattr(values, "A") and hasattr(values, "N")
    shape = values.shape if spatial else None
    if shape == (6,) or (hasattr(values, "linear") and hasattr(values, "angular")):
        raise InputError(
            f"{what}: expected an array, got a {type(values).__name__}, whose order is (v; omega); linear_first of its"
            " six numbers is (omega; v)"
        )
    if spatial and values.N != 3:
        raise InputError(
            f"{what}: expected something of space, got the planar {type(values).__name__}"
        )
    if spatial:
        return (
            np.reshape(values.A, (len(values), *shape))
            if shape in _POSES and len(values) != 1
            else values.A
        )
    if hasattr(values, "homogeneous"):
        return values.homogeneous
    as_matrix = getattr(values, "as_matrix", None)
    return as_matrix() if callable(as_matrix) else values


def _unmasked(values: Any, what: str) -> None:
    """Raises InputError for a masked array of which something is masked: `np.asarray` would take
    what lies below.
    """
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise InputError(
            f"{what}: expected numbers, got a masked array of which some are masked: use .compressed(), or"
            " .filled(np.nan) where NaN may come out"
        )
