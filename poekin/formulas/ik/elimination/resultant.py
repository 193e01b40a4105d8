"""The determinant of which the third angle is a root, and its vector of products of the others.

Six equations A = [A_0 A_1 A_2] in (C^2, C S, S^2) of x_4, a block each, and of x_5, times C_4 and
times S_4, are twelve in the products C_4^(3-a) S_4^a C_5^(2-b) S_5^b, which are not all 0 only where

    M(x_3) = [A_0 A_1 A_2 0; 0 A_0 A_1 A_2],   det M = sum_k F_k e^{i k x_3},   k = -8 ... 8

is singular. Rows that leave [U_0 U_1 U_2; 0 B_1 B_2] of A, U_0 triangular, leave of M

    det M = det U_0  det [B_1 B_2 0; U_0 U_1 U_2; 0 B_1 B_2]

In each column a row at a time is cleared, the smaller by the larger of two, so that numbers of
several matrices at once take the same way.
Accuracy: of the angle, rounding over the slope of M's smallest singular value
(tests/formulas/ik/elimination/test_resultant.py). Source: Raghavan and Roth 1993; Manocha and Canny
1994, Efficient Inverse Kinematics for General 6R Manipulators.
"""

from ... import elementary
from .line_equations import KEPT, ROOM

SIZE = 12
EQUATIONS = 9 * KEPT
STACKED = 81
_WIDTH = 9
_TINY = 1e-40


def equations(sigma, weights, A):
    """A = x S_0 + y S_1 + z S_2, (x, y, z) = weights: C^2, C S, S^2 of x_3."""
    x, y, z = weights
    for r in range(KEPT):
        for k in range(_WIDTH):
            at = ROOM * r + k
            value = x * sigma[at]
            value += y * sigma[at + 9]
            value += z * sigma[at + 18]
            A[_WIDTH * r + k] = value


def factor(A, M):
    """The determinant; its triangular factors are left in A, three rows, and in M, nine."""
    for j in range(3):
        for i in range(j + 1, KEPT):
            _clear(A, j, i)
    _stack(A, M)
    sign = -1.0  # of the three rows that go before three
    det = A[0] * A[10] * A[20]
    for j in range(_WIDTH):
        last = 6 if j < 3 else _WIDTH
        for i in range(max(j + 1, 3), last):
            sign = sign * _clear(M, j, i)
        det = det * M[10 * j]
    return sign * det


def _stack(A, M):
    """[U_0 U_1 U_2; B_1 B_2 0; 0 B_1 B_2] of the rows of A."""
    for k in range(27):
        M[k] = A[k]
    for i in range(3):
        middle = 27 + _WIDTH * i
        lower = 54 + _WIDTH * i
        for k in range(3):
            M[middle + 6 + k] = 0.0
        for k in range(6):
            value = A[middle + 3 + k]
            M[middle + k] = value
            M[lower + 3 + k] = value


def _clear(M, j, i):
    """Clears the i-th row's number in the j-th column by the j-th row, after an exchange where it is
    larger; the exchange's sign.
    """
    top = _WIDTH * j
    at = _WIDTH * i
    p = M[top + j]
    q = M[at + j]
    a = abs(p)
    b = abs(q)
    pivot = elementary.where_less(a, b, q, p)
    other = elementary.where_less(a, b, p, q)
    share = other / elementary.where_less(0.0, abs(pivot), pivot, 1.0)
    M[top + j] = pivot
    for k in range(j + 1, _WIDTH):
        p = M[top + k]
        q = M[at + k]
        high = elementary.where_less(a, b, q, p)
        low = elementary.where_less(a, b, p, q)
        M[top + k] = high
        M[at + k] = low - share * high
    return elementary.where_less(a, b, -1.0, 1.0)


def null_vector(A, M, v):
    """Writes the products of a matrix that is singular to rounding, by its factors, of any length.

    One step of inverse iteration, from a vector of which M's rows have made 1, 1.1, 1.2, ...
    """
    for i in range(_WIDTH - 1, -1, -1):
        _substitute(M, i, v, 3)
    for i in range(2, -1, -1):
        _substitute(A, i, v, 0)


def _substitute(M, i, v, first):
    total = 1.0 + 0.1 * i
    for k in range(i + 1, _WIDTH):
        total = total - M[_WIDTH * i + k] * v[first + k]
    pivot = M[10 * i]
    v[first + i] = total / elementary.where_less(0.0, abs(pivot), pivot, _TINY)
