"""Comparisons that know the rounding of a scalar's kind: 2^-53 of floats, 10^-60 of sixty digits."""

from .. import elementary

_COEFFICIENT = 0.0625  # 1 / 16: a coefficient of 16 u of its terms is rounding
_REST = 0.015625  # 1 / 64: d has more of them


def is_rounding(x, size):
    """Whether x changes nothing of a size above 0: |x| is at most about u size."""
    return size + x == size and size - x == size


def told(row, size):
    """An equation (a, a', b, b', d) made of terms of this size, without coefficients that are nothing
    but their rounding; where all are, d over the size. Of one circle alone d is that of its nearest
    or farthest point where it is so but for rounding.
    """
    a, b, c, d, e = row
    a = _told(a, size)
    b = _told(b, size)
    c = _told(c, size)
    d = _told(d, size)
    first = max(abs(a), abs(b))
    second = max(abs(c), abs(d))
    if min(first, second) > 0.0 or not size > 0.0:
        return a, b, c, d, e
    if max(first, second) == 0.0:
        e = e / size
        if is_rounding(_REST * e, 1.0):
            e = 0.0 * size
        return a, b, c, d, e
    r = elementary.sqrt(a * a + b * b + c * c + d * d)
    if is_rounding(_REST * (abs(e) - r), size):
        e = r if e > 0.0 else -r
    return a, b, c, d, e


def _told(x, size):
    if is_rounding(_COEFFICIENT * x, size):
        return 0.0 * size
    return x


def least(x, y):
    """The smaller of two numbers; NaN where one of them is."""
    if x <= y:
        return x
    if y < x:
        return y
    return x + y
