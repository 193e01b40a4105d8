"""Checks of a chain's parts as they are given: copied, and made exact to the last digit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError, PoseError, ShapeError, join_names, quote, safe_repr
from ..formulas.lie import defect
from ..groups.arrays import TOLERANCE, Array, numbers, poses, shaped
from ..groups.vectors import rotation_part

LONGEST = 1e100
"""The largest length [m] that is accepted: beyond it, squares of lengths are no numbers any more.
"""


_EXACT = 4e-15  # a pose whose rotation is off by more is replaced by the nearest rotation
_LAST_ROW = (0.0, 0.0, 0.0, 1.0)


def finite(values: ArrayLike, what: str) -> Array:
    """A copy of the values, all of them finite, and no zero with a sign."""
    array = numbers(values, what).copy() + 0.0
    good = np.isfinite(array)
    if not good.all():
        index = tuple(np.argwhere(~good)[0].tolist())
        place = f"{what}[{', '.join(map(str, index))}]" if index else what
        raise InputError(f"{place}: expected a finite number, got {array[index]}")
    return array


def one_pose(T: ArrayLike, what: str = "home") -> Array:
    """A copy of one finite pose, its rotation exact and its last row (0, 0, 0, 1).

    Raises: ShapeError; PoseError where it is none; InputError for a place more than `LONGEST` away.
    """
    T = shaped(T, (4, 4), what).copy()
    if T.ndim != 2:
        raise ShapeError(f"{what}: expected one pose (4, 4), got shape {T.shape}")
    *rows, last = T.tolist()
    for number, row in enumerate(rows):
        if not all(map(math.isfinite, row)):
            raise PoseError(f"{what}: expected finite numbers, row {number} is {row}")
        if abs(row[3]) > LONGEST:
            raise InputError(
                f"{what}: expected lengths of at most {LONGEST:g} m, got {row[3]:g} in row {number}"
            )
    R = (
        *rows[0][:3],
        *rows[1][:3],
        *rows[2][:3],
    )
    off = defect.orthonormality(R)
    fits = all(abs(a - b) <= TOLERANCE for a, b in zip(last, _LAST_ROW, strict=True))
    if off > TOLERANCE or defect.determinant(R) < 0 or not fits:
        # The check for whole arrays says what is wrong. It is not asked about every pose: it is
        # compiled code, and a robot is read without waiting for that.
        poses(T, what)
    if off > _EXACT:
        U, _, V = np.linalg.svd(rotation_part(T))
        T[:3, :3] = U @ V
    T[3] = _LAST_ROW
    T += 0.0  # no negative zeros: equal poses have equal bytes
    return T


def read_only(array: Array) -> Array:
    """A copy of the array that cannot be made writable again: a view of one that is nowhere else."""
    array = array.copy()
    array.flags.writeable = False
    return array.view()


def frame_name(name: Any, what: str) -> str:
    """The name of a frame: a string that is not empty."""
    if not isinstance(name, str) or not name:
        raise InputError(
            f"{what}: expected a name, a string that is not empty, got {safe_repr(name)}"
        )
    return str(name)


def ordered_names(names: Any, what: str) -> tuple[str, ...]:
    """Names in the order in which they are given, no two alike; none for None.

    Raises: InputError for what has no order, such as a set, and for a name that is no string, empty
    or there twice.
    """
    if names is None:
        return ()
    if isinstance(names, np.ndarray):
        names = names.tolist()
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise InputError(f"{what}: expected a list of names, got {safe_repr(names)}")
    seen: set[str] = set()
    for index, name in enumerate(names):
        frame_name(name, f"{what}[{index}]")
        if name in seen:
            raise InputError(f"{what}: {quote(name)} appears more than once")
        seen.add(name)
    return tuple(map(str, names))


def distinct_names(
    names: Sequence[str] | None,
    count: int,
    what: str,
    letter: str,
) -> tuple[str, ...]:
    """`count` names as `ordered_names` takes them; without any given, the letter and a number."""
    if names is None:
        return tuple(f"{letter}{i + 1}" for i in range(count))
    given = ordered_names(names, what)
    if len(given) != count:
        raise ShapeError(
            f"{what}: expected {count} names, got {len(given)}: {join_names(given) or 'none'}"
        )
    return given


def bounds(limits: ArrayLike | None, names: tuple[str, ...], what: str = "limits") -> Array:
    """Lower and upper bound of each name (m, 2), infinite where there is none."""
    if limits is None:
        return np.tile([-np.inf, np.inf], (len(names), 1))
    L = numbers(limits, what).copy() + 0.0
    if L.shape != (len(names), 2):
        raise ShapeError(
            f"{what}: expected shape ({len(names)}, 2), lower and upper of each {_each(what)}, got "
            f"{L.shape}"
        )
    for name, (lower, upper) in zip(names, L, strict=True):
        if not lower <= upper or lower == np.inf or upper == -np.inf:
            raise InputError(
                f"{what}: expected lower <= upper for {quote(name)}, got {lower} and {upper}"
            )
    return L


def velocity_bounds(
    limits: ArrayLike | None,
    names: tuple[str, ...],
    what: str = "velocity_limits",
) -> Array:
    """Greatest rate of each name (m,), infinite where it is not known."""
    if limits is None:
        return np.full(len(names), np.inf)
    v = numbers(limits, what).copy()
    if v.shape != (len(names),):
        raise ShapeError(
            f"{what}: expected shape ({len(names)},), one of each {_each(what)}, got {v.shape}"
        )
    for name, bound in zip(names, v.tolist(), strict=True):
        if not bound > 0:
            raise InputError(
                f"{what}: expected a positive number for {quote(name)}, infinite where it is"
                f" not known, got {bound}"
            )
    return v


def _each(what: str) -> str:
    return "joint" if what.startswith("joint") else "coordinate"


def coupling_matrix(values: ArrayLike | None, n: int) -> Array | None:
    """C as given, or None where it is the identity or not given."""
    if values is None:
        return None
    C = finite(values, "coupling")
    if C.ndim != 2 or C.shape[0] != n:
        raise ShapeError(f"coupling: expected shape ({n}, m), one row a joint, got {C.shape}")
    return None if np.array_equal(C, np.eye(n)) else C


def joint_masses(values: ArrayLike | None, n: int) -> Array | None:
    """Rows (n, 4) of mass and centre of mass; None where they are not known."""
    if values is None:
        return None
    rows = finite(values, "masses")
    if rows.shape != (n, 4):
        raise ShapeError(
            f"masses: expected shape ({n}, 4), mass, x, y and z of each joint, got {rows.shape}"
        )
    if (rows[:, 0] < 0.0).any():
        raise InputError(f"masses: expected none below 0 kg, got {rows[:, 0].min():g}")
    return read_only(rows)
