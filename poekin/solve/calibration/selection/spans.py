"""Spans of columns: what they hold, and what others have beside them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..model.tsqr import blocked_product, qr_r

RANK = 1e-8
"""Part of the largest singular value below which directions of columns are rounding."""
INDEPENDENT = 1e-6
"""Part of a column's length below which what is left of it beside others is rounding."""


class Span(NamedTuple):
    """Orthonormal Q (M, k) of columns, and these (k, P) by them: the columns of length 1 are Q R."""

    Q: Array
    R: Array


def spanned(columns: Array) -> Span:
    """The span of columns (M, P) of any sizes."""
    unit = columns / column_sizes(columns)
    _, s, Vt = np.linalg.svd(qr_r(unit), full_matrices=False)
    kept = s > RANK * s[:1]
    s = s[kept]
    Vt = Vt[kept]
    return Span(blocked_product(unit, Vt.T / s), s[:, None] * Vt)


def directions_beside(Q: Array, columns: Array) -> Array:
    """Orthonormal directions (M, d) of columns (M, P) of any sizes beside orthonormal Q (M, k)."""
    known = columns[:, np.any(columns, axis=0)]
    rest = beside(Q, known / column_sizes(known))
    _, s, Vt = np.linalg.svd(qr_r(rest), full_matrices=False)
    kept = s > INDEPENDENT
    return blocked_product(rest, Vt[kept].T / s[kept])


def beside(Q: Array, columns: Array) -> Array:
    """The part of columns (M, ...) that is orthogonal to orthonormal Q (M, k)."""
    for _ in range(2):  # Gram-Schmidt is exact the second time
        columns = columns - Q @ (Q.T @ columns)
    return columns


def column_sizes(columns: Array) -> Array:
    """Lengths (P,) of columns (M, P), 1 of one that is 0."""
    sizes = np.linalg.norm(columns, axis=0)
    return np.where(sizes > 0.0, sizes, 1.0)
