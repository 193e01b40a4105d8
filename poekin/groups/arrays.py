"""Checks of arrays at the public boundary, and kernels over their leading axes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import SupportsInt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..engine.kernels import group_kernels
from ..errors import InputError, PoseError, ShapeError
from .objects import plain

Array = NDArray[np.float64]
TOLERANCE = 1e-5  # the largest accepted entry of abs(R R^T - I)
LAST_ROW_UNREAD = -2  # of `first_defect`: a NaN in the last row, which kernels do not read


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
        raise InputError(
            f"{what}: expected real numbers, got {array.dtype.name} ({type(values).__name__})"
        )
    return array.astype(np.float64, copy=False)


def shaped(values: ArrayLike, tail: tuple[int, ...], what: str) -> Array:
    """Values as a float64 array whose last axes are `tail`."""
    array = numbers(values, what)
    if array.shape[array.ndim - len(tail) :] != tail or array.ndim < len(tail):
        expected = ", ".join(["...", *map(str, tail)])
        raise ShapeError(f"{what}: expected shape ({expected}), got {array.shape}")
    return array


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
        raise PoseError(
            f"{where} is no {kind}: its last row is {flat[k, 3].tolist()}, expected [0, 0, 0, 1]"
        )
    if off > TOLERANCE:
        raise PoseError(
            f"{where} is no {kind}: its rotation misses orthonormality, max abs(R R^T - I) = {off:.3g}, "
            f"accepted up to {TOLERANCE:g}"
        )
    raise PoseError(
        f"{where} is no {kind}: its rotation is a reflection, det R = {determinant:.3g}, expected 1"
    )


def element_name(what: str, index: Iterable[SupportsInt]) -> str:
    """Name of an array's element in messages: `T[0, 2]`, and `T` for the batch ()."""
    indices = ", ".join(str(int(i)) for i in index)
    return f"{what}[{indices}]" if indices else what


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
    kernel, element_axes: int, tail: tuple[int, ...], source: Array, *others: Array
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
