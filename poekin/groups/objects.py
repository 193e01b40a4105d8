"""Poses and rotations of other libraries as arrays, known by their attributes: nothing is imported."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError

_PLAIN = (float, int, list, tuple, np.ndarray, np.generic)
_POSES = ((3, 3), (4, 4))


def plain(values: Any, what: str) -> Any:
    """What other libraries call a pose or a rotation as an array, or a list of them; else `values` itself.

    - Pinocchio: SE3 (`homogeneous`)
    - SciPy: Rotation and RigidTransform; and all else that has `as_matrix()`
    - spatialmath: SO3 and SE3 (`A`, a list where they hold several, of which `np.asarray` would take the first)

    Raises: InputError for what `np.asarray` would take for something else than it is: a twist in the other order,
    (v; omega), as Pinocchio's Motion and spatialmath's Twist3 have it, and a planar SE2, which is 3x3 like a rotation.
    """
    if isinstance(values, (list, tuple)):
        return [plain(value, what) for value in values] if values and not isinstance(values[0], _PLAIN) else values
    spatial = hasattr(values, "A") and hasattr(values, "N")
    shape = values.shape if spatial else None
    if shape == (6,) or (hasattr(values, "linear") and hasattr(values, "angular")):
        raise InputError(
            f"{what}: expected an array, got a {type(values).__name__}, whose order is (v; omega); linear_first of its"
            " six numbers is (omega; v)"
        )
    if spatial and values.N != 3:
        raise InputError(f"{what}: expected something of space, got the planar {type(values).__name__}")
    if spatial:
        return np.reshape(values.A, (len(values), *shape)) if shape in _POSES and len(values) != 1 else values.A
    if hasattr(values, "homogeneous"):
        return values.homogeneous
    as_matrix = getattr(values, "as_matrix", None)
    return as_matrix() if callable(as_matrix) else values
