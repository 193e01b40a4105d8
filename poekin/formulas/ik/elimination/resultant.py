"""The determinant of which the third angle is a root, and its vector of products of the others.

Six equations in (C^2, C S, S^2) of x_4 and of x_5, times C_4 and times S_4, are twelve in the products
C_4^(3-a) S_4^a C_5^(2-b) S_5^b, which are not all 0 only where the matrix M(x_3) is singular.

    det M = sum_k F_k e^{i k x_3},   k = -8 ... 8

An angle is sharpened by Newton's rule on the eigenvalue itself, dx = -w^T M v / (w^T M' v), of the
vectors v and w that inverse iteration gives.
Accuracy: of the angle, rounding over the slope of M's smallest singular value
(tests/formulas/ik/elimination/test_resultant.py). Source: Raghavan and Roth 1993; Manocha and Canny
1994, Efficient Inverse Kinematics for General 6R Manipulators.
"""

from ... import elementary

SIZE = 12
_TINY = 1e-300


def matrix(sigma, weights, M):
    """The rows of M = x S_0 + y S_1 + z S_2, (x, y, z) = weights: C^2, C S, S^2 of x_3 for M itself,
    and their derivatives for that of M.
    """
    x, y, z = weights
    for r in range(6):
        upper = 12 * r
        lower = upper + 12 * 6 + 3
        for k in range(9):
            at = 27 * r + k
            value = x * sigma[at]
            value += y * sigma[at + 9]
            value += z * sigma[at + 18]
            M[upper + k] = value
            M[lower + k] = value
        for k in range(3):
            M[upper + 9 + k] = 0.0
            M[lower - 3 + k] = 0.0


def factor(M, order):
    """Triangular factors in the place of M, by rows in the order of the largest pivots; returns the
    determinant.
    """
    det = 1.0
    for j in range(SIZE):
        best = j
        for i in range(j + 1, SIZE):
            if abs(M[12 * i + j]) > abs(M[12 * best + j]):
                best = i
        order[j] = best
        if best != j:
            det = -det
            for k in range(SIZE):
                other = M[12 * best + k]
                M[12 * best + k] = M[12 * j + k]
                M[12 * j + k] = other
        pivot = M[12 * j + j]
        det *= pivot
        if pivot != 0.0:
            for i in range(j + 1, SIZE):
                if M[12 * i + j] != 0.0:
                    share = M[12 * i + j] / pivot
                    M[12 * i + j] = share
                    for k in range(j + 1, SIZE):
                        M[12 * i + k] -= share * M[12 * j + k]
    return det


def _divided(x, pivot):
    if pivot == 0.0:
        return x / _TINY
    return x / pivot


def solve(M, order, x):
    """M^-1 x in the place of x, of the factors of M."""
    for i in range(SIZE):
        _exchange(x, i, order[i])
    for i in range(SIZE):
        known = x[i]
        for k in range(i + 1, SIZE):
            x[k] -= M[12 * k + i] * known
    for i in range(SIZE - 1, -1, -1):
        known = _divided(x[i], M[12 * i + i])
        x[i] = known
        for k in range(i):
            x[k] -= M[12 * k + i] * known
    _normalise(x)


def solve_transposed(M, order, x):
    """M^-T x in the place of x."""
    for i in range(SIZE):
        row = 12 * i
        known = _divided(x[i], M[row + i])
        x[i] = known
        for k in range(i + 1, SIZE):
            x[k] -= M[row + k] * known
    for i in range(SIZE - 1, -1, -1):
        for k in range(i + 1, SIZE):
            x[i] -= M[12 * k + i] * x[k]
    for i in range(SIZE - 1, -1, -1):
        _exchange(x, i, order[i])
    _normalise(x)


def _exchange(x, i, k):
    other = x[k]
    x[k] = x[i]
    x[i] = other


def _normalise(x):
    """A vector divided by its largest number, then by its length."""
    top = 0.0
    for i in range(SIZE):
        top = max(top, abs(x[i]))
    if not top > 0.0:
        return
    total = 0.0
    for i in range(SIZE):
        share = x[i] / top
        x[i] = share
        total += share * share
    length = elementary.sqrt(total)
    for i in range(SIZE):
        x[i] /= length
