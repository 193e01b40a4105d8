"""Poses, rotations and tables of other libraries as arrays, known by their attributes.

No other library is imported.
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
    found = tuple(given)
    if found == tuple(range(len(found))):
        return None
    return found


def plain(values: Any, what: str) -> Any:
    """Array, or list of arrays, of a pose or rotation of another library; else `values` itself.

    - Pinocchio: SE3 (`homogeneous`)
    - SciPy: Rotation and RigidTransform; and all else that has `as_matrix()`
    - spatialmath: SO3 and SE3 (`A`, a list where they hold several, of which `np.asarray` would
      take the first)
    - pandas: Series and DataFrame whose last axis has no labels

    Raises: InputError for what `np.asarray` would take for something else than it is: a twist in
    the other order, (v; omega), as Pinocchio's Motion and spatialmath's Twist3 have it, and a
    planar SE2, which is 3x3 like a rotation; a masked array of which something is masked; labels,
    which an array has not.
    """
    if isinstance(values, (list, tuple)):
        return _plain_items(values, what)
    _check_unmasked(values, what)
    if hasattr(type(values), "to_numpy"):
        return _without_labels(values, what)
    if hasattr(values, "linear") and hasattr(values, "angular"):
        raise _twist_error(values, what)
    if hasattr(values, "A") and hasattr(values, "N"):
        return _spatialmath_array(values, what)
    if hasattr(values, "homogeneous"):
        return values.homogeneous
    as_matrix = getattr(values, "as_matrix", None)
    if callable(as_matrix):
        return as_matrix()
    return values


def _plain_items(values: list[Any] | tuple[Any, ...], what: str) -> Any:
    if _NUMBERS.issuperset(map(type, values)):
        return values
    for value in values:
        _check_unmasked(value, what)
    if isinstance(values[0], _PLAIN):
        return values
    return [plain(value, what) for value in values]


def _without_labels(values: Any, what: str) -> Any:
    marks = labels(values)
    if marks is not None:
        raise InputError(
            f"{what}: expected an array, got a {type(values).__name__} with the labels"
            f" {join_names(map(str, marks))}, which are not looked at here: hand over its to_numpy()"
        )
    return values.to_numpy()


def _spatialmath_array(values: Any, what: str) -> Any:
    shape = values.shape
    if shape == (6,):
        raise _twist_error(values, what)
    if values.N != 3:
        raise InputError(
            f"{what}: expected something of space, got the planar {type(values).__name__}"
        )
    if shape in _POSES and len(values) != 1:
        return np.reshape(values.A, (len(values), *shape))
    return values.A


def _twist_error(values: Any, what: str) -> InputError:
    return InputError(
        f"{what}: expected an array, got a {type(values).__name__}, whose order is (v; omega);"
        " linear_first of its six numbers is (omega; v)"
    )


def _check_unmasked(values: Any, what: str) -> None:
    """Refuse a masked array with masked entries: `np.asarray` would take what lies below."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise InputError(
            f"{what}: expected numbers, got a masked array of which some are masked: use .compressed(), or"
            " .filled(np.nan) where NaN may come out"
        )
