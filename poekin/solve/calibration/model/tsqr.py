"""Least squares, products and QR in blocks of rows, below what makes OpenBLAS start threads.

The matrices of a calibration are tall and narrow. At some hundred rows of forty numbers, waking
threads and waiting for them costs more than the work itself, many times more where another process
has the processors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ....groups.arrays import Array

_QR_NUMBERS = 8192  # of a matrix times a vector: what each column of a QR is
_PRODUCT_NUMBERS = 2**18  # of a matrix times a matrix


def qr_r(A: Array) -> Array:
    """R (min(M, P), P) with R^T R = A^T A of A (M, P), as accurate as the QR of the whole.

    Source: Demmel, Grigori, Hoemmen and Langou 2012 (SIAM J. Sci. Comput. 34, 1): QR of the blocks'
    stacked R.
    """
    columns = A.shape[1]
    rows = max(_QR_NUMBERS // max(columns, 1), 2 * columns)
    while len(A) > rows:
        blocks = -(-len(A) // rows)
        padded = np.zeros((blocks * rows, columns))
        padded[: len(A)] = A
        triangles = _qr(padded.reshape(blocks, rows, columns))
        A = triangles.reshape(-1, columns)
    return _qr(A)


def _qr(A: Array) -> Array:
    R: Any = np.linalg.qr(A, mode="r")
    return R


def least_squares(A: Array, b: Array) -> Array:
    """The shortest x (P,) of the least |A x - b|, or (P, k) of b (M, k)."""
    x: Any = np.linalg.lstsq(A, b, rcond=None)[0]
    return x


def blocked_product(A: Array, B: Array) -> Array:
    """A B (M, k), A (M, P), B (P, k)."""
    rows = max(1, _PRODUCT_NUMBERS // max(B.size, 1))
    product = np.empty((len(A), B.shape[1]))
    for start in range(0, len(A), rows):
        block = slice(start, start + rows)
        np.matmul(A[block], B, out=product[block])
    return product
