"""Both roots of k t^2 + 2 h t + e = 0, k not 0.

    t_1 = -(h + sign(h) w) / k,   t_2 = e / (k t_1),   w^2 = h^2 - k e

so that nothing cancels but in w^2. Accuracy: 4 u of the larger of both roots, and the square root
of it at a double root (tests/formulas/ik/slides/test_quadratic.py). Source: Higham 2002, Accuracy
and Stability of Numerical Algorithms, Section 1.8.
"""

from ... import elementary


def roots(k, h, e):
    """Both roots and their margin w^2 / (h^2 + |k e|); of a margin below 0 both are -h / k, where
    the left side is nearest to 0.
    """
    square = h * h - k * e
    size = h * h + abs(k * e)
    if size == 0.0:
        return size / k, size / k, size
    margin = square / size
    if margin <= 0.0:
        return -h / k, -h / k, margin
    w = elementary.sqrt(square)
    if h < 0.0:
        w = -w
    far = -(h + w)
    return far / k, e / far, margin
