"""What a chain is made of, as it is given: checked, copied and made exact to the last digit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError, ShapeError, shown
from ..groups.arrays import Array, numbers, poses, shaped

_EXACT = 4e-15  # a pose whose rotation is off by more is replaced by the nearest rotation


def finite(values: ArrayLike, what: str) -> Array:
    """A copy of the values, all of them finite, and no zero with a sign."""
    array = numbers(values, what).copy() + 0.0
    if not np.isfinite(array).all():
        raise InputError(f"{what}: expected finite numbers, got {array.tolist()}")
    return array


def one_pose(T: ArrayLike, what: str = "home") -> Array:
    """One finite pose, its rotation exact and its last row (0, 0, 0, 1)."""
    T = poses(finite(shaped(T, (4, 4), what), what), what)
    if T.ndim != 2:
        raise ShapeError(f"{what}: expected one pose (4, 4), got shape {T.shape}")
    T[3] = [0.0, 0.0, 0.0, 1.0]
    R = T[:3, :3]
    if np.abs(R @ R.T - np.eye(3)).max() > _EXACT:
        U, _, V = np.linalg.svd(R)
        T[:3, :3] = U @ V
    return T + 0.0


def distinct_names(names: Sequence[str] | None, count: int, what: str, letter: str) -> tuple[str, ...]:
    """`count` names, no two alike; without any given, the letter and a number."""
    if names is None:
        return tuple(f"{letter}{i + 1}" for i in range(count))
    if isinstance(names, str) or len(names) != count:
        raise ShapeError(f"{what}: expected {count} names, got {names!r}")
    if len(set(names)) != count:
        twice = next(name for name in names if list(names).count(name) > 1)
        raise InputError(f"{what}: {shown(twice)} appears more than once")
    return tuple(map(str, names))


def bounds(limits: ArrayLike | None, names: tuple[str, ...]) -> Array:
    """Lower and upper bound of each coordinate (m, 2), infinite where there is none."""
    if limits is None:
        return np.tile([-np.inf, np.inf], (len(names), 1))
    L = numbers(limits, "limits").copy() + 0.0
    if L.shape != (len(names), 2):
        raise ShapeError(f"limits: expected shape ({len(names)}, 2), lower and upper of each coordinate, got {L.shape}")
    for name, (lower, upper) in zip(names, L, strict=True):
        if not lower <= upper or lower == np.inf or upper == -np.inf:
            raise InputError(f"limits: expected lower <= upper for {shown(name)}, got {lower} and {upper}")
    return L


def coupling_matrix(values: ArrayLike, n: int) -> Array | None:
    """C as given, or None where it is the identity."""
    C = finite(values, "coupling")
    if C.ndim != 2 or C.shape[0] != n:
        raise ShapeError(f"coupling: expected shape ({n}, m), one row a joint, got {C.shape}")
    return None if np.array_equal(C, np.eye(n)) else C
