"""Arrays that a caller gives to be written into, checked before a kernel does so."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...errors import InputError, ShapeError
from ...groups.arrays import Array

# Names looked up once: one call for a pose and a Jacobian takes about a microsecond in all.
_ndarray = np.ndarray
_float64 = np.dtype(np.float64)


def checked_out(
    out: Any,
    shape: tuple[int, ...],
    what: str,
    q: Any,
) -> Array:
    """`out` itself where a kernel can write into it while it reads q."""
    if type(out) is not _ndarray or out.dtype != _float64 or out.shape != shape:
        got = type(out).__name__
        if isinstance(out, np.ndarray):
            got = f"{out.dtype} {out.shape}"
        raise ShapeError(f"{what}: expected a float64 array of shape {shape}, got {got}")
    if not (out.flags.carray and out.dtype.isnative):
        raise InputError(f"{what}: expected a C-contiguous, writable, aligned array")
    if _overlap(out, q):
        raise InputError(
            f"{what}: it shares memory with q, which would be overwritten while it is read"
        )
    return out


def checked_pair(
    out: Any,
    T_shape: tuple[int, ...],
    J_shape: tuple[int, ...],
    q: Any,
) -> tuple[Array, Array]:
    """The pair `out` = (T, J) itself where a kernel can write into both while it reads q."""
    if not isinstance(out, (tuple, list)) or len(out) != 2:
        raise InputError(f"out: expected a pair of arrays (T, J), got {type(out).__name__}")
    T = checked_out(out[0], T_shape, "out[0]", q)
    J = checked_out(out[1], J_shape, "out[1]", q)
    if _overlap(T, J):
        raise InputError("out: T and J share memory")
    return T, J


def _overlap(a: Array, b: Any) -> bool:
    """Whether two arrays may share memory; at once for one that has its own and that the other is
    no view of.
    """
    return (
        isinstance(b, np.ndarray)
        and not (a.base is None and b.base is not a)
        and np.may_share_memory(a, b)
    )
