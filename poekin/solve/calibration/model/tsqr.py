"""Products and QR in blocks of rows that stay below what makes OpenBLAS start threads.

The matrices of a calibration are tall and narrow. At some hundred rows of forty numbers, waking
threads and waiting for them costs more than the work itself, many times more where another process
has the processors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ....groups.arrays import Array

_NUMBERS = 8192  # of a matrix times a vector: what each column of a QR is
_PRODUCTS = 2**18  # of a matrix times a matrix


def triangle(A: Array) -> Array:
    """R (min(M, P), P) with R^T R = A^T A of A (M, P), as accurate as the QR of the whole.

    Source: Demmel, Grigori, Hoemmen and Langou 2012 (SIAM J. Sci. Comput. 34, 1): QR of the blocks'
    stacked R.
    """
    columns = A.shape[1]
    rows = max(_NUMBERS // max(columns, 1), 2 * columns)
    while len(A) > rows:
        blocks = -(-len(A) // rows)
        padded = np.zeros((blocks * rows, columns))
        padded[: len(A)] = A
        A = _qr(padded.reshape(blocks, rows, columns)).reshape(-1, columns)
    return _qr(A)


def _qr(A: Array) -> Array:
    R: Any = np.linalg.qr(A, mode="r")
    return R


def times(A: Array, B: Array) -> Array:
    """A B (M, k), A (M, P), B (P, k)."""
    rows = max(1, _PRODUCTS // max(B.size, 1))
    product = np.empty((len(A), B.shape[1]))
    for start in range(0, len(A), rows):
        np.matmul(A[start : start + rows], B, out=product[start : start + rows])
    return product
