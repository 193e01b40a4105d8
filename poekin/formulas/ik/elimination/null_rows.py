"""Six orthonormal rows across eight columns of fourteen numbers, by Householder's reflections.

Accuracy: rounding, u times the rows' number (tests/formulas/ik/elimination/test_null_rows.py).
Source: Golub and Van Loan 2013, Section 5.2.
"""

from ... import elementary

_LENGTH = 14
_COLUMNS = 8
_ROWS = 6


def fill(B):
    """Six rows are written behind eight columns and one more, of fourteen numbers each; the columns
    are lost.
    """
    for j in range(_COLUMNS):
        _reflector(B, j)
        for k in range(j + 1, _COLUMNS):
            _reflect(B, j, _LENGTH * k)
    for r in range(_ROWS):
        at = _LENGTH * (_COLUMNS + 1 + r)
        for m in range(_LENGTH):
            B[at + m] = 0.0
        B[at + _COLUMNS + r] = 1.0
        for j in range(_COLUMNS - 1, -1, -1):
            _reflect(B, j, at)


def _reflector(B, j):
    """The j-th column becomes the vector v of a reflection 1 - v v^T that leaves its first j and one
    numbers, v . v = 2; v = 0 where the rest of the column is 0.
    """
    at = _LENGTH * j
    total = 0.0
    for m in range(j, _LENGTH):
        total += B[at + m] * B[at + m]
    size = elementary.sqrt(total)
    if B[at + j] < 0.0:
        size = -size
    B[at + j] += size
    norm = elementary.sqrt(size * B[at + j])
    if norm > 0.0:
        for m in range(j, _LENGTH):
            B[at + m] /= norm


def _reflect(B, j, at):
    """One reflection of the column that begins at a place."""
    v = _LENGTH * j
    along = 0.0
    for m in range(j, _LENGTH):
        along += B[v + m] * B[at + m]
    for m in range(j, _LENGTH):
        B[at + m] -= along * B[v + m]
