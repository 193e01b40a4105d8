"""Comparisons that know the rounding of a scalar's kind: 2^-53 of floats, 10^-60 of sixty digits."""


def is_rounding(x, size):
    """Whether x changes nothing of a size above 0: |x| is at most about u size."""
    return size + x == size and size - x == size


def least(x, y):
    """The smaller of two numbers; NaN where one of them is."""
    if x <= y:
        return x
    if y < x:
        return y
    return x + y
