"""Checks of arrays at the public boundary, and kernels over their leading axes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, SupportsInt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..engine.kernels import group_kernels
from ..errors import InputError, PoseError, ShapeError, show_numbers
from .objects import plain

Array = NDArray[np.float64]
ROUNDOFF = 2.0**-53  # u of a double
TOLERANCE = 1e-5  # the largest accepted entry of abs(R R^T - I)
ROUNDED = 2e-2  # of abs(R R^T - I): what rounding to two decimals can do
LAST_ROW_UNREAD = -2  # of `first_defect`: a NaN in the last row, which kernels do not read

# What may stand in the place of another thing: the axes expected, those that arrived, the remedy.
# The first that fits is named: matrices before rows of numbers.
REMEDIES = (
    ((6,), (4, 4), "pk.se3.log of a pose is its twist, pk.se3.vee of a matrix [xi] is xi"),
    ((4, 4), (3, 3), "pk.se3.pose(R, p) makes a pose of a rotation and a translation"),
    ((4, 4), (6,), "pk.se3.exp of a twist is a pose"),
    ((4, 4), (3,), "pk.se3.pose(np.eye(3), p) makes a pose of a position"),
    ((3, 3), (4, 4), "the rotation of a pose is T[..., :3, :3]"),
    ((3, 3), (3, 4), "of three rows of a pose, the rotation is T[..., :3, :3]"),
    ((4, 4), (3, 4), "to three rows of a pose, add the row 0 0 0 1"),
    ((3, 3), (4,), "of a quaternion, SciPy's Rotation.from_quat makes what is taken here"),
    ((3, 3), (3,), "pk.so3.exp of a rotation vector is a rotation"),
)


def numbers(values: ArrayLike, what: str) -> Array:
    """Values as a float64 array; poses of other libraries as `objects.plain` has them.

    Refuses text, other objects and complex numbers.
    """
    if type(values) is not np.ndarray:
        values = plain(values, what)
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ShapeError(
            f"{what}: expected an array of numbers, got rows of different lengths"
        ) from error
    if array.dtype.kind not in "fiu":
        kind = "text" if array.dtype.kind in "US" else array.dtype.name
        raise InputError(f"{what}: expected real numbers, got {kind} ({type(values).__name__})")
    return array.astype(np.float64, copy=False)


def shaped(values: ArrayLike, tail: tuple[int, ...], what: str) -> Array:
    """Values as a float64 array whose last axes are `tail`."""
    array = numbers(values, what)
    if array.shape[array.ndim - len(tail) :] != tail or array.ndim < len(tail):
        expected = ", ".join(["...", *map(str, tail)])
        raise ShapeError(
            f"{what}: expected shape ({expected}), got {array.shape}{_remedy(tail, array.shape)}"
        )
    return array


def _remedy(tail: tuple[int, ...], shape: tuple[int, ...]) -> str:
    """End of a message: what makes `tail` of the thing that has this shape."""
    for expected, got, remedy in REMEDIES:
        if tail == expected and shape[-len(got) :] == got:
            return f": {remedy}"
    return ""


def rotations(values: ArrayLike, what: str = "R") -> Array:
    """Values as rotation matrices (..., 3, 3)."""
    return _checked(shaped(values, (3, 3), what), what, "rotation")


def poses(values: ArrayLike, what: str = "T") -> Array:
    """Values as poses (..., 4, 4)."""
    return _checked(shaped(values, (4, 4), what), what, "pose")


def _checked(M: Array, what: str, kind: str) -> Array:
    flat = M.reshape(-1, *M.shape[-2:])
    found = np.array([TOLERANCE, 0.0, 0.0])
    k = group_kernels.first_defect.call(flat, found)
    if k == LAST_ROW_UNREAD:  # the NaN has to show in the result
        M = M.copy()
        M[np.isnan(M[..., 3, :]).any(-1)] = np.nan
    if k < 0:
        return M
    where = element_name(what, np.unravel_index(k, M.shape[:-2]))
    off, determinant, last = found
    if last > TOLERANCE:
        transposed = "; its transpose is one" if _is_pose(flat[k].T) else ""
        raise PoseError(
            f"{where} is no {kind}: its last row is {show_numbers(flat[k, 3])},"
            f" expected [0, 0, 0, 1]{transposed}"
        )
    if off > TOLERANCE:
        group = "se3" if kind == "pose" else "so3"
        rounded = off <= ROUNDED and determinant > 0.0
        remedy = (
            f"; if it was rounded, pk.{group}.nearest gives the nearest {kind}" if rounded else ""
        )
        raise PoseError(
            f"{where} is no {kind}: its rotation misses orthonormality,"
            f" max abs(R R^T - I) = {off:.3g}, accepted up to {TOLERANCE:g}{remedy}"
        )
    raise PoseError(
        f"{where} is no {kind}: its rotation is a reflection, det R = {determinant:.3g}, expected 1"
    )


def _is_pose(T: Array) -> bool:
    found = np.array([TOLERANCE, 0.0, 0.0])
    return group_kernels.first_defect.call(T[None], found) < 0


def element_name(what: str, index: Iterable[SupportsInt]) -> str:
    """Name of an array's element in messages: `T[0, 2]`, and `T` for the batch ()."""
    indices = ", ".join(str(int(i)) for i in index)
    return f"{what}[{indices}]" if indices else what


def first_place(bad: ArrayLike, what: str) -> str:
    """Name of the first element of a batch for which `bad` is true."""
    return element_name(what, np.argwhere(bad)[0])


def direction_and_length(x: Array) -> tuple[Array, Array]:
    """Unit vectors along the last axis and lengths (...), at any size; a zero has the direction 0."""
    largest = np.abs(x).max(-1, keepdims=True)
    with np.errstate(over="ignore", invalid="ignore"):
        scaled = x / np.where(largest == 0.0, 1.0, largest)
        size = np.linalg.norm(scaled, axis=-1, keepdims=True)
        direction = scaled / np.where(size == 0.0, 1.0, size)
        return direction, (largest * size)[..., 0]


def with_rows(matrices: Array, rows: ArrayLike, width: int, what: str) -> tuple[Array, Array]:
    """Matrices and rows of `width` numbers, broadcast to the same leading axes."""
    rows = shaped(rows, (width,), what)
    try:
        batch = np.broadcast_shapes(matrices.shape[:-2], rows.shape[:-1])
    except ValueError as error:
        raise ShapeError(
            f"{what}: shape {rows.shape} does not broadcast against {matrices.shape}"
        ) from error
    matrices = np.broadcast_to(matrices, (*batch, *matrices.shape[-2:]))
    return matrices, np.broadcast_to(rows, (*batch, width))


def map_kernel(
    kernel: Any,
    element_axes: int,
    tail: tuple[int, ...],
    source: Array,
    *others: Array,
) -> Array:
    """Results of a kernel, elements of shape `tail`, over the leading axes of `source`.

    An element of `source` has `element_axes` axes; `others` hold rows of the same leading axes.
    """
    batch = source.shape[: source.ndim - element_axes]
    count = math.prod(batch)
    result = np.empty((count, *tail))
    rows = (other.reshape(count, other.shape[-1]) for other in others)
    kernel.call(source.reshape(count, *source.shape[source.ndim - element_axes :]), *rows, result)
    return result.reshape(*batch, *tail)
