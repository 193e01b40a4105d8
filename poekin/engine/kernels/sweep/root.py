"""Manipulability from its square."""

import math


def root(x):
    """The root of a determinant; of one below 0 by rounding, or NaN, 0."""
    return math.sqrt(max(0.0, x))
