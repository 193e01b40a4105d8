"""Covariances that are given with measurements, checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError, safe_repr
from ....groups.arrays import Array
from ....model.checks import finite


def covariances(
    values: ArrayLike | None,
    count: int,
    width: int,
    what: str,
) -> Array | None:
    """Covariances (N, width, width) of one for all, or one each; None stays None.

    Raises: ShapeError; InputError with the element that is not symmetric or not positive definite.
    """
    if values is None:
        return None
    C = finite(values, f"{what}: covariance")
    if width == 1 and C.shape in ((), (count,)):
        C = C.reshape(-1, 1, 1)
    if C.shape not in ((width, width), (count, width, width), (1, width, width)):
        raise ShapeError(
            f"{what}: covariance: expected shape ({width}, {width}), or ({count}, {width}, {width})"
            f", got {C.shape}"
        )
    C = C.reshape(-1, width, width)
    for k, one in enumerate(C):
        which = f"[{k}]" if len(C) > 1 else ""
        _check_covariance(one, f"{what}: covariance{which}")
    return np.broadcast_to(C, (count, width, width)).copy()


def _check_covariance(C: Array, where: str) -> None:
    """Raises: InputError for a matrix that is not symmetric and positive definite."""
    variances = np.diag(C)
    if not (variances > 0).all():
        raise InputError(
            f"{where} is not positive definite: its diagonal is {safe_repr(variances.tolist())}"
        )
    scale = np.sqrt(np.abs(variances))
    even = C / np.outer(scale, scale)
    skew = np.abs(even - even.T).max()
    if skew > 1e-9:
        raise InputError(f"{where} is not symmetric, by {skew:.3g} of its diagonal")
    least = float(np.linalg.eigvalsh(0.5 * (even + even.T))[0])
    # below the rounding of the factorisation there is no telling it from a singular one
    if least <= 1e-14 * len(C):
        raise InputError(
            f"{where} is not positive definite: scaled to a unit diagonal, its least eigenvalue is "
            f"{least:.3g}"
        )
