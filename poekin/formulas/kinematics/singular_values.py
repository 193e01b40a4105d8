"""Largest and smallest singular value of a matrix of few rows, by rotations of pairs of its rows.

Each rotation makes two rows orthogonal; when all are, their lengths are the singular values. Nothing
branches, so that several matrices are done side by side.
Source: Hestenes 1958 (one-sided Jacobi); Demmel and Veselić 1992 (accuracy).
"""

from .. import elementary

NEAR = 8e-16
"""Change of the shorter row's squared length, relative to it, of a rotation whose sweep is the last:
what the sweep leaves of inner products, since rotations mix them, changes lengths by no more. A small
angle alone does not tell: rows of nearly equal length turn by large angles to the end.
"""
_TINY = 1e-300


def orthogonalise(W, rows, columns):
    """One sweep over all pairs of rows of W (rows, columns), in place. Returns 1 where another one is
    needed, 0 where W has become orthogonal to rounding.
    """
    is_far = 0.0
    for i in range(rows - 1):
        for j in range(i + 1, rows):
            a = product(W, i, i, columns)
            b = product(W, j, j, columns)
            g = product(W, i, j, columns)
            cosine, sine = turn(a, b, g)
            shorter = elementary.where_less(a, b, a, b)
            is_far = elementary.where_less(NEAR * shorter, abs(sine * g), 1.0, is_far)
            for k in range(columns):
                x = W[i][k]
                y = W[j][k]
                W[i][k] = cosine * x - sine * y
                W[j][k] = sine * x + cosine * y
    return is_far


def product(W, i, j, columns):
    """Inner product of two rows."""
    total = W[i][0] * W[j][0]
    for k in range(1, columns):
        total = total + W[i][k] * W[j][k]
    return total


def turn(a, b, g):
    """Cosine and sine of the smaller rotation that makes two rows orthogonal, of squared lengths a and
    b and the inner product g: tan 2θ = 2 g / (b - a).
    """
    d = b - a
    signed = elementary.where_less(d, 0.0, -2.0 * g, 2.0 * g)
    tangent = signed / (abs(d) + elementary.sqrt(d * d + 4.0 * (g * g)) + _TINY)
    cosine = 1.0 / elementary.sqrt(1.0 + tangent * tangent)
    return cosine, cosine * tangent


def extreme_lengths(W, rows, columns):
    """Largest and smallest length of the rows: the singular values of a W that is orthogonal.

    Accuracy: within 64 u of the largest (tests/formulas/kinematics/test_singular_values.py).
    """
    largest = product(W, 0, 0, columns)
    smallest = largest
    for i in range(1, rows):
        a = product(W, i, i, columns)
        largest = elementary.where_less(largest, a, a, largest)
        smallest = elementary.where_less(a, smallest, a, smallest)
    return elementary.sqrt(largest), elementary.sqrt(smallest)
