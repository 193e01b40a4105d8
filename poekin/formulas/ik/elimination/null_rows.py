"""Orthonormal rows across columns of numbers, by Householder's reflections.

Accuracy: rounding, u times the rows' number (tests/formulas/ik/elimination/test_null_rows.py).
Source: Golub and Van Loan 2013, Section 5.2.
"""

from ... import elementary


def fill(B, start, length, columns):
    """As many rows as the columns leave are written behind them; the columns, which begin at a
    place and have `length` numbers each, are lost.
    """
    for j in range(columns):
        _reflector(B, start, length, j)
        for k in range(j + 1, columns):
            _reflect(B, start, length, j, start + length * k)
    for r in range(columns, length):
        at = start + length * r
        for m in range(length):
            B[at + m] = 0.0
        B[at + r] = 1.0
        for j in range(columns - 1, -1, -1):
            _reflect(B, start, length, j, at)


def _reflector(B, start, length, j):
    """The j-th column becomes the vector v of a reflection 1 - v v^T that leaves its first j and one
    numbers, v . v = 2; v = 0 where the rest of the column is 0.
    """
    at = start + length * j
    total = 0.0
    for m in range(j, length):
        total += B[at + m] * B[at + m]
    size = elementary.sqrt(total)
    if B[at + j] < 0.0:
        size = -size
    B[at + j] += size
    norm = elementary.sqrt(size * B[at + j])
    if norm > 0.0:
        share = 1.0 / norm
        for m in range(j, length):
            B[at + m] *= share


def _reflect(B, start, length, j, at):
    """One reflection of the column that begins at a place."""
    v = start + length * j
    along = 0.0
    for m in range(j, length):
        along += B[v + m] * B[at + m]
    for m in range(j, length):
        B[at + m] -= along * B[v + m]
